//! From times and velocities to the integers of a plan: whole ticks, and jerks in 2^-72 units.

use super::axis_state::{AxisState, JERK_STEP};
use super::piece::Piece;

/// The pieces that take the axes to the velocities `wanted` (2^-72 units a tick): a jerk, a time without, a jerk, and a
/// tick that takes what rounding leaves of the acceleration, so that exactly none is left. What rounding leaves of a
/// velocity is less than the sum of the ticks, squared. The first and the last of the ticks are not zero.
pub(crate) fn velocity_pieces(
    state: &[AxisState; 3],
    wanted: &[i64; 3],
    [n1, n2, n3]: [u64; 3],
) -> [Piece; 4] {
    let mut pieces = [n1, n2, n3, 1].map(|ticks| Piece {
        ticks,
        jerk: [0; 3],
    });
    for (i, (axis, wanted)) in state.iter().zip(wanted).enumerate() {
        if axis.velocity == *wanted && axis.acceleration == 0 {
            continue;
        }
        let [first, last] = velocity_jerks(axis, *wanted, [n1, n2, n3]);
        let ramps = first
            .wrapping_mul(n1 as i64)
            .wrapping_add(last.wrapping_mul(n3 as i64));
        pieces[0].jerk[i] = first;
        pieces[2].jerk[i] = last;
        pieces[3].jerk[i] = axis.acceleration.wrapping_add(ramps).wrapping_neg();
    }
    if pieces[3].jerk == [0; 3] {
        pieces[3].ticks = 0;
    }
    pieces
}

/// Jerks of the first and the last segment.
#[inline(never)]
fn velocity_jerks(axis: &AxisState, wanted: i64, [n1, n2, n3]: [u64; 3]) -> [i64; 2] {
    let (n1, n2, n3) = (n1 as i64, n2 as i64, n3 as i64);
    // An acceleration is even.
    let half = axis.acceleration / 2;
    let gained = axis.velocity.wrapping_add(half.wrapping_mul(n1));
    let peak = twice_over(wanted.wrapping_sub(gained), n1 + 2 * n2 + n3);
    let first = jerk(peak - axis.acceleration, n1);
    let last = jerk(-axis.acceleration.wrapping_add(first.wrapping_mul(n1)), n3);
    [first, last]
}

/// Twice `value` over `divisor`, without an overflow, to two.
fn twice_over(value: i64, divisor: i64) -> i64 {
    let whole = over(value, divisor);
    // Less than the divisor.
    let rest = 2 * value.wrapping_sub(whole.wrapping_mul(divisor));
    2 * whole + i64::from(rest >= divisor) - i64::from(rest <= -divisor)
}

/// The jerk that changes an acceleration by `change` in `ticks`, rounded towards zero to one that integers follow
/// exactly.
fn jerk(change: i64, ticks: i64) -> i64 {
    over(change, ticks * JERK_STEP) * JERK_STEP
}

/// A quotient rounded towards zero; zero over nothing, so that there is no panic in it.
fn over(value: i64, divisor: i64) -> i64 {
    value.checked_div(divisor).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::plan::state_after_pieces;
    use crate::number::random::Random;

    /// From any state to any velocity in any ticks: no acceleration is left, and of the velocity less than the ticks,
    /// squared, times the step of a jerk.
    #[test]
    fn the_velocity_is_reached_without_an_acceleration() {
        let mut random = Random::new(7);
        let mut next = |bits: u32| random.bits(bits);
        for _ in 0..2_000 {
            let state = [0; 3].map(|_| AxisState {
                position: 0,
                velocity: next(56),
                acceleration: next(44) * JERK_STEP,
            });
            let wanted = [0; 3].map(|_| next(56));
            let ticks = [0, 1, 2].map(|k| (next(11).unsigned_abs()).max(u64::from(k != 1)));
            let pieces = velocity_pieces(&state, &wanted, ticks);
            let end = state_after_pieces(&state, &pieces, &[0; 3]);
            let all: u64 = ticks.iter().sum();
            for i in 0..3 {
                assert_eq!(end[i].acceleration, 0);
                let off = end[i].velocity.abs_diff(wanted[i]);
                assert!(off <= 6 * all * all, "{off} {ticks:?}");
            }
        }
    }
}

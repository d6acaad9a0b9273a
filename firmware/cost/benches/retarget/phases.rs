//! Phases of motions: the first of a line and of a jog.

use crate::planner::Motion;

/// Ticks of a line in which it first speeds up: until its acceleration is down to a hundredth of what it has been.
pub fn speeding_up(line: &Motion) -> u64 {
    let (mut ticks, mut most) = (0, 0.0_f64);
    let mut before = 0.0;
    for piece in &line.plan.pieces {
        let now = along(line, ticks + piece.ticks);
        if now < most / 100.0 {
            // It passes zero in a piece that also brakes.
            let part = if now < 0.0 {
                before / (before - now)
            } else {
                1.0
            };
            return ticks + (part * piece.ticks as f64) as u64;
        }
        ticks += piece.ticks;
        (before, most) = (now, most.max(now));
    }
    ticks
}

/// The acceleration along a line's way, in units that are the same at every tick.
fn along(line: &Motion, tick: u64) -> f64 {
    let state = line.state_after(tick);
    let way = |i: usize| (line.plan.end[i] - line.from[i].rounded()) as f64;
    (0..3).map(|i| way(i) * state[i].acceleration as f64).sum()
}

/// Ticks of a jog until it holds its velocity.
pub fn ramp(jog: &Motion) -> u64 {
    let mut ticks = 0;
    for piece in &jog.plan.pieces {
        let state = jog.state_after(ticks);
        if piece.jerk == [0; 3] && state.iter().all(|axis| axis.acceleration == 0) {
            break;
        }
        ticks += piece.ticks;
    }
    ticks
}

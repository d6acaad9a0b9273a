//! Following a plan: the motion generator's share of a tick.

use crate::bench::{Bench, no_result};
use crate::table::CallResult;
use cortex_m::singleton;
use firmware::motion::{LoneFollower, PlanSlots, SetpointScale};
use firmware_cost::random::Random;
use firmware_cost::states::{Moving, ground};

/// Counts taking a plan, and a tick of it.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    let Some(slots) = singleton!(: PlanSlots = PlanSlots::new()) else {
        return;
    };
    let mut motion = LoneFollower::new(slots);
    bench.part_with(
        "tick: a plan is taken",
        1,
        &mut motion,
        |motion, random| {
            let (plan, from) = Moving::new(random).begun_at_rest();
            motion.rest_at(from);
            motion.hand_over(&plan)
        },
        |motion, handle| handle.map(|handle| motion.take(&handle)),
        |_, taken| CallResult {
            refused: !matches!(taken, Some(Ok(()))),
            ticks: 0,
        },
    );
    let scale = SetpointScale::new(ground().limits.rate_hz);
    bench.part_with(
        "tick: next setpoint",
        Bench::SHORT,
        &mut motion,
        |motion, random| {
            if !motion.is_moving() {
                begin_one_of_short_pieces(motion, random);
            }
        },
        |motion, ()| {
            motion.advance();
            motion.setpoint(&scale)
        },
        no_result,
    );
}

/// Pieces of two ticks or fewer, so that many change.
fn begin_one_of_short_pieces(motion: &mut LoneFollower<'_>, random: &mut Random) {
    let (mut plan, from) = Moving::new(random).begun_at_rest();
    for piece in &mut plan.pieces {
        piece.ticks = piece.ticks.min(2);
    }
    motion.rest_at(from);
    // It starts where the motion rests, so it is taken.
    let _ = motion.accept(&plan);
}

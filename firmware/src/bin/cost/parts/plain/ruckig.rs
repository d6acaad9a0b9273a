//! Motion with rsruckig: the time-optimal profiles of three axes, synchronised. It knows neither the mechanism nor a path.

use super::super::states::{Moving, ground, position};
use crate::bench::{Bench, plain};
use crate::random::Random;
use crate::table::Came;
use alloc::boxed::Box;
use core::ptr::addr_of_mut;
use embedded_alloc::LlffHeap;
use firmware::motion::{Axis, Position};
use rsruckig::prelude::*;

/// rsruckig needs some 30 KB on the stack as it is; what can lie elsewhere does.
#[global_allocator]
static HEAP: LlffHeap = LlffHeap::empty();
const HEAP_BYTES: usize = 64 * 1024;
static mut MEMORY: [u8; HEAP_BYTES] = [0; HEAP_BYTES];

type Reference = Ruckig<3, ThrowErrorHandler>;

const PERIOD_S: f64 = 50e-6;

/// Counts a new target, and a tick of the way to it.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    // SAFETY: once, before anything is allocated; nobody else knows the memory.
    unsafe { HEAP.init(addr_of_mut!(MEMORY) as usize, HEAP_BYTES) };
    let (mut ruckig, mut trajectory) = (generator(), Box::new(Trajectory::<3>::new(None)));
    let mut memory = (&mut *ruckig, &mut *trajectory);
    bench.part_with(
        "beside: motion: new target in motion, rsruckig",
        1,
        &mut memory,
        |_, random| Box::new(input(random)),
        |(ruckig, trajectory), input| ruckig.calculate(input, trajectory).is_err(),
        |_, &refused| Came { refused, ticks: 0 },
    );
    bench.part_with(
        "beside: tick: next setpoint, rsruckig",
        1,
        &mut memory,
        |(ruckig, trajectory), random| {
            let planned = ruckig.calculate(&input(random), trajectory).is_ok();
            let most = if planned {
                trajectory.get_duration()
            } else {
                0.0
            };
            random.within(0.0, most)
        },
        |(_, trajectory), &time_s| {
            let mut position = DataArrayOrVec::Stack([0.0; 3]);
            let mut velocity = DataArrayOrVec::Stack([0.0; 3]);
            let mut acceleration = DataArrayOrVec::Stack([0.0; 3]);
            trajectory.at_time(
                time_s,
                &mut Some(&mut position),
                &mut Some(&mut velocity),
                &mut Some(&mut acceleration),
                &mut None,
                &mut None,
            );
            (position, velocity, acceleration)
        },
        plain,
    );
}

#[inline(never)]
fn generator() -> Box<Reference> {
    Box::new(Reference::new(None, PERIOD_S))
}

/// The state of a motion under way, a new target, and the limits, in track radii and turns.
fn input(random: &mut Random) -> InputParameter<3> {
    let (now, to) = (Moving::new(random), position(random));
    let state = now.plan.state_after(&now.start, now.at);
    let limits = ground().limits;
    let mm = ground().geometry.radius_mm;
    let each = |translation: f64, rotation_deg: f64| {
        let translation = translation / mm;
        DataArrayOrVec::Stack([translation, translation, rotation_deg / 360.0])
    };
    let mut input = InputParameter::new(None);
    input.current_position = stack(&state, |axis| axis.rounded() as f64 * UNIT);
    input.current_velocity = stack(&state, |axis| axis.velocity as f64 * SMALL * limits.rate_hz);
    input.current_acceleration = stack(&state, |axis| {
        axis.acceleration as f64 * SMALL * limits.rate_hz * limits.rate_hz
    });
    input.target_position = target(&to);
    input.max_velocity = each(limits.speed_mm_s, limits.turn_speed_deg_s);
    input.max_acceleration = each(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2);
    input.max_jerk = each(limits.jerk_mm_s3, limits.turn_jerk_deg_s3);
    input
}

/// 2^-32 and 2^-72.
const UNIT: f64 = 1.0 / 4_294_967_296.0;
const SMALL: f64 = 1.0 / 4_722_366_482_869_645_213_696.0;

fn stack(state: &[Axis; 3], value: impl Fn(&Axis) -> f64) -> DataArrayOrVec<f64, 3> {
    DataArrayOrVec::Stack(state.each_ref().map(value))
}

fn target(to: &Position) -> DataArrayOrVec<f64, 3> {
    DataArrayOrVec::Stack(to.map(|units| units as f64 * UNIT))
}

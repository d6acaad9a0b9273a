//! Motion with rsruckig: the time-optimal profiles of three axes, synchronised. It knows neither the mechanism nor a path.

use super::super::asked::asked;
use super::super::states::{Moving, position};
use crate::bench::{Bench, plain};
use crate::random::Random;
use crate::table::Came;
use alloc::boxed::Box;
use core::ptr::addr_of_mut;
use embedded_alloc::LlffHeap;
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

/// From a motion under way to a new target.
fn input(random: &mut Random) -> InputParameter<3> {
    let (now, to) = (Moving::new(random), position(random));
    asked(&now.state(), &to)
}

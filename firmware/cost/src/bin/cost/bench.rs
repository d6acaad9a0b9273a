//! Counting one part: so many calls, each with arguments of its own.

use crate::meter::Meter;
use crate::order::Order;
use crate::table::{COST, CallResult};
use firmware_cost::random::Random;

/// The run.
pub struct Bench {
    order: Order,
    meter: Meter,
}

impl Bench {
    /// A run by `order`.
    pub fn new(order: Order, meter: Meter) -> Self {
        Self { order, meter }
    }

    /// Calls a state, where a call is short.
    pub const SHORT: u32 = 10;

    /// Counts the part `name`, `times` calls for every state asked for: `prepare` makes the arguments of a call,
    /// uncounted; `call` is counted; `describe` says what came of it, uncounted.
    pub fn part<A, R>(
        &self,
        name: &'static str,
        times: u32,
        mut prepare: impl FnMut(&mut Random) -> A,
        mut call: impl FnMut(&A) -> R,
        describe: impl Fn(&A, &R) -> CallResult,
    ) {
        self.part_with(
            name,
            times,
            &mut (),
            |(), random| prepare(random),
            |(), arguments| call(arguments),
            describe,
        );
    }

    /// The same for a part with a memory, which outlasts the calls.
    pub fn part_with<M, A, R>(
        &self,
        name: &'static str,
        times: u32,
        memory: &mut M,
        mut prepare: impl FnMut(&mut M, &mut Random) -> A,
        mut call: impl FnMut(&mut M, &A) -> R,
        describe: impl Fn(&A, &R) -> CallResult,
    ) {
        if !self.order.asks_for(name) {
            return;
        }
        let row = COST.row(name);
        for k in 0..self.order.states.saturating_mul(times) {
            let arguments = prepare(memory, &mut Random::new(self.order.seed, k));
            let (counts, result) = self.meter.count(memory, &arguments, &mut call);
            row.add(counts, describe(&arguments, &result));
        }
    }
}

/// Nothing to tell of what came of a call.
pub fn no_result<A, R>(_: &A, _: &R) -> CallResult {
    CallResult::default()
}

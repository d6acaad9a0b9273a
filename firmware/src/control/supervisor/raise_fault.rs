//! What a fault does: it is latched, and answered as the table of transitions has it.

use super::transitions::{Event, Outcome, outcome};
use crate::control::excitation::ExcitationEnd;
use crate::control::state::State;
use crate::fault::{Fault, FaultKind, Reaction};
use crate::mode::Mode;

impl State {
    /// A motion that has come to rest.
    #[cold]
    pub(in crate::control) fn finish_motion(&mut self) {
        if let Outcome::To(mode) = outcome(self.mode, Event::AtRest) {
            self.mode = mode;
        }
    }

    /// A fault: latched, and answered as the table has it.
    ///
    /// The first one stays latched until it is acknowledged; one that ends its controlled stop is kept beside it.
    // One copy of the code: it lies in memory that is short.
    #[cold]
    #[inline(never)]
    pub(in crate::control) fn raise_fault(
        &mut self,
        kind: FaultKind,
        pivot: Option<usize>,
        value: f32,
        limit: f32,
    ) {
        self.raise_fault_with(kind.reaction(), kind, pivot, [value, limit]);
    }

    #[inline(never)]
    pub(super) fn raise_fault_with(
        &mut self,
        mut reaction: Reaction,
        kind: FaultKind,
        pivot: Option<usize>,
        [value, limit]: [f32; 2],
    ) {
        if kind.concerns_encoder() {
            self.referenced = false;
            // One lost pivot is led by its model; two are not.
            if self.lost_pivot.is_some() {
                reaction = Reaction::Brake;
            }
            self.mark_pivot_lost(pivot);
        }
        let Outcome::To(mode) = outcome(self.mode, Event::of(reaction)) else {
            return;
        };
        let fault = Some(Fault {
            kind,
            pivot: pivot.map(|i| i as u8),
            tick: self.tick,
            value,
            limit,
        });
        if self.fault.is_none() {
            self.fault = fault;
        } else {
            self.stop_ended_by = fault;
        }
        if mode == Mode::Stopping {
            self.motion.begin_fault_stop();
        }
        self.excitation.end(ExcitationEnd::Fault);
        self.waking_ticks = 0;
        self.lead_test.stop();
        self.brake_resistor.test.stop();
        self.mode = mode;
        self.coasts = reaction == Reaction::Coast;
        self.settling.start();
    }

    /// From here on a pivot's setpoint stands for what its encoder can not tell.
    fn mark_pivot_lost(&mut self, pivot: Option<usize>) {
        self.lost_pivot = pivot;
        if let Some(servo) = pivot.and_then(|i| self.servo.get_mut(i)) {
            servo.run_open_loop();
        }
    }
}

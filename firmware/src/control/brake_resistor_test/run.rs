//! When the brake resistor is tested, a tick of that, and what comes of it.

use super::{LEAST_COUNTS, LEAST_DROP_V, SUM_OF_A_COUNT, TICKS, TRIES};
use crate::control::config::SupervisionConfig;
use crate::control::inspection::INSPECTION_PERIOD_TICKS;
use crate::control::state::State;
use crate::control::units::SUPPLY_V_PER_COUNT;
use crate::fault::FaultKind;

impl SupervisionConfig {
    /// Ticks from when the bridges are woken to the first duty: they wake up, and the brake resistor is tested.
    #[inline]
    pub(in crate::control) fn ticks_until_driven(&self) -> u32 {
        self.wake_ticks().max(TICKS)
    }
}

impl State {
    /// Begins with the bridges' waking up; the leads are tested where the servo goes on.
    pub(in crate::control) fn wake_bridges(&mut self, limits: &SupervisionConfig) {
        self.waking_ticks = limits.ticks_until_driven();
        self.brake_resistor.test.start(self.supply);
        if self.servo_on() {
            self.lead_test.start();
        }
    }

    /// A test every now and then while the stage is held; to be asked every [`INSPECTION_PERIOD_TICKS`].
    #[cold]
    pub(in crate::control) fn test_brake_resistor_at_rest(&mut self, limits: &SupervisionConfig) {
        let rests = self.servo_only_holds();
        let supply = self.supply;
        let test = &mut self.brake_resistor.test;
        test.rested_ticks = if rests {
            test.rested_ticks + INSPECTION_PERIOD_TICKS
        } else {
            0
        };
        if test.rested_ticks >= limits.resistor_test_ticks {
            test.start(supply);
        }
    }

    /// A motion begins: the next test comes so long after its end.
    #[inline]
    pub(in crate::control) fn put_off_brake_resistor_test(&mut self) {
        self.brake_resistor.test.rested_ticks = 0;
    }

    /// Whether the servo does nothing but hold the stage.
    fn servo_only_holds(&self) -> bool {
        self.setpoint_rests() && !self.is_waking() && self.excitation.request().is_none()
    }

    /// A tick of the test; whether the resistor is to be on. At its end a fault, or another try.
    #[cold]
    pub(in crate::control) fn test_brake_resistor(&mut self, supply_counts: u16) -> bool {
        if self.waking_ticks == 0 && !self.servo_only_holds() {
            self.brake_resistor.test.stop();
            return false;
        }
        let is_taken = self.brake_resistor.is_taken();
        let test = &mut self.brake_resistor.test;
        test.is_void |= is_taken;
        if self.waking_ticks != 0 {
            // What the first duties are scaled by is the supply without the resistor.
            self.supply = test.supply;
        }
        let is_pulsed = test.take(TICKS - u32::from(test.ticks_left), supply_counts);
        test.ticks_left -= 1;
        if test.ticks_left == 0 && !test.is_void {
            self.judge_brake_resistor();
        }
        is_pulsed
    }

    fn judge_brake_resistor(&mut self) {
        let test = &mut self.brake_resistor.test;
        let sum = core::mem::take(&mut test.sum);
        let drop_v = sum as f32 * (SUPPLY_V_PER_COUNT / SUM_OF_A_COUNT as f64) as f32;
        test.drop_v = Some(drop_v);
        if sum >= LEAST_COUNTS * SUM_OF_A_COUNT {
            return;
        }
        test.tries += 1;
        if test.tries < TRIES {
            test.ticks_left = TICKS as u8;
            if self.waking_ticks != 0 {
                self.waking_ticks += TICKS;
            }
        } else {
            let least_v = LEAST_DROP_V as f32;
            self.raise_fault(FaultKind::BrakeResistorDead, None, drop_v, least_v);
        }
    }
}

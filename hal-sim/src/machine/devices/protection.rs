//! What a bridge does by itself: it trips over its current and its temperature, and takes time to wake up.

use super::bridge::{BridgeParameters, BridgeState};

/// What it has seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Protection {
    tripped: bool,
    /// It was too hot, and has not slept since it has cooled.
    overheated: bool,
    wakes: bool,
    awake_s: f64,
    /// Of the junction, over the air, K.
    warmer_k: f64,
}

impl Protection {
    /// Looks at pins and current over a step, and says what the bridge then does with its pins.
    #[must_use]
    pub fn pass(
        &mut self,
        pins: BridgeState,
        parameters: &BridgeParameters,
        current_a: f64,
        step_s: f64,
    ) -> BridgeState {
        let heat = &parameters.heat;
        let junction_c = self.junction_c(parameters);
        if pins.awake {
            self.tripped |= current_a.abs() > parameters.trip_a;
            self.overheated |= junction_c > heat.shutdown_c;
            self.wakes = self.awake_s < parameters.wake_s;
            self.awake_s += step_s;
        } else {
            *self = Self {
                overheated: self.overheated && junction_c > heat.shutdown_c - heat.hysteresis_k,
                warmer_k: self.warmer_k,
                ..Self::default()
            };
        }
        let driving = BridgeState {
            awake: pins.awake && !self.wakes,
            fault: pins.fault || self.tripped || (self.overheated && pins.awake),
            ..pins
        };
        let settled_k = driving.lost_w(parameters, current_a) * heat.thermal_resistance_k_w;
        self.warmer_k += (settled_k - self.warmer_k) * (step_s / heat.time_constant_s);
        driving
    }

    /// Whether it pulls its fault pin: switched off, or awake and not ready yet.
    #[must_use]
    pub const fn pulls_fault_pin(&self) -> bool {
        // Asleep it pulls nothing.
        self.tripped || self.wakes || (self.overheated && self.awake_s > 0.0)
    }

    /// Temperature of the junction, deg C.
    #[must_use]
    pub const fn junction_c(&self, parameters: &BridgeParameters) -> f64 {
        parameters.heat.air_c + self.warmer_k
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 1e-3;
    const REFERENCE: BridgeParameters = BridgeParameters::REFERENCE;
    const DRIVING: BridgeState = BridgeState {
        pulse: 0.5,
        forward: true,
        awake: true,
        fault: false,
    };

    /// What it does with its pins at last.
    fn run(
        bridge: &mut Protection,
        pins: BridgeState,
        current_a: f64,
        seconds: f64,
    ) -> BridgeState {
        let mut driving = pins;
        for _ in 0..(seconds / STEP_S).round() as u32 {
            driving = bridge.pass(pins, &REFERENCE, current_a, STEP_S);
        }
        driving
    }

    #[test]
    fn a_bridge_warms_by_what_its_switches_and_edges_lose() {
        let braking = BridgeState {
            pulse: 0.0,
            ..DRIVING
        };
        // 104 mohm, two in parallel; 140 ns at 48 V and 40 kHz.
        for (pins, current_a, lost_w) in [
            (DRIVING, 6.0, 0.052 * 36.0 + 48.0 * 6.0 * 140e-9 * 40e3),
            (DRIVING, -6.0, 0.052 * 36.0 + 48.0 * 6.0 * 140e-9 * 40e3),
            (braking, 6.0, 0.052 * 36.0),
            (BridgeState::RESET, 6.0, 0.0),
        ] {
            let mut bridge = Protection::default();
            for (seconds, share) in [(20.0, 1.0 - (-1.0_f64).exp()), (480.0, 1.0)] {
                run(&mut bridge, pins, current_a, seconds);
                let expected_c = 35.0 + 20.0 * lost_w * share;
                let junction_c = bridge.junction_c(&REFERENCE);
                assert!(
                    (junction_c - expected_c).abs() < 0.02,
                    "{junction_c} {expected_c}"
                );
            }
            assert!(!bridge.pulls_fault_pin());
        }
    }

    /// Too hot it is off, and stays so when it has cooled; sleeping helps when it has cooled, and not before.
    #[test]
    fn a_bridge_that_is_too_hot_is_off_until_it_has_cooled_and_slept() {
        let mut bridge = Protection::default();
        // 7.5 W and 3.2 W: 249 deg C, had it no limit.
        let mut seconds = 0.0_f64;
        while !run(&mut bridge, DRIVING, 12.0, 0.1).fault {
            assert!(!bridge.pulls_fault_pin());
            seconds += 0.1;
            assert!(seconds < 60.0);
        }
        let settled_k: f64 = 20.0 * (0.052 * 144.0 + 48.0 * 12.0 * 140e-9 * 40e3);
        let expected_s = -20.0 * (1.0 - 130.0 / settled_k).ln();
        assert!((seconds - expected_s).abs() < 0.2, "{seconds} {expected_s}");
        assert!(bridge.pulls_fault_pin());
        // Cooled, and not slept.
        assert!(run(&mut bridge, DRIVING, 0.0, 20.0).fault);
        assert!(bridge.pulls_fault_pin() && bridge.junction_c(&REFERENCE) < 100.0);
        // Slept, and cooled long ago.
        let _ = run(&mut bridge, BridgeState::RESET, 0.0, STEP_S);
        assert!(!run(&mut bridge, DRIVING, 0.0, 0.1).fault && !bridge.pulls_fault_pin());

        // Slept, and hardly cooled: 130 K to 110 K take 20 s ln(13 / 11).
        while !run(&mut bridge, DRIVING, 12.0, 0.1).fault {}
        for (seconds, fault) in [(3.0, true), (0.5, false)] {
            let _ = run(&mut bridge, BridgeState::RESET, 0.0, seconds);
            assert!(!bridge.pulls_fault_pin(), "asleep it pulls nothing");
            assert_eq!(run(&mut bridge, DRIVING, 0.0, 0.01).fault, fault);
            assert_eq!(bridge.pulls_fault_pin(), fault);
        }
    }

    #[test]
    fn a_bridge_trips_over_its_current_until_it_has_slept() {
        let mut bridge = Protection::default();
        assert!(!run(&mut bridge, DRIVING, 31.0, 0.01).fault);
        assert!(run(&mut bridge, DRIVING, -33.0, STEP_S).fault);
        assert!(run(&mut bridge, DRIVING, 0.0, 1.0).fault && bridge.pulls_fault_pin());
        let _ = run(&mut bridge, BridgeState::RESET, 0.0, STEP_S);
        assert!(!run(&mut bridge, DRIVING, 0.0, 0.01).fault && !bridge.pulls_fault_pin());
    }
}

//! The bus between supply and bridges: what a diode lets in, what the motors draw and give back, what the brake resistor takes.

use firmware::drivers::power_stage::BUS;
use serde::{Deserialize, Serialize};

/// What the bus is made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BusParameters {
    /// Resistance of supply and cable, ohm.
    pub source_ohm: f64,
    /// Forward voltage of the diode behind the supply, V.
    pub diode_v: f64,
    /// Capacitor, F.
    pub capacitor_f: f64,
    /// Brake resistor, ohm.
    pub brake_resistor_ohm: f64,
    /// What the supply's voltage ripples by to each side, V.
    pub ripple_v: f64,
    /// How often, Hz: twice the mains' frequency.
    pub ripple_hz: f64,
}

impl BusParameters {
    /// Capacitor and brake resistor of the reference board; 50 mohm of source and cable, 0.5 V of a Schottky diode and a ripple of 0.2 V
    /// from lowest to highest, as makers state.
    pub const REFERENCE: Self = Self {
        source_ohm: 0.05,
        diode_v: 0.5,
        capacitor_f: BUS.capacitor_f,
        brake_resistor_ohm: BUS.resistor_ohm,
        ripple_v: 0.1,
        ripple_hz: 100.0,
    };
}

/// What is wrong with the brake resistor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrakeResistorFault {
    /// It, or its switch, is open.
    Open,
    /// Its switch has failed short.
    StuckOn,
}

impl BusParameters {
    /// What a supply gives at an instant, V.
    #[must_use]
    pub fn source_v(&self, supply_v: f64, at_s: f64) -> f64 {
        if self.ripple_v == 0.0 {
            return supply_v;
        }
        supply_v + self.ripple_v * (core::f64::consts::TAU * self.ripple_hz * at_s).sin()
    }

    /// The bus of a supply that gives and takes any current: all that makes it sag is what the brake resistor draws through the source's
    /// resistance, V.
    #[must_use]
    pub fn ideal_v(&self, source_v: f64, resistor_is_on: bool) -> f64 {
        if resistor_is_on {
            source_v / (1.0 + self.source_ohm / self.brake_resistor_ohm)
        } else {
            source_v
        }
    }
}

/// The bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bus {
    parameters: BusParameters,
    volts: f64,
    /// What the brake resistor has taken, J.
    resistor_j: f64,
    highest_v: f64,
}

impl Bus {
    /// Charged by a supply.
    #[must_use]
    pub const fn new(parameters: BusParameters, source_v: f64) -> Self {
        let volts = source_v - parameters.diode_v;
        Self {
            parameters,
            volts,
            resistor_j: 0.0,
            highest_v: volts,
        }
    }

    /// Its voltage, V.
    #[must_use]
    pub const fn volts(&self) -> f64 {
        self.volts
    }

    /// The highest so far, V.
    #[must_use]
    pub const fn highest_v(&self) -> f64 {
        self.highest_v
    }

    /// What the brake resistor has taken so far, J.
    #[must_use]
    pub const fn resistor_j(&self) -> f64 {
        self.resistor_j
    }

    /// Lets time go by with what the bridges draw (A; less than 0: give back), from a supply of so many volts.
    pub fn step(&mut self, step_s: f64, source_v: f64, drawn_a: f64, resistor_is_on: bool) {
        let parameters = &self.parameters;
        let over_v = source_v - parameters.diode_v - self.volts;
        // A diode lets nothing back.
        let fed_a = (over_v / parameters.source_ohm).max(0.0);
        let braked_a = if resistor_is_on {
            self.volts / parameters.brake_resistor_ohm
        } else {
            0.0
        };
        self.resistor_j += braked_a * self.volts * step_s;
        self.volts += (fed_a - drawn_a - braked_a) / parameters.capacitor_f * step_s;
        self.volts = self.volts.max(0.0);
        self.highest_v = self.highest_v.max(self.volts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 16e-6;

    fn run(bus: &mut Bus, seconds: f64, drawn_a: f64, resistor_is_on: bool) {
        for _ in 0..(seconds / STEP_S) as u32 {
            bus.step(STEP_S, 48.0, drawn_a, resistor_is_on);
        }
    }

    /// Where both have settled they are the same, but for the diode.
    #[test]
    fn the_resistor_draws_an_ideal_supply_down_as_far() {
        let mut bus = Bus::new(BusParameters::REFERENCE, 48.0);
        run(&mut bus, 0.1, 0.0, true);
        let ideal_v = BusParameters::REFERENCE.ideal_v(47.5, true);
        assert!((bus.volts() - ideal_v).abs() < 1e-9, "{}", bus.volts());
        assert!((47.5 - ideal_v - 0.288).abs() < 1e-3, "{ideal_v}");
        assert_eq!(BusParameters::REFERENCE.ideal_v(48.0, false), 48.0);
    }

    #[test]
    fn a_load_makes_it_sag_and_nothing_else_does() {
        let mut bus = Bus::new(BusParameters::REFERENCE, 48.0);
        run(&mut bus, 0.1, 0.0, false);
        assert_eq!(bus.volts(), 47.5);
        run(&mut bus, 0.1, 6.0, false);
        assert!((bus.volts() - (47.5 - 0.3)).abs() < 1e-9, "{}", bus.volts());
    }

    /// What comes back stays in the capacitor, by its energy; the supply takes none of it.
    #[test]
    fn what_is_given_back_raises_it() {
        let mut bus = Bus::new(BusParameters::REFERENCE, 48.0);
        let given_j = {
            let mut given_j = 0.0;
            for _ in 0..5_000 {
                given_j += 2.0 * bus.volts() * STEP_S;
                bus.step(STEP_S, 48.0, -2.0, false);
            }
            given_j
        };
        let stored_j = 0.5 * 4.7e-3 * (bus.volts().powi(2) - 47.5_f64.powi(2));
        assert!(
            (stored_j / given_j - 1.0).abs() < 1e-3,
            "{stored_j} {given_j}"
        );
        assert!(bus.volts() > 70.0);
        assert_eq!(bus.highest_v(), bus.volts());
        run(&mut bus, 0.1, 0.0, false);
        assert_eq!(bus.highest_v(), bus.volts());
        // 8.2 ohm and 4.7 mF: 39 ms. It comes down to where the supply feeds again.
        let before = bus.volts();
        run(&mut bus, 8.2 * 4.7e-3, 0.0, true);
        assert!(
            (bus.volts() / before - (-1.0_f64).exp()).abs() > 0.1,
            "the supply holds it up"
        );
        assert!(
            (bus.volts() - 47.5 / (1.0 + 0.05 / 8.2)).abs() < 1.0,
            "{}",
            bus.volts()
        );
        assert!(bus.resistor_j() > stored_j * 0.5);
    }
}

//! The brake resistor on the bus: it takes what the motors give back, as long as it bears that.

use super::config::Config;
use super::state::State;
use super::units::SUPPLY_V_PER_COUNT;
use crate::drivers::power_stage::BUS;
use crate::fault::FaultKind;

/// Supply at which it is switched on, and under which it is switched off again, ADC counts.
const ON_COUNTS: u16 = (BUS.resistor_on_v / SUPPLY_V_PER_COUNT) as u16;
const OFF_COUNTS: u16 = (BUS.resistor_off_v / SUPPLY_V_PER_COUNT) as u16;
/// What it takes in a tick over what it can give away in one, which is the unit of its heat.
const HEATING: u32 =
    (BUS.resistor_on_v * BUS.resistor_on_v / BUS.resistor_ohm / BUS.resistor_w) as u32 - 1;

/// Whether it is on, and how hot it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrakeResistor {
    is_on: bool,
    /// It has taken all that it bears, and stays off until half of that is gone.
    is_hot: bool,
    heat: u32,
}

impl BrakeResistor {
    /// The pin.
    #[inline]
    pub const fn is_on(&self) -> bool {
        self.is_on
    }
}

impl State {
    /// Switches it by the measured supply, in every mode.
    #[inline]
    pub(super) fn update_brake_resistor(&mut self, config: &Config, supply_counts: u16) {
        let resistor = &mut self.brake_resistor;
        if supply_counts < OFF_COUNTS && resistor.heat == 0 {
            resistor.is_on = false;
            return;
        }
        self.switch_brake_resistor(config, supply_counts);
    }

    #[cold]
    fn switch_brake_resistor(&mut self, config: &Config, supply_counts: u16) {
        let resistor = &mut self.brake_resistor;
        let unit_j = BUS.resistor_w as f32 / config.limits.rate_hz;
        let max_heat = (BUS.resistor_j as f32 / unit_j) as u32;
        let threshold = if resistor.is_on {
            OFF_COUNTS
        } else {
            ON_COUNTS
        };
        resistor.is_on = supply_counts >= threshold && !resistor.is_hot;
        if resistor.is_on {
            resistor.heat += HEATING;
        } else {
            resistor.heat = resistor.heat.saturating_sub(1);
        }
        if resistor.heat < max_heat / 2 {
            resistor.is_hot = false;
        } else if resistor.heat > max_heat && !resistor.is_hot {
            resistor.is_hot = true;
            resistor.is_on = false;
            let joules = |heat: u32| heat as f32 * unit_j;
            let (value, most) = (joules(resistor.heat), joules(max_heat));
            self.raise_fault(FaultKind::BrakeResistorHot, None, value, most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mode::Mode;
    use crate::parameters::Parameters;

    const RATE_HZ: f64 = 20_000.0;

    fn counts(supply_v: f64) -> u16 {
        (supply_v / SUPPLY_V_PER_COUNT) as u16
    }

    #[test]
    fn it_goes_on_and_off_at_voltages_of_its_own() {
        let config = Config::new(&Parameters::REFERENCE);
        let mut state = State::new();
        let mut at = |supply_v: f64| {
            state.update_brake_resistor(&config, counts(supply_v));
            state.brake_resistor.is_on()
        };
        let seen = [48.0, 53.9, 54.1, 53.0, 52.1, 51.9, 53.0, 54.1].map(&mut at);
        assert_eq!(seen, [false, false, true, true, true, false, false, true]);
    }

    /// 356 W less 50 W fill 500 J in 1.63 s; it is off then, and on again when 250 J have gone at 50 W.
    #[test]
    fn it_is_on_no_longer_than_it_bears() {
        let config = Config::new(&Parameters::REFERENCE);
        let mut state = State::new();
        let (mut on_ticks, mut off_ticks) = (0, 0);
        while state.mode != Mode::Fault {
            state.update_brake_resistor(&config, counts(54.1));
            on_ticks += 1;
        }
        let fault = state.fault().expect("a fault");
        assert_eq!(fault.kind, FaultKind::BrakeResistorHot);
        assert!((fault.limit - 500.0).abs() < 0.1 && fault.value < 501.0);
        assert!(
            (1.5..1.7).contains(&(f64::from(on_ticks) / RATE_HZ)),
            "{on_ticks}"
        );
        while !state.brake_resistor.is_on() {
            state.update_brake_resistor(&config, counts(54.1));
            off_ticks += 1;
        }
        assert!(
            (4.9..5.1).contains(&(f64::from(off_ticks) / RATE_HZ)),
            "{off_ticks}"
        );
    }

    #[test]
    fn pulses_that_it_can_give_away_are_no_fault() {
        let config = Config::new(&Parameters::REFERENCE);
        let mut state = State::new();
        // A tick of eight is an eighth of 356 W: 44 W.
        for tick in 0..400_000 {
            let supply_v = if tick % 8 == 0 { 54.1 } else { 48.0 };
            state.update_brake_resistor(&config, counts(supply_v));
        }
        assert_eq!((state.fault(), state.mode), (None, Mode::Off));
        assert!(state.brake_resistor.heat < 1_000);
    }
}

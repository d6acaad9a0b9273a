//! The brake resistor on the bus: it takes what the motors give back, as long as it bears that.

use super::units::SUPPLY_V_PER_COUNT;
use crate::drivers::power_stage::BUS;

/// Supply at which it is switched on, and under which it is switched off again, ADC counts.
const ON_COUNTS: u16 = (BUS.resistor_on_v / SUPPLY_V_PER_COUNT) as u16;
const OFF_COUNTS: u16 = (BUS.resistor_off_v / SUPPLY_V_PER_COUNT) as u16;
/// Power that it takes at a supply of one ADC count, W; it grows with the supply's square.
const W_AT_ONE_COUNT: f32 = (SUPPLY_V_PER_COUNT * SUPPLY_V_PER_COUNT / BUS.resistor_ohm) as f32;
/// Power that it can give away, W, and energy that it bears beyond that, J.
const GIVEN_AWAY_W: f32 = BUS.resistor_w as f32;
const MOST_J: f32 = BUS.resistor_j as f32;

/// Whether it is on, and how hot it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrakeResistor {
    is_on: bool,
    /// It has taken all that it bears, and stays off until half of that is gone.
    is_hot: bool,
    /// What it has taken and not yet given away, J.
    heat_j: f32,
}

impl BrakeResistor {
    /// The pin.
    #[inline]
    pub const fn is_on(&self) -> bool {
        self.is_on
    }

    /// Switches it by the measured supply, with so many ticks a second, in every mode. When it has become too hot: what it has taken,
    /// and what it bears, J.
    #[inline]
    pub fn update(&mut self, supply_counts: u16, rate_hz: f32) -> Option<[f32; 2]> {
        if supply_counts < OFF_COUNTS && self.heat_j == 0.0 {
            self.is_on = false;
            return None;
        }
        self.switch(supply_counts, rate_hz)
    }

    #[cold]
    fn switch(&mut self, supply_counts: u16, rate_hz: f32) -> Option<[f32; 2]> {
        let threshold = if self.is_on { OFF_COUNTS } else { ON_COUNTS };
        self.is_on = supply_counts >= threshold && !self.is_hot;
        let supply = f32::from(supply_counts);
        let taken_w = if self.is_on {
            supply * supply * W_AT_ONE_COUNT
        } else {
            0.0
        };
        let heat_j = self.heat_j + (taken_w - GIVEN_AWAY_W) / rate_hz;
        self.heat_j = if heat_j > 0.0 { heat_j } else { 0.0 };
        if self.heat_j < MOST_J / 2.0 {
            self.is_hot = false;
        } else if self.heat_j > MOST_J && !self.is_hot {
            self.is_hot = true;
            self.is_on = false;
            return Some([self.heat_j, MOST_J]);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f32 = 20_000.0;

    fn counts(supply_v: f64) -> u16 {
        (supply_v / SUPPLY_V_PER_COUNT) as u16
    }

    #[test]
    fn it_goes_on_and_off_at_voltages_of_its_own() {
        let mut resistor = BrakeResistor::default();
        let mut at = |supply_v: f64| {
            assert_eq!(resistor.update(counts(supply_v), RATE_HZ), None);
            resistor.is_on()
        };
        let seen = [48.0, 53.9, 54.1, 53.0, 52.1, 51.9, 53.0, 54.1].map(&mut at);
        assert_eq!(seen, [false, false, true, true, true, false, false, true]);
    }

    /// `(V^2 / 8.2 ohm - 50 W) t = 500 J`, at any voltage; it is off then, and on again when 250 J have gone at 50 W.
    #[test]
    fn it_is_on_no_longer_than_it_bears() {
        for supply_v in [54.1, 57.5] {
            let mut resistor = BrakeResistor::default();
            let (mut on_ticks, mut off_ticks) = (1.0, 0.0);
            let [taken_j, most_j] = loop {
                if let Some(joules) = resistor.update(counts(supply_v), RATE_HZ) {
                    break joules;
                }
                on_ticks += 1.0;
            };
            assert!(most_j == 500.0 && taken_j > most_j && taken_j < 500.1);
            let seconds = 500.0 / (supply_v * supply_v / 8.2 - 50.0);
            let share = on_ticks / f64::from(RATE_HZ) / seconds;
            assert!((share - 1.0).abs() < 2e-3, "{supply_v} V: {share}");
            while !resistor.is_on() {
                assert_eq!(resistor.update(counts(supply_v), RATE_HZ), None);
                off_ticks += 1.0;
            }
            assert!((4.98..5.02).contains(&(off_ticks / RATE_HZ)), "{off_ticks}");
        }
    }

    #[test]
    fn pulses_that_it_can_give_away_are_no_fault() {
        let mut resistor = BrakeResistor::default();
        // A tick of eight is an eighth of 356 W: 44 W.
        for tick in 0..400_000 {
            let supply_v = if tick % 8 == 0 { 54.1 } else { 48.0 };
            assert_eq!(resistor.update(counts(supply_v), RATE_HZ), None);
        }
        assert!(resistor.heat_j < 1.0, "{}", resistor.heat_j);
    }
}

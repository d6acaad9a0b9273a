//! The brake resistor on the bus: it takes what the motors give back, as long as it bears that. One that is open is found by what the
//! supply does while it should be on, and by its test while the bridges wake up or the stage rests
//! ([`brake_resistor_test`](super::brake_resistor_test)).
//!
//! The servo holds back nothing: what a motor gives back at a torque and a rate is fixed. Where the resistor is open the fault's reaction, shorted
//! windings, keeps the bus under what is too high in the hardest stops; figures are in `hal-sim/PLANT.md`.

use super::brake_resistor_test::BrakeResistorTest;
use super::units::SUPPLY_V_PER_COUNT;
use crate::drivers::power_stage::BUS;
use crate::fault::FaultKind;

/// Supply at which it is switched on, and under which it is switched off again, ADC counts.
const ON_COUNTS: u16 = (BUS.resistor_on_v / SUPPLY_V_PER_COUNT) as u16;
const OFF_COUNTS: u16 = (BUS.resistor_off_v / SUPPLY_V_PER_COUNT) as u16;
/// Ticks after which the supply has settled since it was switched on; rise from there that it would not let happen, and in how many ticks
/// in a row that is one.
///
/// It takes more than three motors give, so that the supply falls from when it is on. One millisecond: a supply that is too high
/// has charged the capacitor through its cable by then (0.24 ms; 0.12 V are left of 9 V), and is told as what it is. Three motors
/// raise the bus by 1.3 V in that time at the very most (6 A). Noise is 24 mV rms.
const SETTLING_TICKS: u8 = 20;
const RISEN_COUNTS: u16 = (0.75 / SUPPLY_V_PER_COUNT) as u16;
const RISEN_TICKS: u8 = 6;
/// Power that it takes at a supply of one ADC count, W; it grows with the supply's square.
const W_AT_ONE_COUNT: f32 = (SUPPLY_V_PER_COUNT * SUPPLY_V_PER_COUNT / BUS.resistor_ohm) as f32;
/// Power that it can give away, W, and energy that it bears beyond that, J.
const GIVEN_AWAY_W: f32 = BUS.resistor_w as f32;
const MOST_J: f32 = BUS.resistor_j as f32;

/// Whether it is on, and how hot it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrakeResistor {
    /// The supply is so high that it has to be on.
    is_on: bool,
    /// Its test has it on.
    is_pulsed: bool,
    /// It has taken all that it bears, and stays off until half of that is gone.
    is_hot: bool,
    /// Ticks since it was switched on, as long as the supply settles; the supply then, ADC counts; ticks in a row in which that has risen
    /// too far.
    settling_ticks: u8,
    settled_counts: u16,
    risen_ticks: u8,
    /// What it has taken and not yet given away, J.
    heat_j: f32,
    pub(super) test: BrakeResistorTest,
}

/// A fault of it, with value and limit.
pub type BrakeResistorFault = (FaultKind, [f32; 2]);

impl BrakeResistor {
    /// The pin.
    #[inline]
    pub const fn is_on(&self) -> bool {
        self.is_on || self.is_pulsed
    }

    /// Whether its test would tell nothing: it is on for the supply's sake, or has just taken more than it bears and stays off.
    pub(super) fn is_taken(&self) -> bool {
        self.is_on || self.heat_j > MOST_J
    }

    /// Switches it by the measured supply, and for its test, with so many ticks a second, in every mode.
    #[inline]
    pub fn update(
        &mut self,
        supply_counts: u16,
        rate_hz: f32,
        is_pulsed: bool,
    ) -> Option<BrakeResistorFault> {
        if supply_counts < OFF_COUNTS && self.heat_j == 0.0 && !is_pulsed {
            (self.is_on, self.is_pulsed) = (false, false);
            return None;
        }
        // Over what it bears no test heats it further.
        self.is_pulsed = is_pulsed && self.heat_j <= MOST_J;
        self.switch(supply_counts, rate_hz)
    }

    #[cold]
    fn switch(&mut self, supply_counts: u16, rate_hz: f32) -> Option<BrakeResistorFault> {
        let threshold = if self.is_on { OFF_COUNTS } else { ON_COUNTS };
        let wanted = supply_counts >= threshold && !self.is_hot;
        if wanted && !self.is_on {
            self.settling_ticks = 0;
        }
        self.is_on = wanted;
        let supply = f32::from(supply_counts);
        let taken_w = if self.is_on() {
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
            return Some((FaultKind::BrakeResistorHot, [self.heat_j, MOST_J]));
        }
        self.look_for_rise(supply_counts)
    }

    /// Told as long as it lasts: an acknowledgement does not have the servo on again over such a supply.
    fn look_for_rise(&mut self, supply_counts: u16) -> Option<BrakeResistorFault> {
        if self.settling_ticks < SETTLING_TICKS {
            self.settling_ticks += 1;
            self.settled_counts = supply_counts;
        }
        let most_counts = self.settled_counts.saturating_add(RISEN_COUNTS);
        if !self.is_on || supply_counts <= most_counts {
            self.risen_ticks = 0;
            return None;
        }
        self.risen_ticks = self.risen_ticks.saturating_add(1);
        if self.risen_ticks < RISEN_TICKS {
            return None;
        }
        let volts = |counts: u16| f32::from(counts) * SUPPLY_V_PER_COUNT as f32;
        let values = [volts(supply_counts), volts(most_counts)];
        Some((FaultKind::SupplyRises, values))
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
            assert_eq!(resistor.update(counts(supply_v), RATE_HZ, false), None);
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
                if let Some((kind, joules)) = resistor.update(counts(supply_v), RATE_HZ, false) {
                    assert_eq!(kind, FaultKind::BrakeResistorHot);
                    break joules;
                }
                on_ticks += 1.0;
            };
            assert!(most_j == 500.0 && taken_j > most_j && taken_j < 500.1);
            let seconds = 500.0 / (supply_v * supply_v / 8.2 - 50.0);
            let share = on_ticks / f64::from(RATE_HZ) / seconds;
            assert!((share - 1.0).abs() < 2e-3, "{supply_v} V: {share}");
            while !resistor.is_on() {
                assert_eq!(resistor.update(counts(supply_v), RATE_HZ, false), None);
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
            assert_eq!(resistor.update(counts(supply_v), RATE_HZ, false), None);
        }
        assert!(resistor.heat_j < 1.0, "{}", resistor.heat_j);
    }

    /// What the supply does once it should be on, in volts from tick to tick: the tick in which that is a fault.
    fn found(mut supply_v: impl FnMut(u32) -> f64) -> Option<(u32, [f32; 2])> {
        let mut resistor = BrakeResistor::default();
        (0..4_000).find_map(|tick| {
            let (kind, values) = resistor.update(counts(supply_v(tick)), RATE_HZ, false)?;
            assert_eq!(kind, FaultKind::SupplyRises);
            Some((tick, values))
        })
    }

    #[test]
    fn a_supply_that_rises_while_it_is_on_is_a_fault() {
        // Three motors that give back 6 A: 1.26 V/ms on 4.7 mF.
        let (tick, [value, limit]) = found(|tick| 53.0 + 0.063 * f64::from(tick)).unwrap();
        let on_tick = (1.0_f64 / 0.063).ceil();
        let late = f64::from(tick) - on_tick - 20.0 - 0.75 / 0.063;
        assert!((4.0..7.0).contains(&late), "{late}");
        assert!(
            value > limit && (limit - 56.0).abs() < 0.1,
            "{value} {limit}"
        );
        assert!(value < 56.6, "58 V are the next fault: {value}");
    }

    #[test]
    fn one_that_works_and_a_steady_supply_are_none() {
        // The bus goes on rising for two ticks, stays, and falls.
        assert_eq!(found(|tick| 54.1 + 0.6 * f64::from(tick.min(2))), None);
        // A wrong supply, which charges the capacitor in 0.24 ms, has another fault.
        let charged = |tick: u32| 57.5 - 10.0 * (-f64::from(tick) / 4.7).exp();
        assert_eq!(found(charged), None);
        // A spike.
        let spiked = |tick: u32| {
            if tick % 40 < 5 && tick > 40 {
                57.0
            } else {
                54.1
            }
        };
        assert_eq!(found(spiked), None);
    }

    /// As often as the servo can go on, 41 ticks to wake up and two commands: no fault for five seconds, and what it bears is not exceeded.
    #[test]
    fn its_test_is_counted_as_heat() {
        let mut resistor = BrakeResistor::default();
        let mut faults = 0;
        for tick in 0..400_000_u32 {
            let is_pulsed = tick % 43 < 16;
            let fault = resistor.update(counts(48.0), RATE_HZ, is_pulsed);
            assert!(fault.is_none() || tick > 100_000, "{tick}");
            faults += u32::from(fault.is_some());
            assert!(resistor.heat_j < MOST_J + 0.1, "{}", resistor.heat_j);
        }
        assert!(faults <= 1 && !resistor.is_on);
        // Once, and it is forgotten in some milliseconds.
        let mut once = BrakeResistor::default();
        for tick in 0..140 {
            assert_eq!(once.update(counts(48.0), RATE_HZ, tick < 16), None);
            assert_eq!(once.is_on(), tick < 16);
        }
        assert_eq!(once.heat_j, 0.0);
    }
}

//! The test of the brake resistor while the bridges wake up, and every two seconds while the stage rests under its servo: it is switched on
//! twice, and has to draw the supply down.
//!
//! What it draws, 5.9 A, flows through supply, cable and diode, which have 20 mohm together at the very least, and until that has settled
//! out of the bus's capacitor. No drop: resistor or switch is open, or on for good, when switching changes nothing.
//!
//! Five times eight ticks: off, on, off, on, off. The last four of each count; the first four let the bus settle (supply's resistance times
//! capacitor, 0.24 ms). Weights of 1, -4, 6, -4, 1 take out whatever changes slowly: a capacitor that is still being charged, mains ripple.
//! Nothing else draws or gives back then: bridges that wake up are open, and brake before their first pulse, which takes nothing from the
//! bus and gives it nothing, whether the motors turn or not; and what holds a stage at rest hardly changes. A motion that begins ends it.
//!
//! Two seconds: one that is on for good takes 280 W, gives 50 W away and has taken the 500 J that it bears after 2.2 s.
//!
//! No parameter leaves it out: a stage without a resistor relies on its capacitor alone, whose age nothing tells.
//!
//! | bus | drop, V |
//! |---|---|
//! | 20 mohm | 0.109 |
//! | 50 to 300 mohm (the simulated one has 50) | 0.16 to 0.17 |
//! | a supply that gives no more current, or is lower than the bus | 0.17 |
//! | resistor open, or on for good | 0 |
//!
//! Noise of the sum is 1.5 counts rms times the root of 4 (1 + 16 + 36 + 16 + 1), over 32: 13 mV. The limit is 4 counts, 64 mV: five standard
//! deviations from nothing, and three and a half under the 20 mohm. It has three tries, the first good one counts: a resistor that works is
//! refused once in 10^10 times, one that does not is passed once in 10^6.

mod run;

use crate::control::units::SUPPLY_V_PER_COUNT;

/// Ticks of a part of the test, and those of them that do not count.
const PART_TICKS: u32 = 8;
const SETTLING_TICKS: u32 = 4;
const PARTS: u32 = 5;
/// The weights of what is on, times the ticks that count: a drop of one ADC count.
const SUM_OF_A_COUNT: i32 = 8 * (PART_TICKS - SETTLING_TICKS) as i32;
/// The smallest drop that is one, ADC counts.
const LEAST_COUNTS: i32 = 4;
/// How often it is tried.
const TRIES: u8 = 3;
/// Ticks that it takes: what a pin does is measured in the tick after.
const TICKS: u32 = PARTS * PART_TICKS + 1;

/// The smallest drop that is one, V.
pub const LEAST_DROP_V: f64 = LEAST_COUNTS as f64 * SUPPLY_V_PER_COUNT;

/// How far it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::control) struct BrakeResistorTest {
    ticks_left: u8,
    /// For how long the stage has rested under its servo since the last one, ticks.
    rested_ticks: u32,
    sum: i32,
    tries: u8,
    /// The resistor was taken for something else: nothing can be said of it.
    is_void: bool,
    /// The supply's average before, ADC counts.
    supply: f32,
    /// What the last one has found, V.
    drop_v: Option<f32>,
}

impl BrakeResistorTest {
    /// Begins with the next tick, at this supply (ADC counts).
    fn start(&mut self, supply: f32) {
        *self = Self {
            ticks_left: TICKS as u8,
            supply,
            drop_v: self.drop_v,
            ..Self::default()
        };
    }

    /// Something has come in between.
    pub(in crate::control) fn stop(&mut self) {
        self.ticks_left = 0;
    }

    #[inline]
    pub(in crate::control) const fn is_under_way(&self) -> bool {
        self.ticks_left != 0
    }

    /// What the last one has found, V.
    #[inline]
    pub(in crate::control) const fn drop_v(&self) -> Option<f32> {
        self.drop_v
    }

    /// Takes the supply in a tick; whether the resistor is to be on from then on.
    fn take(&mut self, tick: u32, supply_counts: u16) -> bool {
        // Of the pin that the tick before has set.
        if let Some(before) = tick.checked_sub(1)
            && before % PART_TICKS >= SETTLING_TICKS
        {
            self.sum += weight(before) * i32::from(supply_counts);
        }
        weight(tick) < 0
    }
}

/// The weight of the part in which a tick is, none after the last; it is on in those with a negative one.
const fn weight(tick: u32) -> i32 {
    match tick / PART_TICKS {
        0 | 4 => 1,
        1 | 3 => -4,
        2 => 6,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The drop that it finds on a bus, V, whose supply is this in each tick while the pin is low, or high, and settles so fast.
    fn found(resistor_ohm: f64, source_ohm: f64, mut source_v: impl FnMut(u32) -> f64) -> f64 {
        const TICK_S: f64 = 50e-6;
        const STEPS: u32 = 50;
        let (mut test, mut is_on) = (BrakeResistorTest::default(), false);
        let mut volts = source_v(0);
        for tick in 0..TICKS {
            is_on = test.take(tick, (volts / SUPPLY_V_PER_COUNT).round() as u16);
            for _ in 0..STEPS {
                let fed_a = ((source_v(tick) - volts) / source_ohm).max(0.0);
                let drawn_a = if is_on { volts / resistor_ohm } else { 0.0 };
                volts += (fed_a - drawn_a) / 4.7e-3 * TICK_S / f64::from(STEPS);
            }
        }
        assert!(!is_on, "it is off at the end");
        f64::from(test.sum) / f64::from(SUM_OF_A_COUNT) * SUPPLY_V_PER_COUNT
    }

    #[test]
    fn a_drop_is_found_on_every_bus() {
        for (source_ohm, expected_v) in [(0.02, 0.109), (0.05, 0.170), (0.1, 0.173), (0.3, 0.164)] {
            let drop_v = found(8.2, source_ohm, |_| 47.5);
            println!("{source_ohm} ohm: {drop_v:.3} V");
            assert!(
                (drop_v / expected_v - 1.0).abs() < 0.1,
                "{source_ohm}: {drop_v}"
            );
        }
        // After a stop: the supply is lower than the bus, and feeds nothing.
        let drop_v = found(8.2, 0.05, |tick| if tick == 0 { 53.0 } else { 47.5 });
        println!("fed by nothing: {drop_v:.3} V");
        assert!((drop_v / 0.167 - 1.0).abs() < 0.1, "{drop_v}");
    }

    #[test]
    fn none_is_found_where_nothing_is_switched_whatever_the_supply_does() {
        let open = 1e9;
        assert_eq!(found(open, 0.05, |_| 47.5), 0.0);
        // Charged by 2 V/ms, discharged by a load.
        for slope_v in [0.1, -0.1] {
            let drop_v = found(open, 0.05, |tick| 40.0 + slope_v * f64::from(tick));
            assert!(drop_v.abs() < 0.02, "{slope_v} V a tick: {drop_v}");
        }
        // 100 Hz, 2.5 V to each side, at any phase; and a resistor that works is found beside it.
        for phase in 0..16 {
            let ripple = |tick: u32| {
                let turns = 100.0 * 50e-6 * f64::from(tick) + f64::from(phase) / 16.0;
                48.0 + 2.5 * (core::f64::consts::TAU * turns).sin()
            };
            let drop_v = found(open, 0.005, ripple);
            assert!(drop_v.abs() < LEAST_DROP_V / 2.0, "{phase}: {drop_v}");
            assert!(found(8.2, 0.05, ripple) > LEAST_DROP_V, "{phase}");
        }
    }
}

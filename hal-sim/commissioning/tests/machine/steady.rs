//! Steady rates both ways.

use super::{Machine, TIMING, Want};
use commissioning::dead_time::dead_time_share;
use commissioning::friction::SteadyRate;
use commissioning::record::Record;
use std::f64::consts::TAU;

/// Current from which a bridge's whole dead time counts, A.
pub const KNEE_A: f64 = 0.043;
/// Rates that are tried, rad/s.
pub const RATES: [f64; 3] = [0.3, 1.0, 3.0];

fn steady_rates(machine: &mut Machine, rate: f64) -> [SteadyRate; 3] {
    let start = machine.angle_rad;
    let mut phase = 0.0;
    let mut speed = 0.0;
    let mut sums = [[0.0; 3]; 3];
    // Whole turns of the motors: ten, or a second.
    let turn_s = TAU / 50.0 / rate.abs();
    let ticks = ((1.0 / turn_s).max(10.0).round() * turn_s / TIMING.tick_s).round() as usize;
    let settle = 6_000;
    for tick in 0..settle + ticks {
        speed += (rate - speed) * 2e-3;
        phase += speed * TIMING.tick_s;
        let wants = [0, 1, 2].map(|i| Want {
            angle_rad: start[i] + phase,
            rate_rad_s: speed,
        });
        let mut record = Record::default();
        machine.servo_tick(wants, [0.0; 3], Some(&mut record));
        if tick >= settle {
            for (sum, signals) in sums.iter_mut().zip(&record.pivots) {
                let current_a = signals.current_a[0];
                sum[0] += current_a / ticks as f64;
                sum[1] += signals.volts[0] / ticks as f64;
                sum[2] += dead_time_share(current_a, KNEE_A) / ticks as f64;
            }
        }
    }
    sums.map(|[current_a, volts, dead_time_share]| SteadyRate {
        rate_rad_s: rate,
        current_a,
        volts,
        dead_time_share,
    })
}

/// All of them, pivot by pivot.
pub fn all_rates(machine: &mut Machine) -> [Vec<SteadyRate>; 3] {
    let gains = std::mem::replace(&mut machine.gains, [4.0, 200.0]);
    let rates: Vec<_> = (RATES.iter()).flat_map(|rate| [*rate, -rate]).collect();
    let all: Vec<_> = rates
        .into_iter()
        .map(|rate| steady_rates(machine, rate))
        .collect();
    machine.gains = gains;
    [0, 1, 2].map(|pivot| all.iter().map(|pivots| pivots[pivot]).collect())
}

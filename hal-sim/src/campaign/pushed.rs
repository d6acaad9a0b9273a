//! Whether the same machine, sound, shows the controller the same when somebody pushes: three forces on the platform, or three torques at its
//! rings, turn the pivots on any course that three encoders can show, and currents that go with it are those of sound drives. What breaks
//! between motors and platform, or tells the encoders' readings apart from where the pivots are, looks like that.
//!
//! What no push explains is a drive whose voltage, current and rate do not go together: `R i + L di/dt + K rate - V`, another one than in
//! the sound run.

use super::inputs::{BLOCK, Block, COUNT_RAD, Inputs};
use super::scenario::Scenario;
use crate::machine::devices::{BridgeParameters, BridgeState};
use crate::machine::plant::{AXES, Drive};
use firmware::control::units::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT};

/// A push that nobody would wonder at, N at a pivot: a hand, a cable, another load.
pub(super) const MOST_N: f64 = 50.0;

/// Voltages of the drives, supply, bad frames.
const CHANNELS: usize = AXES + 2;

/// Share within which a drive's parameters are known: winding, bridge, sensors and magnets.
const KNOWN_WITHIN: f64 = 0.05;

/// What a push leaves unexplained, and how hard it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pushed {
    /// Largest difference of each channel that no push makes, over the noise of one sample and what is known no better; of bad
    /// frames, over one.
    left: [f64; CHANNELS],
    /// The hardest push, N at a pivot, but for what of it moves the platform besides the rings.
    pub push_n: f64,
}

impl Pushed {
    /// A run beside the sound one.
    pub fn of(run: &Inputs, sound: &Inputs, scenario: &Scenario) -> Self {
        let mut pushed = Self::default();
        let pairs: Vec<_> = run.beside(sound).collect();
        for three in pairs.windows(3) {
            for ring in 0..AXES {
                pushed.look(three, ring, scenario);
            }
        }
        let counts = noise_counts(scenario) * f64::from(BLOCK);
        for (one, two) in pairs {
            let supply = f64::from(one.supply.abs_diff(two.supply)) / counts;
            let bad_frames = f64::from(one.bad_frames.abs_diff(two.bad_frames));
            pushed.left[AXES] = pushed.left[AXES].max(supply);
            pushed.left[AXES + 1] = pushed.left[AXES + 1].max(bad_frames);
        }
        pushed
    }

    /// How much more is left than in sound runs.
    pub fn differ(&self, others: &[Self]) -> f64 {
        (0..CHANNELS)
            .map(|channel| {
                let most = (others.iter()).map(|other| other.left[channel]);
                self.left[channel] / most.fold(1.0, f64::max)
            })
            .fold(0.0, f64::max)
    }

    fn look(&mut self, three: &[(&Block, &Block)], ring: usize, scenario: &Scenario) {
        let (stage, plant) = (&scenario.stage, &scenario.stage.plant);
        let block_s = f64::from(BLOCK) * stage.period_s;
        let bridge = stage.wiring.bridge_of(ring);
        let port = usize::from(stage.wiring.port_of_ring[ring]);
        let is_exchanged = stage.wiring.leads_exchanged[ring];
        let motor_sign = if is_exchanged { -1.0 } else { 1.0 };
        let is_reversed = stage.encoders[ring].reversed;
        let count_rad = if is_reversed { -COUNT_RAD } else { COUNT_RAD };
        let per_block = motor_sign / f64::from(BLOCK);
        let last_a = |(one, two): &(&Block, &Block)| {
            let counts = one.last_currents[bridge] - two.last_currents[bridge];
            f64::from(counts) * CURRENT_A_PER_COUNT * motor_sign
        };
        let further_rad = |(one, two): &(&Block, &Block)| one.further(two, port) * count_rad;
        let (one, two) = three[1];
        let counts = f64::from(one.currents[bridge] - two.currents[bridge]);
        let current_a = counts * CURRENT_A_PER_COUNT * per_block;
        let rise_a_s = (last_a(&three[1]) - last_a(&three[0])) / block_s;
        let [before_rad, angle_rad, after_rad] = [0, 1, 2].map(|k| further_rad(&three[k]));
        // A block has the position of its last tick.
        let rate_rad_s = (angle_rad - before_rad) / block_s;
        let acceleration_rad_s2 = (after_rad - 2.0 * angle_rad + before_rad) / (block_s * block_s);
        let constant = plant.ring_torque_constant_n_m_a();
        let torque_n_m = constant * current_a - plant.drive_inertia_kg_m2() * acceleration_rad_s2;
        self.push_n = self.push_n.max(torque_n_m.abs() / plant.track_radius_m);
        if one.awake[bridge] != two.awake[bridge] {
            self.left[ring] = f64::INFINITY;
        } else if one.awake[bridge] == BLOCK {
            let warmer = plant.winding.resistance_per_k * plant.winding.start_k;
            let resistance_ohm = plant.resistance_ohm * (1.0 + warmer);
            let further_v = (one.volts[bridge] - two.volts[bridge]) * per_block;
            let resistive_v = resistance_ohm * current_a;
            let induced_v = constant * rate_rad_s + plant.inductance_h * rise_a_s;
            let left_v = resistive_v + induced_v - further_v;
            let noise_v = resistance_ohm * CURRENT_A_PER_COUNT * noise_counts(scenario);
            let known_v = noise_v + KNOWN_WITHIN * (resistive_v.abs() + induced_v.abs());
            self.left[ring] = self.left[ring].max(left_v.abs() / known_v);
        }
    }
}

/// Noise of a sample of a current or of the supply, ADC counts.
fn noise_counts(scenario: &Scenario) -> f64 {
    scenario.stage.analog.noise_counts.max(0.5)
}

/// The voltage that a bridge gives its motor by its pins, by the supply and the current that are read, V; none while it sleeps.
pub(super) fn bridge_v(
    pins: BridgeState,
    scenario: &Scenario,
    supply_counts: u16,
    current_counts: i16,
) -> Option<f64> {
    let parameters = BridgeParameters {
        supply_v: f64::from(supply_counts) * SUPPLY_V_PER_COUNT,
        ..scenario.stage.bridge
    };
    match pins.drive(&parameters, f64::from(current_counts) * CURRENT_A_PER_COUNT) {
        Drive::Voltage(volts) => Some(volts),
        Drive::Brake => Some(0.0),
        Drive::Coast => None,
    }
}

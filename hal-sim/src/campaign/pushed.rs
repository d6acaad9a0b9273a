//! Whether the same machine, sound, shows the controller the same when somebody pushes: three forces on the platform, or three torques at its
//! rings, turn the pivots on any course that three encoders can show, and currents that go with it are those of sound drives. What breaks
//! between motors and platform, or tells the encoders' readings apart from where the pivots are, looks like that.
//!
//! What no push explains is a drive whose voltage, current and rate do not go together: `R i + L di/dt + K rate - V`, another one than in
//! the sound run.

use super::inputs::{BLOCK, Block, COUNT_RAD, Inputs, noise_counts};
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
    /// Largest difference of each channel that no push makes, beyond what drives are known no better, over the noise of one sample; of bad
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
        for ring in 0..AXES {
            let drive = DriveOf::new(scenario, ring);
            for two in pairs.windows(2) {
                pushed.left[ring] = pushed.left[ring].max(drive.left(two));
            }
            for three in pairs.windows(3) {
                pushed.push_n = pushed.push_n.max(drive.push_n(three));
            }
        }
        for (one, two) in pairs {
            for (left, apart) in
                (pushed.left[AXES..].iter_mut()).zip(one.line_and_supply_apart(two, scenario))
            {
                *left = left.max(apart);
            }
        }
        pushed
    }

    /// How much more is left than in other sound runs, the largest of each channel: of the channel in which it is most.
    pub fn differ(&self, others: &[&Self]) -> f64 {
        (0..CHANNELS)
            .map(|channel| {
                let most = (others.iter()).map(|other| other.left[channel]);
                self.left[channel] / most.fold(1.0, f64::max)
            })
            .fold(0.0, f64::max)
    }
}

/// A run's block and the sound one's.
type Pair<'a> = (&'a Block, &'a Block);

/// What is between the inputs and a ring.
struct DriveOf<'a> {
    scenario: &'a Scenario,
    bridge: usize,
    port: usize,
    motor_sign: f64,
    /// An encoder's count, the ring's way.
    count_rad: f64,
    block_s: f64,
}

impl<'a> DriveOf<'a> {
    fn new(scenario: &'a Scenario, ring: usize) -> Self {
        let stage = &scenario.stage;
        let sign = |is_negative: bool| if is_negative { -1.0 } else { 1.0 };
        Self {
            scenario,
            bridge: stage.wiring.bridge_of(ring),
            port: usize::from(stage.wiring.port_of_ring[ring]),
            motor_sign: sign(stage.wiring.leads_exchanged[ring]),
            count_rad: sign(stage.encoders[ring].reversed) * COUNT_RAD,
            block_s: f64::from(BLOCK) * stage.period_s,
        }
    }

    fn further_rad(&self, (one, two): Pair<'_>) -> f64 {
        one.further(two, self.port) * self.count_rad
    }

    fn further_a(&self, (one, two): Pair<'_>) -> f64 {
        let counts = one.currents[self.bridge] - two.currents[self.bridge];
        f64::from(counts) * CURRENT_A_PER_COUNT * self.motor_sign / f64::from(BLOCK)
    }

    fn last_further_a(&self, (one, two): Pair<'_>) -> f64 {
        let counts = one.last_currents[self.bridge] - two.last_currents[self.bridge];
        f64::from(counts) * CURRENT_A_PER_COUNT * self.motor_sign
    }

    /// What no push makes of the second of two blocks, over noise.
    fn left(&self, two: &[Pair<'_>]) -> f64 {
        let (before, now) = (two[0], two[1]);
        let plant = &self.scenario.stage.plant;
        let warmer = plant.winding.resistance_per_k * plant.winding.start_k;
        let resistance_ohm = plant.resistance_ohm * (1.0 + warmer);
        let resistive_v = resistance_ohm * self.further_a(now);
        let [awake, awake_too] = [now.0, now.1].map(|block| block.awake[self.bridge]);
        let left_v = if awake != awake_too {
            // One drives and the other does not.
            plant.supply_v
        } else if awake == 0 {
            // Nothing flows, whatever is read.
            resistive_v.abs()
        } else {
            let rate_rad_s = (self.further_rad(now) - self.further_rad(before)) / self.block_s;
            let rise_a_s = (self.last_further_a(now) - self.last_further_a(before)) / self.block_s;
            let induced_v =
                plant.ring_torque_constant_n_m_a() * rate_rad_s + plant.inductance_h * rise_a_s;
            let further_v = (now.0.volts[self.bridge] - now.1.volts[self.bridge]) * self.motor_sign
                / f64::from(BLOCK);
            let known_v = KNOWN_WITHIN * (resistive_v.abs() + induced_v.abs());
            (resistive_v + induced_v - further_v).abs() - known_v
        };
        left_v / (resistance_ohm * CURRENT_A_PER_COUNT * noise_counts(self.scenario))
    }

    /// The push of the second of three blocks, N.
    fn push_n(&self, three: &[Pair<'_>]) -> f64 {
        let plant = &self.scenario.stage.plant;
        // A block has the position of its last tick.
        let [before, now, after] = [0, 1, 2].map(|k| self.further_rad(three[k]));
        let acceleration_rad_s2 = (after - 2.0 * now + before) / (self.block_s * self.block_s);
        let torque_n_m = plant.ring_torque_constant_n_m_a() * self.further_a(three[1])
            - plant.drive_inertia_kg_m2() * acceleration_rad_s2;
        torque_n_m.abs() / plant.track_radius_m
    }
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

//! What reaches the controller in a run, and whether it differs from what reaches it without the fault: what does not differ by more
//! than noise nobody can detect.

use firmware::drivers::biss::{RawFrame, decode};
use firmware::drivers::power_stage::signed_current_counts;

use super::scenario::Scenario;
use crate::machine::devices::biss::COUNTS_PER_TURN;
use crate::machine::devices::{Encoder, Stage};
use crate::machine::plant::AXES;

/// Ticks before the injection from which on it is taken: where drives were when it came.
pub(super) const BEFORE: u64 = 2 * BLOCK as u64;
/// Ticks that are taken together.
pub(super) const BLOCK: u32 = 20;
/// One count of an encoder, rad.
pub(super) const COUNT_RAD: f64 = core::f64::consts::TAU / COUNTS_PER_TURN as f64;

/// Encoders, currents, supply, bad frames.
const CHANNELS: usize = 2 * AXES + 2;

/// What a tick reads.
#[derive(Clone, Debug)]
pub struct Read {
    /// The encoders at the controller's ports.
    pub encoders: [Encoder; AXES],
    /// Motor currents, ADC counts.
    pub current_counts: [i16; AXES],
    /// Supply, ADC counts.
    pub supply_counts: u16,
}

impl Read {
    /// What the next tick will read.
    #[must_use]
    pub fn next(stage: &mut Stage) -> Self {
        let (currents, supply_counts) = stage.analog();
        Self {
            encoders: [0, 1, 2].map(|port| stage.encoder_at(port).clone()),
            current_counts: currents.map(signed_current_counts),
            supply_counts,
        }
    }
}

/// Noise of a sample of a current or of the supply, ADC counts.
pub(super) fn noise_counts(scenario: &Scenario) -> f64 {
    scenario.stage.analog.noise_counts.max(0.5)
}

/// Whether the controller can read an encoder's frame.
pub(super) fn is_bad(encoder: &Encoder) -> bool {
    decode(&RawFrame(encoder.frame_bytes())).is_err()
}

/// Sums of currents and supply, last positions and currents, and bad frames of some ticks; and what the controller has made of those before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Block {
    pub ticks: u32,
    pub positions: [u32; AXES],
    pub currents: [i32; AXES],
    pub last_currents: [i16; AXES],
    pub supply: u32,
    pub bad_frames: u32,
    /// Sums of the bridges' voltages up to the last tick, and ticks in which they were awake.
    pub volts: [f64; AXES],
    pub awake: [u32; AXES],
}

impl Block {
    /// By how much supply and bad frames differ from another run's: over the noise of one sample, and over one.
    pub fn line_and_supply_apart(&self, other: &Self, scenario: &Scenario) -> [f64; 2] {
        let counts = noise_counts(scenario) * f64::from(BLOCK);
        [
            f64::from(self.supply.abs_diff(other.supply)) / counts,
            f64::from(self.bad_frames.abs_diff(other.bad_frames)),
        ]
    }

    /// How far an encoder is further than in another run, counts.
    pub fn further(&self, other: &Self, port: usize) -> f64 {
        let half = COUNTS_PER_TURN / 2;
        let way = self.positions[port]
            .wrapping_sub(other.positions[port])
            .wrapping_add(half);
        f64::from(way % COUNTS_PER_TURN) - f64::from(half)
    }
}

/// What was read from [`BEFORE`] the injection on.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    blocks: Vec<Block>,
    /// The bridges' voltages from the last tick on.
    volts: [Option<f64>; AXES],
}

impl Inputs {
    /// Takes a tick: what it has read, and the voltages that it gives the bridges which it has awake.
    pub fn take(&mut self, read: &Read, volts: [Option<f64>; AXES]) {
        if (self.blocks.last()).is_none_or(|block| block.ticks == BLOCK) {
            self.blocks.push(Block::default());
        }
        let before = core::mem::replace(&mut self.volts, volts);
        let Some(block) = self.blocks.last_mut() else {
            return;
        };
        block.ticks += 1;
        block.supply += u32::from(read.supply_counts);
        block.last_currents = read.current_counts;
        for (i, before_v) in before.into_iter().enumerate() {
            block.positions[i] = read.encoders[i].position();
            block.currents[i] += i32::from(read.current_counts[i]);
            block.bad_frames += u32::from(is_bad(&read.encoders[i]));
            block.volts[i] += before_v.unwrap_or(0.0);
            block.awake[i] += u32::from(before_v.is_some());
        }
    }

    /// How much more it differs from the sound run's than that does from other sound runs, the largest of each channel: of the channel in which
    /// it is most.
    #[must_use]
    pub fn differ(&self, sound: &Self, others: &[&Self], scenario: &Scenario) -> f64 {
        let by_fault = self.apart(sound, scenario);
        let mut sound_ones = [1.0_f64; CHANNELS];
        for other in others {
            for (most, apart) in sound_ones.iter_mut().zip(other.apart(sound, scenario)) {
                *most = most.max(apart);
            }
        }
        (by_fault.into_iter().zip(sound_ones))
            .map(|(fault, sound)| fault / sound)
            .fold(0.0, f64::max)
    }

    /// Pairs of blocks that are whole in both.
    pub(super) fn beside<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = (&'a Block, &'a Block)> {
        (self.blocks.iter().zip(&other.blocks))
            .filter(|(one, two)| one.ticks == BLOCK && two.ticks == BLOCK)
    }

    /// Largest differences of each channel, over the noise of one sample; of bad frames, over one.
    fn apart(&self, other: &Self, scenario: &Scenario) -> [f64; CHANNELS] {
        let counts = noise_counts(scenario) * f64::from(BLOCK);
        let encoder = |i: usize| (scenario.stage.encoders[i].noise_rad / COUNT_RAD).max(0.5);
        self.beside(other)
            .map(|(one, two)| {
                let mut apart = [0.0; CHANNELS];
                for i in 0..AXES {
                    apart[i] = one.further(two, i).abs() / encoder(i);
                    apart[AXES + i] = f64::from(one.currents[i].abs_diff(two.currents[i])) / counts;
                }
                [apart[2 * AXES], apart[2 * AXES + 1]] = one.line_and_supply_apart(two, scenario);
                apart
            })
            .fold([0.0; CHANNELS], |most, apart: [f64; CHANNELS]| {
                core::array::from_fn(|i| most[i].max(apart[i]))
            })
    }

    /// Forgets it.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

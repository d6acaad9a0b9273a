//! What reaches the controller in a run, and whether it differs from what reaches it without the fault: what does not differ by more
//! than noise nobody can detect.

use firmware::drivers::biss::{RawFrame, decode};
use firmware::drivers::power_stage::signed_current_counts;

use super::scenario::Scenario;
use crate::machine::devices::biss::COUNTS_PER_TURN;
use crate::machine::devices::{Encoder, Stage};
use crate::machine::plant::AXES;

/// Ticks that are taken together.
const BLOCK: u32 = 20;
/// One count of an encoder, rad.
const COUNT_RAD: f64 = core::f64::consts::TAU / COUNTS_PER_TURN as f64;

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

/// Whether the controller can read an encoder's frame.
pub(super) fn is_bad(encoder: &Encoder) -> bool {
    decode(&RawFrame(encoder.frame_bytes())).is_err()
}

/// Mean currents and supply, last positions and bad frames of some ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Block {
    ticks: u32,
    positions: [u32; AXES],
    currents: [i32; AXES],
    supply: u32,
    bad_frames: u32,
}

/// What was read from the injection on.
#[derive(Clone, Debug, Default)]
pub struct Inputs(Vec<Block>);

impl Inputs {
    /// Takes a tick.
    pub fn take(&mut self, read: &Read) {
        if self.0.last().is_none_or(|block| block.ticks == BLOCK) {
            self.0.push(Block::default());
        }
        let Some(block) = self.0.last_mut() else {
            return;
        };
        block.ticks += 1;
        block.supply += u32::from(read.supply_counts);
        for i in 0..AXES {
            block.positions[i] = read.encoders[i].position();
            block.currents[i] += i32::from(read.current_counts[i]);
            block.bad_frames += u32::from(is_bad(&read.encoders[i]));
        }
    }

    /// How much more it differs from the sound run's than that does from other sound runs: of the channel in which it is most.
    #[must_use]
    pub fn differ(&self, sound: &Self, others: &[Self], scenario: &Scenario) -> f64 {
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

    /// Largest differences of each channel, over the noise of one sample; of bad frames, over one.
    fn apart(&self, other: &Self, scenario: &Scenario) -> [f64; CHANNELS] {
        let counts = scenario.stage.analog.noise_counts.max(0.5) * f64::from(BLOCK);
        let encoder = |i: usize| (scenario.stage.encoders[i].noise_rad / COUNT_RAD).max(0.5);
        (self.0.iter().zip(&other.0))
            .filter(|(one, two)| one.ticks == BLOCK && two.ticks == BLOCK)
            .map(|(one, two)| {
                let mut apart = [0.0; CHANNELS];
                for i in 0..AXES {
                    let half = COUNTS_PER_TURN / 2;
                    let way = one.positions[i]
                        .wrapping_sub(two.positions[i])
                        .wrapping_add(half);
                    let turned = f64::from((way % COUNTS_PER_TURN).abs_diff(half));
                    apart[i] = turned / encoder(i);
                    apart[AXES + i] = f64::from(one.currents[i].abs_diff(two.currents[i])) / counts;
                }
                apart[2 * AXES] = f64::from(one.supply.abs_diff(two.supply)) / counts;
                apart[2 * AXES + 1] = f64::from(one.bad_frames.abs_diff(two.bad_frames));
                apart
            })
            .fold([0.0; CHANNELS], |most, apart: [f64; CHANNELS]| {
                core::array::from_fn(|i| most[i].max(apart[i]))
            })
    }

    /// Forgets it.
    pub fn clear(&mut self) {
        self.0 = Vec::new();
    }
}

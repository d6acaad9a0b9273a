//! One absolute encoder on a pivot ring: 26 bits a turn, BiSS-C.
//!
//! It samples when it is latched and answers every transfer with that frame until it is latched again: as a `u64` for
//! a chip model that shifts bits, and as an [`SpiBus`] for a driver on the host.

use core::convert::Infallible;
use core::f64::consts::TAU;
use serde::{Deserialize, Serialize};

use embedded_hal::spi::{ErrorType, SpiBus};
use kinematics::Scalar;

use super::biss::{self, COUNTS_PER_TURN, Preamble};
use crate::machine::plant::Imperfections;
use crate::random::Random;

/// What an encoder is made and mounted like.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EncoderParameters {
    /// Position that it reports where the ring's angle is zero, counts.
    pub zero_counts: u32,
    /// Whether its counts fall while the ring's angle rises.
    pub reversed: bool,
    /// Standard deviation of its noise, rad.
    pub noise_rad: f64,
    /// Amplitude of the error that one turn repeats once, rad.
    pub eccentricity_rad: f64,
    /// Ring angle at which that error is zero and rising, rad.
    pub eccentricity_phase_rad: f64,
    /// Cosine and sine of two to twelve times the ring's angle in its error, rad.
    pub harmonics_rad: [[f64; 2]; 11],
    /// Amplitude of its error within a period of the scale, rad: of a sine of the scale's place under the head.
    pub subdivisional_error_rad: f64,
    /// Periods of the scale in a turn.
    pub scale_periods_per_turn: u32,
    /// Share of the bits on its line that are wrong.
    pub bit_error_rate: f64,
    /// Age of the sample when it is latched, s.
    pub latency_s: f64,
    /// Idle and acknowledge clocks of its frames.
    pub preamble: Preamble,
}

impl EncoderParameters {
    /// Noise of a third of an LSB (makers of 26 bit rings state some nanometres; this is 3 nm on the track), 5 urad
    /// of eccentricity (0.25 um between disc and bearing on a disc of 50 mm radius), an error of 40 nm within the 20 um that the
    /// lines of such a disc are apart, a wrong bit in ten million, and no extra latency.
    pub const REFERENCE: Self = Self {
        zero_counts: 0,
        reversed: false,
        noise_rad: 30e-9,
        eccentricity_rad: 5e-6,
        eccentricity_phase_rad: 0.0,
        harmonics_rad: [[0.0; 2]; 11],
        subdivisional_error_rad: 0.8e-6,
        scale_periods_per_turn: 15_708,
        bit_error_rate: 1e-7,
        latency_s: 0.0,
        preamble: Preamble::DEFAULT,
    };
}

/// What is wrong with an encoder or its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncoderFault {
    /// The line stays high: broken wire, no power.
    StuckHigh,
    /// The line stays low: short circuit.
    StuckLow,
    /// Every sample repeats the last one, with a good CRC.
    Frozen,
    /// These bits of the next frame are flipped; the frames after it are good again.
    BadFrame {
        /// Bits of the 64 clocks, first clock is bit 63.
        flip: u64,
    },
    /// The error bit is raised.
    ErrorBit,
    /// The warning bit is raised.
    WarningBit,
    /// The position has jumped and stays off.
    Jump {
        /// By how many counts.
        counts: i32,
    },
    /// The samples are older than they should be.
    Late {
        /// By this much, us.
        micros: u32,
    },
}

/// One encoder.
#[derive(Clone, Debug)]
pub struct Encoder {
    parameters: EncoderParameters,
    imperfections: Imperfections,
    noise: Random,
    line_noise: Random,
    fault: Option<EncoderFault>,
    offset_rad: f64,
    position: u32,
    frame: u64,
}

impl Encoder {
    /// An encoder whose noise depends on the seed alone, with these of its imperfections.
    #[must_use]
    pub fn new(parameters: EncoderParameters, seed: u64, imperfections: &Imperfections) -> Self {
        Self {
            parameters,
            imperfections: *imperfections,
            noise: Random::new(seed),
            // Another sequence: wrong bits do not change the noise.
            line_noise: Random::new(!seed),
            fault: None,
            offset_rad: 0.0,
            position: parameters.zero_counts % COUNTS_PER_TURN,
            frame: u64::MAX,
        }
    }

    /// Breaks the encoder in this way from the next latch on, or mends it.
    pub fn set_fault(&mut self, fault: impl Into<Option<EncoderFault>>) {
        self.fault = fault.into();
    }

    /// The fault that it has.
    #[must_use]
    pub const fn fault(&self) -> Option<EncoderFault> {
        self.fault
    }

    /// It reads so much more than the ring's angle from the next latch on: a disturbance with which the loop can be measured.
    pub fn set_offset(&mut self, offset_rad: f64) {
        self.offset_rad = offset_rad;
    }

    /// See [`Self::set_offset`].
    #[must_use]
    pub const fn offset_rad(&self) -> f64 {
        self.offset_rad
    }

    /// Samples the ring at its angle (rad, multi-turn) and rate (rad/s).
    pub fn latch(&mut self, angle_rad: f64, rate_rad_s: f64) {
        if self.fault != Some(EncoderFault::Frozen) {
            self.position = self.sample(angle_rad, rate_rad_s);
        }
        self.frame = self.line() ^ self.wrong_bits();
        if let Some(EncoderFault::BadFrame { .. }) = self.fault {
            self.fault = None;
        }
    }

    /// The latched frame, first clock in bit 63.
    #[must_use]
    pub const fn frame(&self) -> u64 {
        self.frame
    }

    /// The latched frame as an SPI master stores it, most significant bit first.
    #[must_use]
    pub const fn frame_bytes(&self) -> [u8; 8] {
        self.frame.to_be_bytes()
    }

    /// The position that it last sampled, counts.
    #[must_use]
    pub const fn position(&self) -> u32 {
        self.position
    }

    fn sample(&mut self, angle_rad: f64, rate_rad_s: f64) -> u32 {
        let late_s = match self.fault {
            Some(EncoderFault::Late { micros }) => f64::from(micros) * 1e-6,
            _ => 0.0,
        };
        let seen_rad = angle_rad - rate_rad_s * (self.parameters.latency_s + late_s);
        let read_rad = seen_rad + self.error_rad(seen_rad) + self.noise() + self.offset_rad;
        let counts = (read_rad * (f64::from(COUNTS_PER_TURN) / TAU)).round() as i64;
        let counts = if self.parameters.reversed {
            -counts
        } else {
            counts
        };
        let jump = match self.fault {
            Some(EncoderFault::Jump { counts }) => i64::from(counts),
            _ => 0,
        };
        // The mask wraps to one turn: two's complement makes negative counts come out right.
        (counts + i64::from(self.parameters.zero_counts) + jump) as u32 & (COUNTS_PER_TURN - 1)
    }

    /// What it reads too much at an angle of the ring, rad: that which every turn repeats.
    #[must_use]
    pub fn error_rad(&self, angle_rad: f64) -> f64 {
        let (parameters, on) = (&self.parameters, &self.imperfections);
        let mut error_rad = 0.0;
        if on.encoder_eccentricity {
            let (sin, _) = <f64 as Scalar>::sin_cos(angle_rad - parameters.eccentricity_phase_rad);
            error_rad += parameters.eccentricity_rad * sin;
        }
        if on.encoder_harmonics {
            error_rad += harmonics(&parameters.harmonics_rad, angle_rad);
        }
        if on.subdivisional_error {
            // By the lines that its head sees: a scale that is off its centre, or has its lines not where they belong, shows others.
            let periods = f64::from(parameters.scale_periods_per_turn);
            let (sin, _) = <f64 as Scalar>::sin_cos((angle_rad + error_rad) * periods);
            error_rad += parameters.subdivisional_error_rad * sin;
        }
        error_rad
    }

    /// Bits that the line turns over. Two in one frame are so rare that one is enough.
    fn wrong_bits(&mut self) -> u64 {
        if !self.imperfections.bit_errors {
            return 0;
        }
        let hit = self.line_noise.between(0.0, 1.0) / self.parameters.bit_error_rate;
        if hit < 64.0 { 1 << (hit as u32) } else { 0 }
    }

    fn noise(&mut self) -> f64 {
        if self.imperfections.encoder_noise {
            self.parameters.noise_rad * self.noise.normal()
        } else {
            0.0
        }
    }

    fn line(&self) -> u64 {
        let good =
            |error, warning| biss::encode(self.position, error, warning, self.parameters.preamble);
        match self.fault {
            Some(EncoderFault::StuckHigh) => u64::MAX,
            Some(EncoderFault::StuckLow) => 0,
            Some(EncoderFault::BadFrame { flip }) => good(false, false) ^ flip,
            Some(EncoderFault::ErrorBit) => good(true, false),
            Some(EncoderFault::WarningBit) => good(false, true),
            _ => good(false, false),
        }
    }
}

/// Sum of the second to the twelfth harmonic.
fn harmonics(sizes_rad: &[[f64; 2]; 11], angle_rad: f64) -> f64 {
    let (sin, cos) = <f64 as Scalar>::sin_cos(angle_rad);
    let (mut harmonic_sin, mut harmonic_cos) = (sin, cos);
    let mut sum_rad = 0.0;
    for [in_phase_rad, across_rad] in sizes_rad {
        (harmonic_sin, harmonic_cos) = (
            harmonic_sin * cos + harmonic_cos * sin,
            harmonic_cos * cos - harmonic_sin * sin,
        );
        sum_rad += in_phase_rad * harmonic_cos + across_rad * harmonic_sin;
    }
    sum_rad
}

impl ErrorType for Encoder {
    type Error = Infallible;
}

/// Every transfer starts at the first clock of the latched frame and is a whole one; clocks past its end read low.
impl SpiBus<u8> for Encoder {
    fn read(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        let frame = self.frame_bytes();
        words.fill(0);
        for (word, byte) in words.iter_mut().zip(frame) {
            *word = byte;
        }
        Ok(())
    }

    fn write(&mut self, _words: &[u8]) -> Result<(), Infallible> {
        // BiSS-C has no data towards the encoder in this mode: only the clock counts.
        Ok(())
    }

    fn transfer(&mut self, read: &mut [u8], _write: &[u8]) -> Result<(), Infallible> {
        self.read(read)
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Infallible> {
        self.read(words)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

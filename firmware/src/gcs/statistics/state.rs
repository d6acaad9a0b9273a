//! What the loop has counted, snapshot after snapshot.

use crate::control::loop_counters::LoopCounters;
use crate::drivers::biss::POSITION_BITS;
use crate::queues::Snapshot;
use kinematics::Angle;

/// Since the start or since `LST`; the peak of the following error since it was told.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct Statistics {
    pub ticks: u64,
    pub cycles: u32,
    pub cycles_sum: u64,
    pub cycles_worst: u32,
    pub late: u32,
    pub peak_error: u32,
    pub commands: u32,
    pub refused: u32,
    /// Commands taken and refused up to the latest snapshot.
    pub counted: (u32, u32),
    /// The pivots of the latest snapshot; squares of the steps from one to the next, units of an angle, smoothed.
    pivots: Option<[Angle; 3]>,
    steps: [f32; 3],
}

/// Snapshots that the noise is averaged over: a tenth of a second.
const AVERAGED: f32 = 512.0;

impl Statistics {
    /// Takes the next snapshot.
    pub fn update(&mut self, snapshot: &Snapshot) {
        let LoopCounters {
            ticks,
            cycles,
            cycles_sum,
            cycles_worst,
            late,
            peak_error,
        } = snapshot.loop_counters;
        self.ticks += u64::from(ticks);
        self.cycles = cycles;
        self.cycles_sum += u64::from(cycles_sum);
        self.cycles_worst = self.cycles_worst.max(cycles_worst);
        self.late = self.late.saturating_add(late);
        self.peak_error = self.peak_error.max(peak_error);
        let (commands, refused) = self.counted;
        self.commands = (self.commands).wrapping_add(snapshot.commands.wrapping_sub(commands));
        self.refused = (self.refused).wrapping_add(snapshot.refused.wrapping_sub(refused));
        self.counted = (snapshot.commands, snapshot.refused);
        let before = self.pivots.replace(snapshot.pivots);
        let pivots = snapshot
            .pivots
            .into_iter()
            .zip(before.unwrap_or(snapshot.pivots));
        for (step, (pivot, before)) in self.steps.iter_mut().zip(pivots) {
            // Before the reference a pivot may jump by turns.
            let units = (pivot - before).fraction().cast_signed() as f32;
            *step += (units * units - *step) / AVERAGED;
        }
    }

    /// Noise of the encoders, rms, counts: a step from one reading to the next has that of both.
    pub fn noise_counts(&self) -> [f64; 3] {
        let units_per_count = (Angle::TURN.units() >> POSITION_BITS) as f64;
        self.steps
            .map(|step| libm::sqrt(f64::from(step) / 2.0) / units_per_count)
    }

    pub fn restart(&mut self) {
        *self = Self {
            counted: self.counted,
            pivots: self.pivots,
            steps: self.steps,
            ..Self::default()
        };
    }
}

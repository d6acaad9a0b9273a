//! Waveforms: what changes tables and generators.

use super::Stage;
use super::axis::Axis;
use super::wave::{WaveAction, Waves};
use crate::gcs::error::ErrorCode;
use crate::motion::{PERIOD_RANGE, Stop};
use crate::queues::CommandQueues;

impl Stage {
    pub const fn waves(&self) -> &Waves {
        &self.waves
    }

    /// `WAV`, `WCL`, `WSL`, `WGC`, `WTR`, `WGO`: what a generator reads does not change while it runs.
    pub fn change_waves(
        &mut self,
        action: &WaveAction,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        if let WaveAction::Go(modes) = action {
            return self.switch_generators(modes, queues);
        }
        if self.generators_going() != [false; 6] {
            return Err(ErrorCode::GeneratorActive);
        }
        match action {
            WaveAction::Define {
                table,
                join,
                length,
                shape,
            } => self
                .waves
                .define(usize::from(*table), *join, *length, *shape),
            WaveAction::Points {
                table,
                join,
                points,
            } => self
                .waves
                .define_points(usize::from(*table), *join, points.values()),
            WaveAction::Clear(wanted) => {
                for (table, _) in wanted.iter().enumerate().filter(|(_, wanted)| **wanted) {
                    self.waves.clear(table);
                }
                Ok(())
            }
            WaveAction::Select(tables) => {
                let frozen = |axis: Axis| {
                    axis.component().is_none() && tables[axis.index()].is_some_and(|t| t > 0)
                };
                if Axis::ALL.into_iter().any(frozen) {
                    return Err(ErrorCode::NotForStage);
                }
                for (generator, table) in self.waves.generators.iter_mut().zip(tables) {
                    generator.table = table.map_or(generator.table, |table| table as u8);
                }
                Ok(())
            }
            WaveAction::Cycles(cycles) => {
                for (generator, cycles) in self.waves.generators.iter_mut().zip(cycles) {
                    generator.cycles = cycles.unwrap_or(generator.cycles);
                }
                Ok(())
            }
            WaveAction::Rate(ticks) => {
                if !PERIOD_RANGE.contains(&f64::from(*ticks)) {
                    return Err(ErrorCode::OutOfRange);
                }
                self.waves.ticks = *ticks;
                Ok(())
            }
            WaveAction::Go(_) => Ok(()),
        }
    }

    fn switch_generators(
        &mut self,
        modes: &[Option<u32>; 6],
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let going = self.generators_going();
        let starting = modes.map(|mode| mode == Some(1));
        if going != [false; 6] {
            let stops = (modes.iter().zip(going)).any(|(mode, going)| going && *mode == Some(0));
            if starting != [false; 6] {
                return Err(ErrorCode::GeneratorActive);
            }
            if stops {
                // The axes move as one: all of them stop.
                self.stop(Stop::Smooth, queues);
            }
            return Ok(());
        }
        if starting == [false; 6] {
            return Ok(());
        }
        let has_wave = |axis: Axis| self.waves.table_of(axis).is_some();
        let mut named = Axis::ALL.into_iter().zip(starting);
        if named.any(|(axis, starts)| starts && !has_wave(axis)) {
            return Err(ErrorCode::NoWave);
        }
        self.run_waves(&starting, queues)
    }
}

//! Waveforms: what changes tables and generators.

use super::Commander;
use super::axis::Axis;
use super::wave::{WaveChange, Waveforms};
use crate::gcs::error::ErrorCode;
use crate::motion::{PERIODS, Stop};
use crate::queues::PanelLink;

impl Commander {
    pub const fn waves(&self) -> &Waveforms {
        &self.waves
    }

    /// `WAV`, `WCL`, `WSL`, `WGC`, `WTR`, `WGO`: what a generator reads does not change while it runs.
    pub fn change_waves(
        &mut self,
        action: &WaveChange,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        if let WaveChange::Go(modes) = action {
            return self.switch_generators(modes, link);
        }
        if self.running_generators() != [false; 6] {
            return Err(ErrorCode::GeneratorActive);
        }
        match action {
            WaveChange::Define {
                table,
                join,
                length,
                shape,
            } => self
                .waves
                .define(usize::from(*table), *join, *length, *shape),
            WaveChange::Points {
                table,
                join,
                points,
            } => self
                .waves
                .define_points(usize::from(*table), *join, points.values()),
            WaveChange::Clear(wanted) => {
                for (table, _) in wanted.iter().enumerate().filter(|(_, wanted)| **wanted) {
                    self.waves.clear(table);
                }
                Ok(())
            }
            WaveChange::Select(tables) => {
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
            WaveChange::Cycles(cycles) => {
                for (generator, cycles) in self.waves.generators.iter_mut().zip(cycles) {
                    generator.cycles = cycles.unwrap_or(generator.cycles);
                }
                Ok(())
            }
            WaveChange::Rate(ticks) => {
                if !PERIODS.contains(&f64::from(*ticks)) {
                    return Err(ErrorCode::OutOfRange);
                }
                self.waves.ticks = *ticks;
                Ok(())
            }
            WaveChange::Go(_) => Ok(()),
        }
    }

    fn switch_generators(
        &mut self,
        modes: &[Option<u32>; 6],
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        let running = self.running_generators();
        let starting = modes.map(|mode| mode == Some(1));
        if running != [false; 6] {
            let stops =
                (modes.iter().zip(running)).any(|(mode, running)| running && *mode == Some(0));
            if starting != [false; 6] {
                return Err(ErrorCode::GeneratorActive);
            }
            if stops {
                // The axes move as one: all of them stop.
                self.stop(Stop::Smooth, link);
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
        self.start_generators(&starting, link)
    }
}

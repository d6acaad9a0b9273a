//! Waveforms: what changes tables and generators.

use super::axis::Axis;
use super::error::CommandError;
use super::state::Commander;
use super::wave::{WaveChange, WaveError, Waveforms};
use crate::motion::{PERIOD_RANGE, Stop};
use crate::queues::CommandQueues;

impl Commander {
    /// Tables and generators.
    pub const fn waves(&self) -> &Waveforms {
        &self.waves
    }

    /// Changes tables and generators, starts and stops these: what a generator reads does not change while it runs.
    pub fn change_waves(
        &mut self,
        action: &WaveChange,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        if let WaveChange::Switch(modes) = action {
            return self.switch_generators(modes, queues);
        }
        if self.running_generators() != [false; 6] {
            return Err(CommandError::GeneratorsRunning);
        }
        match action {
            WaveChange::Define {
                table,
                join,
                length,
                shape,
            } => {
                let table = usize::from(*table);
                Ok(self.waves.define(table, *join, *length, *shape)?)
            }
            WaveChange::Points {
                table,
                join,
                points,
            } => {
                let table = usize::from(*table);
                Ok(self.waves.define_points(table, *join, points.values())?)
            }
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
                if let Some(axis) = Axis::ALL.into_iter().find(|&axis| frozen(axis)) {
                    return Err(WaveError::FrozenAxis(axis).into());
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
                if !PERIOD_RANGE.contains(&f64::from(*ticks)) {
                    return Err(CommandError::PeriodOutOfRange);
                }
                self.waves.ticks = *ticks;
                Ok(())
            }
            WaveChange::Switch(_) => Ok(()),
        }
    }

    fn switch_generators(
        &mut self,
        modes: &[Option<bool>; 6],
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let running = self.running_generators();
        let starting = modes.map(|mode| mode == Some(true));
        if running != [false; 6] {
            let stops =
                (modes.iter().zip(running)).any(|(mode, running)| running && *mode == Some(false));
            if starting != [false; 6] {
                return Err(CommandError::GeneratorsRunning);
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
        if let Some((axis, _)) = named.find(|&(axis, starts)| starts && !has_wave(axis)) {
            return Err(WaveError::NoTable(axis).into());
        }
        self.start_generators(&starting, queues)
    }
}

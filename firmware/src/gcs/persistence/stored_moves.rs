//! Tables of repeated moves, as they are stored.
//!
//! | bytes | what |
//! |---|---|
//! | 1 | number of tables |
//! | each 1, n | length of the name, name |
//! | 1, 1 | 0 learns, 1 frozen, 2 stopped; power of a half that is learnt at a time |
//! | 4 | trials |
//! | 4, 4, 4 | errors of the first trial, the best and the last, encoder counts, 32-bit floats |
//! | 8, 8 | what makes the motion the same; its ticks |
//! | 4, 2 | ticks from point to point; points |
//! | each 2, 2, 2 | volts of the pivots in units of 2 mV, two's complement |

use super::names::{read_name, write_name};
use crate::commander::Commander;
use crate::gcs::text::NAME_BYTES;
use crate::iterative_learning::{
    KeptTable, MOST_TABLES, POOL_POINTS, TableName, TableReport, TableState, TrialControl,
};
use crate::settings_store::{Reader, Sink};
use embedded_storage::nor_flash::NorFlash;

/// Bytes of the longest: of the pool a half is kept, the best of each table.
pub(super) const MOVES_BYTES: usize = 1 + MOST_TABLES * (1 + NAME_BYTES + 40) + POOL_POINTS / 2 * 6;

pub(super) fn write<S: Sink>(
    commander: &Commander,
    trial: &TrialControl<'_>,
    sink: &mut S,
) -> Result<(), S::Error> {
    sink.put(&[commander.kept_moves(trial).count() as u8])?;
    for (kept, points) in commander.kept_moves(trial) {
        let report = &kept.report;
        write_name(&report.name, sink)?;
        sink.put(&[code(report.state), kept.halvings])?;
        sink.put(&report.trials.to_le_bytes())?;
        for counts in report.error_counts {
            sink.put(&counts.to_le_bytes())?;
        }
        sink.put(&kept.key.to_le_bytes())?;
        sink.put(&kept.ticks.to_le_bytes())?;
        sink.put(&report.spacing_ticks.to_le_bytes())?;
        sink.put(&(points.len() as u16).to_le_bytes())?;
        for volts in points.iter().flatten() {
            sink.put(&volts.to_le_bytes())?;
        }
    }
    Ok(())
}

/// What is stored; `None` when it is none that [`write`] gives.
pub(super) fn read<F: NorFlash>(
    reader: &mut Reader<'_, F>,
    commander: &mut Commander,
    trial: &mut TrialControl<'_>,
) -> Option<()> {
    let [count] = reader.take()?;
    for _ in 0..count {
        let kept = read_table(reader)?;
        let mut points = || {
            let mut point = [0; 3];
            for volts in &mut point {
                *volts = i16::from_le_bytes(reader.take()?);
            }
            Some(point)
        };
        commander.restore_move(kept, &mut points, trial)?;
    }
    Some(())
}

fn read_table<F: NorFlash>(reader: &mut Reader<'_, F>) -> Option<KeptTable> {
    let name = read_name(reader)?;
    let [state, halvings] = reader.take()?;
    let trials = u32::from_le_bytes(reader.take()?);
    let mut error_counts = [0.0; 3];
    for counts in &mut error_counts {
        *counts = f32::from_le_bytes(reader.take()?);
    }
    let (key, ticks) = (
        u64::from_le_bytes(reader.take()?),
        u64::from_le_bytes(reader.take()?),
    );
    let spacing_ticks = u32::from_le_bytes(reader.take()?);
    let points = u16::from_le_bytes(reader.take()?).into();
    Some(KeptTable {
        report: TableReport {
            name: TableName::try_from(name.as_str()).ok()?,
            state: state_of(state)?,
            trials,
            error_counts,
            points,
            spacing_ticks,
            kept: true,
        },
        key,
        ticks,
        halvings,
    })
}

const fn code(state: TableState) -> u8 {
    match state {
        // One that waits has nothing to be kept.
        TableState::Waiting | TableState::Learning => 0,
        TableState::Frozen => 1,
        TableState::Stopped => 2,
    }
}

const fn state_of(code: u8) -> Option<TableState> {
    Some(match code {
        0 => TableState::Learning,
        1 => TableState::Frozen,
        2 => TableState::Stopped,
        _ => return None,
    })
}

//! `FLR?`: the fault record, in the form of `DRR?`, written as the output has room.
//!
//! When the servo is switched on meanwhile the record is no more; the rest is answered as not a number, with an error.

use super::readout::MAX_LINE_BYTES;
use crate::control::units::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT};
use crate::fault_record::{FaultRecord, FaultRecordRow, RetainedMemory};
use crate::gcs::error::ErrorCode;
use core::fmt::{self, Write as _};
use heapless::String;

const COLUMNS: [&str; 17] = [
    "tick",
    "mode (0 off, 1 holding, 2 moving, 3 fault, 4 stopping)",
    "fault (0 none)",
    "pivot 1 in deg",
    "pivot 2 in deg",
    "pivot 3 in deg",
    "error of pivot 1 in deg",
    "error of pivot 2 in deg",
    "error of pivot 3 in deg",
    "duty 1 in counts",
    "duty 2 in counts",
    "duty 3 in counts",
    "current 1 in A",
    "current 2 in A",
    "current 3 in A",
    "supply in V",
    "tick before in cycles",
];

/// Lines of the head besides the names.
const HEADER_LINES: usize = 6;
/// Degrees in 2^-32 turns.
const DEG: f64 = 360.0 / 4_294_967_296.0;

/// What is left of an answer.
pub(in crate::gcs) struct FaultRecordReadout {
    span: FaultRecord,
    /// Lines of the head that are written.
    header_lines_written: usize,
    cursor: u32,
    pub(super) left: u32,
}

impl FaultRecordReadout {
    pub(super) fn new(retained_memory: Option<&RetainedMemory>) -> Result<Self, ErrorCode> {
        let span = (retained_memory.and_then(RetainedMemory::fault_record))
            .ok_or(ErrorCode::NotRecorded)?;
        Ok(Self {
            span,
            header_lines_written: 0,
            cursor: span.first_row(),
            left: span.rows,
        })
    }

    /// The next line, with its end; `None` for a row that is gone.
    pub(super) fn line(
        &mut self,
        retained_memory: &RetainedMemory,
        period_s: f64,
        line: &mut String<MAX_LINE_BYTES>,
    ) -> bool {
        // The longest line fits; a longer one would be cut short.
        if self.header_lines_written < HEADER_LINES + COLUMNS.len() {
            let _ = self.header_line(period_s, line);
            let _ = line.write_str(" \n");
            self.header_lines_written += 1;
            return true;
        }
        let is_there = retained_memory.fault_record() == Some(self.span);
        let row = retained_memory.next(&self.span, &mut self.cursor);
        let row = row.filter(|_| is_there);
        let _ = row_line(row.as_ref(), line);
        self.left = self.left.saturating_sub(1);
        let _ = line.write_str(if self.left == 0 { "\n" } else { " \n" });
        row.is_some()
    }

    fn header_line(&self, period_s: f64, line: &mut String<MAX_LINE_BYTES>) -> fmt::Result {
        match self.header_lines_written {
            0 => write!(line, "# DIM = {}", COLUMNS.len()),
            1 => write!(line, "# NDATA = {}", self.span.rows),
            2 => write!(line, "# SAMPLE_TIME = {period_s}"),
            3 => write!(line, "# SEPARATOR = 32"),
            4 => write!(line, "# TYPE = 1"),
            at => match COLUMNS.get(at - 5) {
                Some(name) => write!(line, "# NAME{} = {name}", at - 5),
                None => write!(line, "# END_HEADER"),
            },
        }
    }
}

fn row_line(row: Option<&FaultRecordRow>, line: &mut String<MAX_LINE_BYTES>) -> fmt::Result {
    let Some(row) = row else {
        for _ in 1..COLUMNS.len() {
            line.write_str("NaN ")?;
        }
        return line.write_str("NaN");
    };
    write!(line, "{} {} {}", row.tick, row.mode, row.fault)?;
    for pivot in row.pivots {
        write!(line, " {:.9}", f64::from(pivot) * DEG)?;
    }
    for error in row.errors {
        write!(line, " {:.9}", f64::from(error) * DEG)?;
    }
    for duty in row.duty {
        write!(line, " {duty}")?;
    }
    for counts in row.current_counts {
        write!(line, " {:.3}", f64::from(counts) * CURRENT_A_PER_COUNT)?;
    }
    let supply_v = f64::from(row.supply_counts) * SUPPLY_V_PER_COUNT;
    write!(line, " {supply_v:.3} {}", row.tick_cycles)
}

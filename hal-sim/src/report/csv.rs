//! The trace and the moves as tables. Fixed decimals, so that the same run gives the same bytes.

use std::fs::File;
use std::path::Path;

use ::csv::Writer;

use super::sample::{Move, Sample, xy};
use super::trace::Trace;
use drawing::{ReportError, unwritable};

const TRACE_COLUMNS: [&str; 47] = [
    "time_s",
    "moving",
    "x_setpoint_mm",
    "y_setpoint_mm",
    "theta_setpoint_deg",
    "x_rate_mm_s",
    "y_rate_mm_s",
    "theta_rate_deg_s",
    "x_mm",
    "y_mm",
    "theta_deg",
    "x_following_error_um",
    "y_following_error_um",
    "theta_following_error_urad",
    "x_true_error_um",
    "y_true_error_um",
    "theta_true_error_urad",
    "pivot_1_setpoint_deg",
    "pivot_2_setpoint_deg",
    "pivot_3_setpoint_deg",
    "pivot_1_rate_rad_s",
    "pivot_2_rate_rad_s",
    "pivot_3_rate_rad_s",
    "pivot_1_error_lsb",
    "pivot_2_error_lsb",
    "pivot_3_error_lsb",
    "duty_1",
    "duty_2",
    "duty_3",
    "separation_deg",
    "xy_following_error_um",
    "xy_true_error_um",
    "integral_1_v",
    "integral_2_v",
    "integral_3_v",
    "model_current_1_a",
    "model_current_2_a",
    "model_current_3_a",
    "learnt_rate_1_v_s_rad",
    "learnt_rate_2_v_s_rad",
    "learnt_rate_3_v_s_rad",
    "learnt_torque_1_v_n_m",
    "learnt_torque_2_v_n_m",
    "learnt_torque_3_v_n_m",
    "learnt_friction_1_v",
    "learnt_friction_2_v",
    "learnt_friction_3_v",
];

const MOVE_COLUMNS: [&str; 7] = [
    "start_s",
    "profile_end_s",
    "settled_s",
    "settle_s",
    "x_mm",
    "y_mm",
    "theta_deg",
];

/// The trace's rows as a CSV file with a line of headings.
pub(super) fn write_trace(path: &Path, trace: &Trace) -> Result<(), ReportError> {
    let rows = trace.rows().iter().map(trace_row);
    write_table(path, &TRACE_COLUMNS, rows)
}

/// The moves as a CSV file with a line of headings; a move that did not settle has empty cells.
pub(super) fn write_moves(path: &Path, moves: &[Move]) -> Result<(), ReportError> {
    write_table(path, &MOVE_COLUMNS, moves.iter().map(move_row))
}

fn write_table<const N: usize>(
    path: &Path,
    columns: &[&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> Result<(), ReportError> {
    let file = File::create(path).map_err(unwritable(path))?;
    let mut writer = Writer::from_writer(file);
    let failed = |error: ::csv::Error| unwritable(path)(error.into());
    writer.write_record(columns).map_err(failed)?;
    for row in rows {
        writer.write_record(&row).map_err(failed)?;
    }
    writer.flush().map_err(unwritable(path))
}

fn trace_row(sample: &Sample) -> [String; TRACE_COLUMNS.len()] {
    let triples = [
        // A nanometre's thousandth, and 17 prad: far below an encoder LSB of 94 nrad.
        (sample.setpoint, 9),
        (sample.setpoint_rate, 6),
        (sample.pose, 9),
        (sample.following_error, 6),
        (sample.true_error, 6),
        (sample.pivot_setpoint_deg, 9),
        (sample.pivot_rate_rad_s, 9),
        (sample.pivot_error_lsb, 4),
        (sample.duty, 7),
        (sample.integral_v, 5),
        (sample.model_current_a, 5),
        (sample.learnt_rate_v_s_rad, 6),
        (sample.learnt_torque_v_n_m, 6),
        (sample.learnt_friction_v, 6),
    ];
    let mut cells = triples
        .into_iter()
        .flat_map(|(triple, decimals)| triple.map(|value| fixed(value, decimals)));
    std::array::from_fn(|column| match column {
        0 => fixed(sample.time_s, 6),
        1 => u8::from(sample.moving).to_string(),
        29 => fixed(sample.separation_deg, 6),
        30 => fixed(xy(&sample.following_error), 6),
        31 => fixed(xy(&sample.true_error), 6),
        _ => cells.next().unwrap_or_default(),
    })
}

fn move_row(one: &Move) -> [String; MOVE_COLUMNS.len()] {
    let maybe = |time_s: Option<f64>| time_s.map_or_else(String::new, |time_s| fixed(time_s, 6));
    let [x_mm, y_mm, theta_deg] = one.target.map(|value| fixed(value, 9));
    [
        fixed(one.start_s, 6),
        fixed(one.profile_end_s, 6),
        maybe(one.settled_s),
        maybe(one.settle_s()),
        x_mm,
        y_mm,
        theta_deg,
    ]
}

/// Fixed decimals without the sign of a zero.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_negative_zero() {
        assert_eq!(fixed(-0.0004, 3), "0.000");
        assert_eq!(fixed(-0.0006, 3), "-0.001");
        assert_eq!(fixed(f64::NAN, 3), "NaN");
    }
}

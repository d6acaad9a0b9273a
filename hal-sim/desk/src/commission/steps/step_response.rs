//! A small move, as it is asked for and as it is made: what a loop is like to whoever looks at a trace.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, Plot};
use drawing::colour;
use drawing::plane::{Axis, Curve, Plane};
use drawing::svg::{Rect, Svg};

/// Length of the move, along X, um.
const STEP_UM: f64 = 10.0;
/// Where the measured position counts as arrived, um from the target.
const WINDOW_UM: f64 = 0.2;
/// Rows of the record, one each tick.
const ROWS: usize = 1_200;
/// What is recorded: commanded and measured X.
const TABLES: [&str; 2] = ["X 1", "X 2"];
/// Time for the way back, s.
const LONGEST_S: f64 = 5.0;
const SHEET: [f64; 2] = [1_000.0, 360.0];

/// What the record shows, um and ms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shape {
    /// Farthest beyond the target.
    overshoot_um: f64,
    /// From the end of the commanded move until the measured one stays within the window; `None`: not in the record.
    settled_ms: Option<f64>,
    /// Mean of the last quarter less the target.
    left_um: f64,
}

/// Makes the move from where the stage is, tells what it looked like, and goes back.
pub(super) fn step_response(
    bench: &mut Bench<'_>,
    found: &mut Found,
) -> Result<(), CommissionError> {
    bench.reserve(ROWS)?;
    let step = format!("STE X {}", STEP_UM * 1e-3);
    let record = bench.record_tables(&TABLES.map(str::to_owned), ROWS, 1, Some(&step))?;
    bench.wait_for_target(LONGEST_S)?;
    bench.ask(&format!("MVR X {}", -STEP_UM * 1e-3))?;
    bench.wait_for_target(LONGEST_S)?;
    let column = |at: usize| -> Vec<f64> {
        let start_mm = record.rows[0][0];
        (record.rows.iter())
            .map(|row| (row[at] - start_mm) * 1e3)
            .collect()
    };
    let (asked_um, made_um) = (column(0), column(1));
    let shape = shape(&asked_um, &made_um, bench.period_s * 1e3);
    let settled = shape.settled_ms.map_or_else(
        || {
            format!(
                "not within {WINDOW_UM} um in {:.0} ms",
                ROWS as f64 * bench.period_s * 1e3
            )
        },
        |ms| format!("within {WINDOW_UM} um from {ms:.1} ms after it on"),
    );
    found.push(Finding::told(
        format!("a step of {STEP_UM} um along X"),
        format!(
            "{:.2} um beyond its target at most, {settled}, {:+.3} um left",
            shape.overshoot_um, shape.left_um
        ),
    ));
    found.number("overshoot of a step", shape.overshoot_um, "um");
    if let Some(ms) = shape.settled_ms {
        found.number("settling of a step", ms, "ms");
    }
    found
        .plots
        .push(plot(&asked_um, &made_um, bench.period_s * 1e3));
    Ok(())
}

fn shape(asked_um: &[f64], made_um: &[f64], tick_ms: f64) -> Shape {
    let target_um = asked_um.last().copied().unwrap_or_default();
    let ended = 1 + asked_um
        .iter()
        .rposition(|um| *um != target_um)
        .unwrap_or(0);
    let outside = made_um
        .iter()
        .rposition(|um| (um - target_um).abs() > WINDOW_UM);
    let settled = 1 + outside.unwrap_or(0);
    let last = &made_um[made_um.len() - made_um.len() / 4..];
    let way = target_um.signum();
    Shape {
        overshoot_um: (made_um.iter()).fold(0.0, |most, um| f64::max(most, (um - target_um) * way)),
        settled_ms: (settled < made_um.len())
            .then(|| settled.saturating_sub(ended) as f64 * tick_ms),
        left_um: last.iter().sum::<f64>() / last.len().max(1) as f64 - target_um,
    }
}

fn plot(asked_um: &[f64], made_um: &[f64], tick_ms: f64) -> Plot {
    let curve = |name, colour, dashed, values: &[f64]| Curve {
        name,
        colour,
        dashed,
        points: (values.iter().enumerate())
            .map(|(tick, um)| [tick as f64 * tick_ms, *um])
            .collect(),
    };
    let curves = [
        curve("asked for", colour::FAINT, true, asked_um),
        curve("measured", colour::ACT, false, made_um),
    ];
    let top = (made_um.iter()).fold(STEP_UM, |most, um| f64::max(most, *um)) + 0.2 * STEP_UM;
    let plane = Plane {
        title: "step along X, um",
        x: Axis::Linear(0.0, made_um.len() as f64 * tick_ms),
        y: Axis::Linear(-0.1 * STEP_UM, top),
        x_name: "time since its start, ms",
        curves: &curves,
        marks: &[STEP_UM],
    };
    let mut svg = Svg::new(SHEET[0], SHEET[1]);
    let frame = Rect {
        left: 60.0,
        top: 50.0,
        width: SHEET[0] - 95.0,
        height: SHEET[1] - 110.0,
    };
    plane.draw(&mut svg, &frame);
    Plot {
        caption: format!(
            "A step of {STEP_UM} um along X, from the encoders: what is asked for is a planned move, so what departs from it is the loop's."
        ),
        svg: svg.finish(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 um in 20 ticks of 0.05 ms, and a measurement that is late, goes beyond and comes back.
    #[test]
    fn overshoot_and_settling_are_those_of_the_record() {
        let asked: Vec<f64> = (0..200).map(|k| f64::from(k).min(20.0) / 2.0).collect();
        let made: Vec<f64> = (0..200)
            .map(|k| match k {
                0..25 => asked[k] * 0.9,
                25..60 => 10.5,
                _ => 10.1,
            })
            .collect();
        let found = shape(&asked, &made, 0.05);
        assert!((found.overshoot_um - 0.5).abs() < 1e-9, "{found:?}");
        assert_eq!(found.settled_ms, Some(f64::from(60 - 20) * 0.05));
        assert!((found.left_um - 0.1).abs() < 1e-9, "{found:?}");
        // The other way it is the same, and one that does not arrive is told.
        let back = |all: &[f64]| all.iter().map(|um| -um).collect::<Vec<_>>();
        let mirrored = shape(&back(&asked), &back(&made), 0.05);
        assert!((mirrored.overshoot_um - 0.5).abs() < 1e-9, "{mirrored:?}");
        let never = vec![10.5; 200];
        assert_eq!(shape(&asked, &never, 0.05).settled_ms, None);
    }
}

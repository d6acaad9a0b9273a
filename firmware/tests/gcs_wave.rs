//! Waveforms: what curves are, how tables are made of them, and what is refused.

mod gcs_bench;

use firmware::commander::wave::{Curve, Shape};
use gcs_bench::Bench;

fn curve(length: u32, start: u32) -> Curve {
    Curve {
        amplitude: 10.0,
        offset: 2.0,
        length,
        start,
    }
}

fn values(shape: &Shape, points: core::ops::Range<u32>) -> Vec<f64> {
    points.map(|point| shape.value(point, &[])).collect()
}

fn assert_near(values: &[f64], expected: &[f64]) {
    assert_eq!(values.len(), expected.len());
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-14, "{value} {expected}");
    }
}

#[test]
fn a_line_holds_its_ends() {
    let straight = Shape::Line {
        curve: curve(6, 2),
        speed_points: 0,
    };
    assert_near(
        &values(&straight, 0..10),
        &[2.0, 2.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 12.0, 12.0],
    );
}

#[test]
fn rounded_ends_are_as_fast_as_the_middle_and_symmetric() {
    let line = Shape::Line {
        curve: curve(101, 0),
        speed_points: 20,
    };
    let values = values(&line, 0..101);
    // Speed grows evenly to that of the middle: 10 over (100 - 20) points.
    for point in 20..80 {
        assert!((values[point + 1] - values[point] - 0.125).abs() < 1e-14);
    }
    for point in 1..20 {
        let bend = values[point + 1] - 2.0 * values[point] + values[point - 1];
        assert!((bend - 0.125 / 20.0).abs() < 1e-14, "{point}: {bend}");
    }
    for (point, value) in values.iter().enumerate() {
        assert!((value + values[100 - point] - 14.0).abs() < 1e-14);
    }
}

#[test]
fn ramps_and_sines_turn_at_their_centre() {
    let ramp = Shape::Ramp {
        curve: curve(6, 0),
        speed_points: 0,
        centre: 4,
    };
    assert_near(
        &values(&ramp, 0..8),
        &[2.0, 4.5, 7.0, 9.5, 12.0, 7.0, 2.0, 2.0],
    );
    let shifted = Shape::Ramp {
        curve: curve(6, 2),
        speed_points: 0,
        centre: 4,
    };
    // The last two points of the cycle come first.
    assert_near(&values(&shifted, 0..4), &[12.0, 7.0, 2.0, 4.5]);
    let sine = Shape::Sine {
        curve: curve(8, 0),
        centre: 4,
    };
    for (point, value) in values(&sine, 0..9).into_iter().enumerate() {
        let phase = std::f64::consts::TAU * point as f64 / 8.0;
        assert!((value - (7.0 - 5.0 * phase.cos())).abs() < 1e-14, "{point}");
    }
}

#[test]
fn tables_grow_and_are_cleared() {
    let mut bench = Bench::new();
    for (line, lengths) in [
        ("WAV 1 X LIN 500 10 0 500 0 50", [500, 0, 0]),
        ("WAV 1 & SIN_P 1000 5 10 1000 0 500", [1500, 0, 0]),
        ("WAV 1 + RAMP 2000 1 0 2000 499 100 1000", [2000, 0, 0]),
        ("WAV 2 X PNT 1 3 0.5 -1e-3 2", [2000, 3, 0]),
        ("WAV 3 X PNT 1 1 7", [2000, 3, 1]),
        ("WAV 2 & PNT 4 2 9 8", [2000, 5, 1]),
        ("WAV 2 & PNT 6 1 7", [2000, 6, 1]),
        ("WAV 2 X PNT 1 2 1 2", [2000, 2, 1]),
        ("WAV 2 & LIN 10 1 2 10 0 0", [2000, 12, 1]),
        ("WCL 1 3", [0, 12, 0]),
        (
            "wav 1 x lin 268435456 10 0 268435456 0 0",
            [268_435_456, 12, 0],
        ),
    ] {
        assert_eq!(bench.error_after(line), "0", "{line}");
        let [one, two, three] = lengths;
        assert_eq!(
            bench.say("WAV? 1 1 2 1 3 1\n"),
            format!("1 1={one} \n2 1={two} \n3 1={three}\n"),
            "{line}"
        );
    }
    assert_eq!(bench.error_after("WAV 1 & LIN 1 1 0 2 0 0"), "17");
}

#[test]
fn generators_are_set() {
    let mut bench = Bench::new();
    assert_eq!(bench.say("TWG?\n"), "6\n");
    assert_eq!(bench.error_after("WSL 1 2 2 3 6 1"), "0");
    assert_eq!(bench.say("WSL?\n"), "1=2 \n2=3 \n3=0 \n4=0 \n5=0 \n6=1\n");
    assert_eq!(bench.error_after("WGC 1 5"), "0");
    assert_eq!(bench.say("WGC? 1 6\nWGO? 2\n\x09"), "1=5 \n6=0\n2=0\n0\n");
    assert_eq!(bench.error_after("WTR 0 40 1"), "0");
    assert_eq!(bench.say("WTR? 1 6\n"), "1=40 1 \n6=40 1\n");
}

#[test]
fn what_is_refused() {
    let mut bench = Bench::ready();
    for (line, error) in [
        ("WAV", "24"),
        ("WAV 9 X LIN 1 1 0 2 0 0", "17"),
        ("WAV 0 X LIN 1 1 0 2 0 0", "17"),
        ("WAV 1.5 X LIN 1 1 0 2 0 0", "17"),
        ("WAV one X LIN 1 1 0 2 0 0", "25"),
        ("WAV 1", "24"),
        ("WAV 1 Y LIN 1 1 0 2 0 0", "17"),
        ("WAV 1 X SAW 1 1 0 2 0 0", "17"),
        ("WAV 1 X LIN 1 1 0 2 0", "24"),
        ("WAV 1 X LIN 1 1 0 2 0 0 0", "24"),
        ("WAV 1 X LIN 0 1 0 2 0 0", "17"),
        ("WAV 1 X LIN 1 1 0 1 0 0", "17"),
        ("WAV 1 X LIN 100 1 0 100 0 50", "17"),
        ("WAV 1 X LIN 1 inf 0 2 0 0", "25"),
        ("WAV 1 X RAMP 10 1 0 10 0 0 10", "17"),
        ("WAV 1 X RAMP 10 1 0 10 0 3 5", "17"),
        ("WAV 1 X SIN_P 10 1 0 10 10 5", "17"),
        ("WAV 1 X SIN_P 10 1 0 10 0 0", "17"),
        ("WAV 1 X PNT 1 2 1", "24"),
        ("WAV 1 X PNT 1 0", "24"),
        ("WAV? 1 2", "17"),
        ("WAV? 1", "24"),
        ("WCL", "24"),
        ("WCL 9", "17"),
        ("WSL 1 9", "17"),
        ("WSL 3 1", "34"),
        ("WSL 1 1 1 2", "22"),
        ("WGC 1 -1", "17"),
        ("WTR 0 20", "24"),
        ("WTR 0 20 2", "17"),
        ("WTR 7 20 0", "17"),
        ("WGO 1 2", "17"),
        ("WGO 1 1", "75"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.say("WAV? 1 1\nWSL? 3\n"), "1 1=0\n3=0\n");
    let many = format!("WAV 1 X PNT 1 33{}", " 1".repeat(33));
    assert_eq!(bench.error_after(&many), "24");
}

#[test]
fn the_store_of_points_ends_and_is_freed() {
    let mut bench = Bench::new();
    let values = " 1".repeat(32);
    for line in 0..32 {
        let join = if line == 0 { "X" } else { "&" };
        assert_eq!(
            bench.error_after(&format!("WAV 1 {join} PNT 1 32{values}")),
            "0"
        );
    }
    assert_eq!(bench.error_after("WAV 2 X PNT 1 1 5"), "67");
    assert_eq!(bench.say("WAV? 1 1 2 1\n"), "1 1=1024 \n2 1=0\n");
    // Begun anew, a table may use its own again.
    assert_eq!(bench.error_after(&format!("WAV 1 X PNT 1 32{values}")), "0");
    assert_eq!(bench.error_after("WAV 2 X PNT 1 1 5"), "0");
    // Eight segments a table.
    for _ in 0..7 {
        assert_eq!(bench.error_after("WAV 2 & LIN 2 1 0 2 0 0"), "0");
    }
    assert_eq!(bench.error_after("WAV 2 & LIN 2 1 0 2 0 0"), "67");
    assert_eq!(bench.error_after("WAV 2 X LIN 2 1 0 2 0 0"), "0");
}

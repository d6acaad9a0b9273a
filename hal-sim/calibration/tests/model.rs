//! The model against poses and angles of two machines that were computed elsewhere, and its derivatives against differences.

use std::collections::HashMap;

use calibration::model::{Contact, Ring};
use calibration::position::{pose, position, readings_rad};
use calibration::visit::{Rows, Seen, Visit};
use calibration::{Instrument, Kit, Machine, Noise, numbers};
use kinematics::{COEFFICIENTS, PivotCoefficients};

const LINES: [&str; 2] = [
    include_str!("../../../kinematics/tests/data/built-lines.json"),
    include_str!("../../../kinematics/tests/data/built-lines.csv"),
];
const ALL: [&str; 2] = [
    include_str!("../../../kinematics/tests/data/built-all.json"),
    include_str!("../../../kinematics/tests/data/built-all.csv"),
];

fn machine(json: &str) -> Machine {
    let numbers: HashMap<String, f64> = serde_json::from_str(json).expect("an object of numbers");
    [0, 1, 2].map(|i| {
        let mut pivot = PivotCoefficients {
            encoder_zero_rad: numbers[&format!("z{i}")],
            radius_error: numbers[&format!("dR{i}")],
            ring_centre: ["ax", "ay"].map(|name| numbers[&format!("{name}{i}")]),
            guide_error_rad: numbers[&format!("e{i}")],
            guide_offset: numbers[&format!("d{i}")],
            ..PivotCoefficients::IDEAL
        };
        for (pair, k) in pivot.encoder_rad.iter_mut().zip(1..) {
            *pair = ["Ec", "Es"].map(|name| numbers[&format!("{name}{k}_{i}")]);
        }
        for (pair, k) in pivot.runout.iter_mut().zip(2..) {
            *pair = ["rc", "rs"].map(|name| numbers[&format!("{name}{k}_{i}")]);
        }
        for (size, k) in pivot.straightness.iter_mut().zip(2..) {
            *size = numbers[&format!("S{k}_{i}")];
        }
        pivot
    })
}

/// Rows of a table: poses, ring angles, readings, places on the guides.
fn rows(csv: &str) -> Vec<[[f64; 3]; 4]> {
    let row = |line: &str| {
        let fields: Vec<f64> = (line.split(','))
            .map(|field| field.parse().expect("a number"))
            .collect();
        let (chunks, rest) = fields.as_chunks::<3>();
        assert!(rest.is_empty());
        <[[f64; 3]; 4]>::try_from(chunks).expect("twelve numbers")
    };
    csv.lines().skip(1).map(row).collect()
}

#[test]
fn readings_poses_and_places_are_those_of_the_vectors() {
    for [json, csv] in [LINES, ALL] {
        let machine = machine(json);
        let rows = rows(csv);
        assert_eq!(rows.len(), 200);
        let mut worst = [0.0_f64; 4];
        for [at, rings, readings, rhos] in rows {
            let computed = readings_rad(&machine, &at).expect("inside the disk");
            let back = pose(&machine, &readings).expect("a pose");
            for i in 0..3 {
                worst[0] = worst[0].max((computed[i] - readings[i]).abs());
                worst[1] = worst[1].max((back[i] - at[i]).abs());
                let ring = Ring::read(&machine[i], readings[i]);
                worst[2] = worst[2].max((ring.angle_rad - rings[i]).abs());
                let contact = Contact::new(i, &machine[i], &ring, &at);
                worst[3] = worst[3].max((contact.rho - rhos[i]).abs());
            }
        }
        println!("readings, poses, rings, rho: {worst:?}");
        assert!(worst.iter().all(|&worst| worst < 1e-11), "{worst:?}");
    }
}

/// A derivative by a difference of this size to both sides: errors are its square, and rounding over it.
const STEP: f64 = 1e-5;
const CLOSE: f64 = 1e-8;

fn difference<const N: usize>(value: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (above, below) = (value(STEP), value(-STEP));
    let mut slope = above;
    for (slope, below) in slope.iter_mut().zip(below) {
        *slope = (*slope - below) / (2.0 * STEP);
    }
    slope
}

#[test]
fn derivatives_of_poses_are_those_of_differences() {
    let machine = machine(ALL[0]);
    for [_, _, readings, _] in rows(ALL[1]).into_iter().step_by(20) {
        let at = position(&machine, &readings).expect("a pose");
        for pivot in 0..3 {
            for number in 0..COEFFICIENTS {
                let slope = difference(|step| {
                    let mut other = machine;
                    let mut list = numbers::to_list(&machine[pivot]);
                    list[number] += step;
                    other[pivot] = numbers::from_list(&list);
                    pose(&other, &readings).expect("a pose")
                });
                let column = at.by_numbers.column(pivot * COEFFICIENTS + number);
                for (row, slope) in slope.into_iter().enumerate() {
                    let off = (column[row] - slope).abs();
                    assert!(off < CLOSE, "{}: {off:e}", numbers::name(pivot, number));
                }
            }
            let slope = difference(|step| {
                let mut other = readings;
                other[pivot] += step;
                pose(&machine, &other).expect("a pose")
            });
            for (row, slope) in slope.into_iter().enumerate() {
                let off = (at.by_readings[(row, pivot)] - slope).abs();
                assert!(off < CLOSE, "reading {pivot}: {off:e}");
            }
        }
    }
}

/// Of everything that is seen, by everything that is unknown.
#[test]
fn derivatives_of_rows_are_those_of_differences() {
    let machine = machine(ALL[0]);
    let noise = Noise {
        length: 1.0,
        angle_rad: 0.5,
        encoder_rad: 0.0,
    };
    let mark = Seen::Mark {
        mark: 5,
        camera: 1,
        off: [0.1, -0.2],
    };
    let [_, _, readings_rad, _] = rows(ALL[1])[3];
    for (kit, seen) in [
        (Kit::Xyt, Seen::Pose([0.1, 0.2, 0.3])),
        (Kit::Xy, Seen::Place([0.1, 0.2])),
        (Kit::Theta, Seen::Turn(1.0)),
        (Kit::Camera2, mark),
        (Kit::Ends, Seen::End { end: 3 }),
    ] {
        let mut instrument = Instrument::new(kit, noise);
        instrument.alignment = [0.1, -0.05, 0.3, 0.2, 0.1, -0.2];
        let guess = instrument.guess();
        let sizes = vec![1.0; instrument.unknowns()];
        let visit = Visit { readings_rad, seen };
        let misses = |unknowns: &[f64]| {
            let rows = Rows::new(&instrument, &machine, unknowns, &visit).expect("a pose");
            <[f64; 3]>::from(rows.misses)
        };
        let rows = Rows::new(&instrument, &machine, &guess, &visit).expect("a pose");
        let mut columns = vec![[0.0; 3]; sizes.len()];
        rows.for_columns(&sizes, |column, values| columns[column] = values.into());
        for unknown in 0..guess.len() {
            let slope = difference(|step| {
                let mut other = guess.clone();
                other[unknown] += step;
                misses(&other)
            });
            let column = columns[calibration::MACHINE_NUMBERS + unknown];
            for &row in rows.seen {
                // What is said grows, so what is missed falls.
                let off = (column[row] + slope[row]).abs();
                assert!(off < CLOSE, "{kit}, unknown {unknown}: {off:e}");
            }
        }
        for pivot in 0..3 {
            for number in 0..COEFFICIENTS {
                let slope = difference(|step| {
                    let mut other = machine;
                    let mut list = numbers::to_list(&machine[pivot]);
                    list[number] += step;
                    other[pivot] = numbers::from_list(&list);
                    let rows = Rows::new(&instrument, &other, &guess, &visit).expect("a pose");
                    rows.misses.into()
                });
                for &row in rows.seen {
                    let column = columns[pivot * COEFFICIENTS + number];
                    let off = (column[row] + slope[row]).abs();
                    assert!(
                        off < CLOSE,
                        "{kit}, {}: {off:e}",
                        numbers::name(pivot, number)
                    );
                }
            }
        }
    }
}

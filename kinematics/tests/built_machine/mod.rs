//! The two built machines of `data/built-*.json` and their poses in `data/built-*.csv`, computed elsewhere by another
//! formula. Lengths are in track radii, angles in rad.
#![allow(dead_code, reason = "every test file uses its own part")]

use std::collections::HashMap;

use kinematics::{PivotCoefficients, Pose};

/// One row: a pose, its rings' true angles, what its encoders read, and places on the guides.
pub struct Row {
    pub pose: Pose<f64>,
    pub rings: [f64; 3],
    pub encoders: [f64; 3],
    pub rho: [f64; 3],
}

/// A machine and its poses.
pub struct BuiltMachine {
    pub name: &'static str,
    pub pivots: [PivotCoefficients; 3],
    pub rows: Vec<Row>,
}

/// Centres, radii, directions, offsets and zeros only.
pub fn lines() -> BuiltMachine {
    read(
        "lines",
        include_str!("../data/built-lines.json"),
        include_str!("../data/built-lines.csv"),
    )
}

/// Everything: curves too.
pub fn all() -> BuiltMachine {
    read(
        "all",
        include_str!("../data/built-all.json"),
        include_str!("../data/built-all.csv"),
    )
}

fn read(name: &'static str, json: &str, csv: &str) -> BuiltMachine {
    let rows: Vec<_> = csv.lines().skip(1).map(row).collect();
    assert_eq!(rows.len(), 200);
    BuiltMachine {
        name,
        pivots: pivots(json),
        rows,
    }
}

fn row(line: &str) -> Row {
    let fields: Vec<f64> = line
        .split(',')
        .map(|field| field.parse().expect("a number"))
        .collect();
    let [x, y, theta, p1, p2, p3, m1, m2, m3, r1, r2, r3] = fields[..] else {
        panic!("twelve fields in {line}");
    };
    Row {
        pose: Pose { x, y, theta },
        rings: [p1, p2, p3],
        encoders: [m1, m2, m3],
        rho: [r1, r2, r3],
    }
}

fn pivots(json: &str) -> [PivotCoefficients; 3] {
    let numbers: HashMap<String, f64> = serde_json::from_str(json).expect("an object of numbers");
    let number = |key: String| numbers[&key];
    [0, 1, 2].map(|i| {
        let pair =
            |curve: &str, k: usize| ["c", "s"].map(|part| number(format!("{curve}{part}{k}_{i}")));
        PivotCoefficients {
            encoder_zero_rad: number(format!("z{i}")),
            radius_error: number(format!("dR{i}")),
            ring_centre: ["ax", "ay"].map(|name| number(format!("{name}{i}"))),
            guide_error_rad: number(format!("e{i}")),
            guide_offset: number(format!("d{i}")),
            encoder_rad: std::array::from_fn(|k| pair("E", k + 1)),
            runout: std::array::from_fn(|k| pair("r", k + 2)),
            straightness: std::array::from_fn(|k| number(format!("S{}_{i}", k + 2))),
        }
    })
}

//! How far the pivots of built machines may be from the drawing, against what their poses show.

mod proptest_settings;

use firmware::calibration::{Calibration, CalibrationMargins};
use kinematics::{Corrections, Geometry, Line, PivotCoefficients, Pose, Series, corrected_inverse};
use proptest::prelude::*;
use proptest_settings::settings;
use std::f64::consts::{PI, TAU};

/// Of a turn in 2^-32.
const UNITS: f64 = 4_294_967_296.0;
/// Rings of the disk, directions and orientations that are looked at.
const POSES: [u32; 3] = [4, 24, 36];
/// The margins say at most so many times what is found.
const WIDE: f64 = 1.52;

fn pivot(numbers: [f64; 48], share: f64) -> PivotCoefficients {
    // What a workshop's machine is off: some three standard deviations.
    let mut sizes = [0.0; 48];
    sizes[..6].copy_from_slice(&[3e-3, 3e-3, 6e-4, 6e-4, 6e-3, 6e-3]);
    sizes[6..8].fill(6e-4);
    sizes[8..30].fill(4e-5);
    sizes[30..40].fill(5e-5);
    sizes[40..].fill(5e-5);
    let mut list = [0.0; 48];
    for ((list, size), number) in list.iter_mut().zip(sizes).zip(numbers) {
        *list = size * number * share;
    }
    PivotCoefficients::from_list(&list)
}

/// Margins as they are said, and the most that poses all over the disk show: track radii and rad.
fn said_and_found(pivots: &[PivotCoefficients; 3]) -> ([f64; 2], [f64; 2]) {
    let calibration: Calibration =
        Corrections::new(pivots, Series::new).expect("within the limits");
    let said = CalibrationMargins::new(pivots, &calibration, &Geometry::REFERENCE)
        .expect("within the limits");
    let built: Corrections<f64, Series<f64>> =
        Corrections::new(pivots, Series::new).expect("within the limits");
    let drawn = Corrections {
        lines: [Line::IDEAL; 3],
        curves: [Series::<f64>::ZERO; 3],
    };
    let mut found = [0.0_f64; 2];
    let [rings, directions, orientations] = POSES;
    for k in 0..rings * directions * orientations {
        let radius =
            Geometry::REFERENCE.usable_radius() * f64::from(k % rings + 1) / f64::from(rings);
        let direction = TAU * f64::from(k / rings % directions) / f64::from(directions);
        let pose = Pose {
            x: radius * direction.cos(),
            y: radius * direction.sin(),
            theta: TAU * f64::from(k / rings / directions) / f64::from(orientations),
        };
        let [drawn, built] =
            [&drawn, &built].map(|it| corrected_inverse(&pose, it).expect("a pose"));
        for i in 0..3 {
            let next = (i + 1) % 3;
            let apart = |angles: &[f64; 3]| angles[next] - angles[i];
            let closer = apart(&drawn.encoders) - apart(&built.encoders);
            let closer = (closer + PI).rem_euclid(TAU) - PI;
            found[0] = found[0].max((built.guides[i].rho() - drawn.guides[i].rho()).abs());
            found[1] = found[1].max(closer);
        }
    }
    let separation_rad = f64::from(said.separation) * TAU / UNITS;
    ([f64::from(said.guide), separation_rad], found)
}

#[test]
fn as_drawn_there_are_none() {
    let pivots = [PivotCoefficients::IDEAL; 3];
    let calibration = Corrections::new(&pivots, Series::new).expect("within the limits");
    let margins = CalibrationMargins::new(&pivots, &calibration, &Geometry::REFERENCE);
    assert_eq!(margins, Some(CalibrationMargins::NONE));
}

#[test]
fn zeros_apart_by_more_than_is_put_right_are_refused() {
    let mut pivots = [PivotCoefficients::IDEAL; 3];
    pivots[1].encoder_zero_rad = -0.035;
    let calibration = Corrections::new(&pivots, Series::new).expect("within the limits");
    assert!(CalibrationMargins::new(&pivots, &calibration, &Geometry::REFERENCE).is_none());
}

/// Machines of which every number is something: what the margins take from the supervisor is needed.
#[test]
fn margins_are_not_much_wider_than_needed() {
    let mut worst = [0.0_f64; 2];
    for machine in 0..100 {
        let pivots = [0, 1, 2].map(|i| {
            let number = |k: usize| {
                let place = f64::from(machine) * 144.0 + (48 * i + k) as f64;
                2.0 * (place * 0.618_033_988_749_895).fract() - 1.0
            };
            pivot(std::array::from_fn(number), 0.3)
        });
        let (said, found) = said_and_found(&pivots);
        for ((worst, said), found) in worst.iter_mut().zip(said).zip(found) {
            *worst = worst.max(said / found);
        }
    }
    println!("{worst:.2?} times what is found");
    assert!(worst.iter().all(|&wide| wide <= WIDE), "{worst:.2?}");
}

proptest! {
    #![proptest_config(settings(150))]

    #[test]
    fn no_pose_is_further_off(
        numbers in prop::array::uniform3(prop::array::uniform32(-1.0..1.0)),
        more in prop::array::uniform3(prop::array::uniform16(-1.0..1.0)),
        share in 0.05..0.3,
    ) {
        let pivots = [0, 1, 2].map(|i| {
            let mut all = [0.0; 48];
            all[..32].copy_from_slice(&numbers[i]);
            all[32..].copy_from_slice(&more[i]);
            pivot(all, share)
        });
        let (said, found) = said_and_found(&pivots);
        for (said, found) in said.into_iter().zip(found) {
            prop_assert!(said >= found, "{said:e} said, {found:e} found");
        }
    }
}

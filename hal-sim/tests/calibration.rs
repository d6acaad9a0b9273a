//! Machines that the fit has never seen, measured by simulated instruments: how far the true poses are from what is commanded with the
//! fitted numbers. The truth is the plant's geometry, in formulas of its own.

use calibration::frames::{Pair, Size, without_frames};
use calibration::plan::Stop;
use calibration::spread::over_disk;
use calibration::{
    Accuracy, DRAWN, Fit, FitError, Instrument, Kit, Machine, Noise, Seen, Visit, fit, plan,
};
use hal_sim::machine::instruments::camera::Camera;
use hal_sim::machine::instruments::interferometer::Interferometer;
use hal_sim::machine::instruments::{QuasiStatic, Unrepeated, commanded, survey, workshop};
use hal_sim::machine::plant::{Imperfections, Plant, PlantParameters};
use hal_sim::random::Random;

const RADIUS_M: f64 = 0.1;
/// nm in a track radius.
const NM: f64 = 1e9 * RADIUS_M;
const DISK: f64 = 0.8;

fn instrument(kit: Kit, noise_nm: f64, noise_urad: f64) -> Instrument {
    let noise = Noise {
        length: noise_nm / NM,
        angle_rad: noise_urad * 1e-6,
        encoder_rad: Noise::ENCODER_RAD,
    };
    Instrument::new(kit, noise)
}

fn stops(instrument: &Instrument, count: usize) -> Vec<Stop> {
    plan(instrument, count).expect("finite numbers").stops
}

fn size(truth: &QuasiStatic, fitted: &Machine) -> Size {
    let poses = over_disk(DISK).skip(5000).take(1000);
    without_frames(&commanded(truth, fitted, poses, &mut Random::new(1)).expect("inside the disk"))
        .size()
}

/// Fits a machine and proves it.
fn measured(instrument: &Instrument, stops: &[Stop], seed: u64) -> (Fit, Size, Accuracy) {
    let truth = workshop::machine(seed);
    let random = &mut Random::new(1000 + seed);
    let visits = survey(&truth, instrument, stops, random).expect("inside the disk");
    let fit = fit(instrument, &visits).expect("a fit");
    let size = size(&truth, &fit.machine);
    let predicted = Accuracy::new(&fit.machine, &fit.factor, &instrument.sizes());
    println!(
        "seed {seed}: {:.1} nm rms, {:.0} nm max, {:.3} urad; chi^2 {:.2}, held out {:.2}",
        size.place_rms * NM,
        size.place_max * NM,
        size.turn_rms_rad * 1e6,
        fit.chi2,
        fit.chi2_held_out
    );
    (fit, size, predicted.expect("a factor of full rank"))
}

fn hold(instrument: &Instrument, count: usize, [rms_nm, max_nm, urad]: [f64; 3]) {
    let stops = stops(instrument, count);
    for seed in 1..=3 {
        let (fit, size, predicted) = measured(instrument, &stops, seed);
        assert!(size.place_rms * NM < rms_nm, "seed {seed}: {size:?}");
        assert!(size.place_max * NM < max_nm, "seed {seed}: {size:?}");
        assert!(size.turn_rms_rad * 1e6 < urad, "seed {seed}: {size:?}");
        let ratio = size.place_rms / predicted.place_rms;
        assert!((0.77..1.3).contains(&ratio), "seed {seed}: {ratio}");
        assert!((0.8..1.2).contains(&fit.chi2), "seed {seed}: {}", fit.chi2);
        let held_out = fit.chi2_held_out;
        assert!((0.6..1.5).contains(&held_out), "seed {seed}: {held_out}");
        // Four standard deviations come by chance in one of some 25 such measurements.
        assert!(fit.outliers.len() <= 1, "seed {seed}: {:?}", fit.outliers);
        let scatter = fit.scatter_rad / instrument.noise.length;
        assert!(scatter < 0.5, "seed {seed}: {scatter}");
    }
}

#[test]
fn x_y_and_theta_measured_200_times() {
    hold(&instrument(Kit::Xyt, 50.0, 1.0), 200, [50.0, 160.0, 0.35]);
}

#[test]
fn x_and_y_of_a_target_measured_200_times() {
    hold(&instrument(Kit::Xy, 50.0, 0.0), 200, [70.0, 250.0, 0.9]);
}

#[test]
fn an_unknown_plate_under_a_camera_at_two_places() {
    hold(
        &instrument(Kit::Camera2, 50.0, 0.0),
        600,
        [40.0, 160.0, 0.3],
    );
}

/// No instrument at all: pivots against the ends of their guides, which stop them to 2 um. Encoders alone bring 84 um and 660 urad down
/// to some um; much of what is left is held by tolerances alone, and differs from machine to machine.
#[test]
fn ends_of_guides_touched_200_times() {
    let instrument = instrument(Kit::Ends, 2000.0, 0.0);
    let stops = stops(&instrument, 200);
    for seed in 1..=3 {
        let (fit, size, _) = measured(&instrument, &stops, seed);
        assert!(size.place_rms * NM < 6000.0, "seed {seed}: {size:?}");
        assert!(size.turn_rms_rad * 1e6 < 60.0, "seed {seed}: {size:?}");
        assert!(fit.outliers.is_empty(), "seed {seed}: {:?}", fit.outliers);
    }
}

/// The plate comes out of it as well: as good as the machine.
#[test]
fn the_plate_is_found() {
    let instrument = instrument(Kit::Camera2, 50.0, 0.0);
    let stops = stops(&instrument, 600);
    let truth = workshop::machine(1);
    // The same numbers are drawn again in `survey`.
    let camera = Camera::set_up(&instrument, RADIUS_M, &mut Random::new(7));
    let visits = survey(&truth, &instrument, &stops, &mut Random::new(7)).expect("in the disk");
    let fit = fit(&instrument, &visits).expect("a fit");
    let pairs: Vec<Pair> = (camera.marks_m.iter().enumerate())
        .map(|(mark, true_m)| {
            let at = instrument.mark_at(mark);
            Pair {
                asked: [fit.unknowns[at], fit.unknowns[at + 1], 0.0],
                reached: [true_m.x / RADIUS_M, true_m.y / RADIUS_M, 0.0],
            }
        })
        .collect();
    let size = without_frames(&pairs).size();
    assert!(size.place_rms * NM < 40.0, "{}", size.place_rms * NM);
    // The marks' mean distance from the middle was known to 1 ppm; radii of the machine alone would say 600 ppm.
    let fitted = |mark: usize| &fit.unknowns[instrument.mark_at(mark)..][..2];
    let marks = || instrument.marks.iter().enumerate();
    let along =
        marks().map(|(mark, drawn)| drawn[0] * fitted(mark)[0] + drawn[1] * fitted(mark)[1]);
    let square = marks().map(|(_, drawn)| drawn[0] * drawn[0] + drawn[1] * drawn[1]);
    let scale = along.sum::<f64>() / square.sum::<f64>();
    assert!((scale - 1.0).abs() < 3e-6, "{scale}");
}

/// Sixty poses to two LSB of the encoders on the track: 18.7 nm.
#[test]
fn sixty_planned_poses_with_fine_instruments() {
    let instrument = instrument(Kit::Xyt, 5.0, 0.1);
    let stops = stops(&instrument, 60);
    for seed in 1..=3 {
        let (_, size, _) = measured(&instrument, &stops, seed);
        assert!(size.place_rms * NM < 18.0, "seed {seed}: {size:?}");
        assert!(size.turn_rms_rad * 1e6 < 0.1, "seed {seed}: {size:?}");
    }
}

#[test]
fn machines_of_the_workshop_are_as_bad_as_they_should_be() {
    let sizes: Vec<Size> = (1..=20)
        .map(|seed| size(&workshop::machine(seed), &DRAWN))
        .collect();
    let mean = |value: &dyn Fn(&Size) -> f64| {
        (sizes.iter().map(|size| value(size).powi(2)).sum::<f64>() / sizes.len() as f64).sqrt()
    };
    let (xy_um, turn_urad) = (
        mean(&|size| size.place_rms) * NM / 1e3,
        mean(&|size| size.turn_rms_rad) * 1e6,
    );
    println!("{xy_um:.0} um, {turn_urad:.0} urad");
    // 84 um and 660 urad of all machines, by another program's model.
    assert!((65.0..105.0).contains(&xy_um), "{xy_um}");
    assert!((500.0..820.0).contains(&turn_urad), "{turn_urad}");
}

/// The instruments' machine is the plant that the loop runs on.
#[test]
fn a_machine_at_rest_is_the_plant() {
    let parameters = PlantParameters {
        imperfections: Imperfections {
            geometry: true,
            ..Imperfections::NONE
        },
        ..PlantParameters::REFERENCE
    };
    let mut plant = Plant::new(parameters);
    let ideal = hal_sim::machine::instruments::EncoderErrors::IDEAL;
    let at_rest = QuasiStatic::new(&parameters, [ideal; 3]);
    for [x, y, theta] in over_disk(DISK).take(50) {
        let pose = [x * RADIUS_M, y * RADIUS_M, theta];
        plant.set_pose_at_rest(pose);
        let readings = at_rest.readings_rad(pose).expect("inside the disk");
        assert_eq!(readings, plant.pivots_rad());
        let back = at_rest.pose(readings).expect("inside the disk");
        for (back, pose) in back.into_iter().zip(pose) {
            assert!((back - pose).abs() < 1e-14, "{back} {pose}");
        }
    }
}

fn some_visits(count: usize) -> (Instrument, QuasiStatic, Vec<Visit>) {
    let instrument = instrument(Kit::Xyt, 50.0, 1.0);
    let truth = workshop::machine(5);
    let random = &mut Random::new(5);
    let visits = survey(&truth, &instrument, &stops(&instrument, count), random);
    (instrument, truth, visits.expect("inside the disk"))
}

fn spoil(visit: &mut Visit, off_nm: f64) {
    if let Seen::Pose([x, ..]) = &mut visit.seen {
        *x += off_nm / NM;
    }
}

/// An interferometer that stands turned by a quarter, with its target 40 mm beside the middle.
#[test]
fn an_instrument_may_stand_anywhere() {
    let instrument = instrument(Kit::Xyt, 50.0, 1.0);
    let truth = workshop::machine(5);
    let random = &mut Random::new(5);
    let mut beams = Interferometer::set_up(instrument.noise, random);
    beams.axes = [0.3, -0.2, 1.6];
    beams.target = [0.02, -0.04, -2.9];
    let visits: Vec<Visit> = (stops(&instrument, 200).iter())
        .map(
            |&Stop {
                 pose: [x, y, theta],
                 ..
             }| {
                let pose = [x * RADIUS_M, y * RADIUS_M, theta];
                beams.visit(&truth, pose, random).expect("inside the disk")
            },
        )
        .collect();
    let size = size(&truth, &fit(&instrument, &visits).expect("a fit").machine);
    assert!(size.place_rms * NM < 50.0, "{}", size.place_rms * NM);
}

/// Guides that lose motion, scales with errors within a period, noise that is more than was said: what is left shows it, and what is
/// promised has it in it.
#[test]
fn what_a_machine_does_not_repeat_is_found() {
    let instrument = instrument(Kit::Xyt, 50.0, 1.0);
    let stops = stops(&instrument, 200);
    for seed in 1..=3 {
        let truth = workshop::machine(seed);
        let random = &mut Random::new(1000 + seed);
        let mut visits = survey(&truth, &instrument, &stops, random).expect("inside the disk");
        for visit in &mut visits {
            visit.readings_rad = visit.readings_rad.map(|m| m + 3e-6 * random.normal());
        }
        let fit = fit(&instrument, &visits).expect("a fit");
        let predicted = Accuracy::new(&fit.machine, &fit.factor, &instrument.sizes());
        let size = size(&truth, &fit.machine);
        let ratio = size.place_rms / predicted.expect("a factor of full rank").place_rms;
        println!(
            "seed {seed}: scatter {:.3} urad, {} outliers, chi^2 {:.2} and {:.1} of the noise alone, held out {:.2}, {:.1} nm, ratio {ratio:.2}",
            fit.scatter_rad * 1e6,
            fit.outliers.len(),
            fit.chi2,
            fit.chi2_of_noise,
            fit.chi2_held_out,
            size.place_rms * NM
        );
        assert!((fit.scatter_rad / 3e-6 - 1.0).abs() < 0.08, "seed {seed}");
        // Scatter is found from the rows that tell most of it, chi^2 is of all alike: chance alone would take it 0.07 apart.
        assert!((fit.chi2 - 1.0).abs() < 2e-2 && fit.chi2_of_noise > 5.0);
        assert!((0.7..1.4).contains(&ratio), "seed {seed}: {ratio}");
    }
}

/// Machines that repeat, and whose noise looks most like scatter of the 50 that are published: with all of their excess put down to it
/// the first would have 3.25 urad, most of what its fit promises.
#[test]
fn chance_is_hardly_taken_for_scatter() {
    let instrument = instrument(Kit::Xyt, 500.0, 10.0);
    let stops = stops(&instrument, 200);
    for seed in [28, 41] {
        let truth = workshop::machine(seed);
        let random = &mut Random::new(1000 + seed);
        let visits = survey(&truth, &instrument, &stops, random).expect("inside the disk");
        let fit = fit(&instrument, &visits).expect("a fit");
        println!("seed {seed}: scatter {:.3} urad", fit.scatter_rad * 1e6);
        assert!(fit.scatter_rad < 1.05e-6, "seed {seed}");
    }
}

/// Friction over stiffness of the guides, rms over the disk: 1.29 times their quotient. Another program's statics had 1.45.
#[test]
fn guides_lose_motion() {
    let lost_m = 1.0 / 50e6;
    let machine = workshop::machine(1).with_unrepeated(Unrepeated {
        lost_m,
        readings_rad: 0.0,
    });
    let random = &mut Random::new(1);
    let mut square = 0.0;
    let poses: Vec<[f64; 3]> = over_disk(DISK).take(2000).collect();
    for [x, y, theta] in &poses {
        let pose = [x * RADIUS_M, y * RADIUS_M, *theta];
        let readings = machine.readings_rad(pose).expect("inside the disk");
        let reached = machine.reached(readings, random).expect("inside the disk");
        square += (reached[0] - pose[0]).powi(2) + (reached[1] - pose[1]).powi(2);
    }
    let share = (square / poses.len() as f64).sqrt() / lost_m;
    println!("{share:.3} of friction over stiffness");
    assert!((1.16..1.42).contains(&share), "{share}");
}

/// Somebody knocked against the table now and then: those visits are found, all of them and no others, and do no harm.
#[test]
fn outliers_are_found_and_left_out() {
    let (instrument, truth, mut visits) = some_visits(200);
    // The last is one of those that are held out at first.
    for (visit, off_nm) in [(3, 20_000.0), (77, -2_000.0), (120, 600.0), (199, 1e6)] {
        spoil(&mut visits[visit], off_nm);
    }
    let fit = fit(&instrument, &visits).expect("a fit");
    assert_eq!(fit.outliers, [3, 77, 120, 199]);
    let size = size(&truth, &fit.machine);
    assert!(size.place_rms * NM < 50.0, "{}", size.place_rms * NM);
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let (instrument, _, visits) = some_visits(200);
    assert_eq!(
        fit(&instrument, &visits[..5]).err(),
        Some(FitError::TooFew {
            visits: 5,
            least: 12
        })
    );
    // One in twenty is off: too many for accidents.
    let mut spoiled = visits.clone();
    for visit in spoiled.iter_mut().step_by(20) {
        spoil(visit, 3e3);
    }
    let error = fit(&instrument, &spoiled).expect_err("too many");
    assert!(
        matches!(
            error,
            FitError::TooManyOutliers {
                outliers: 10,
                visits: 200,
                ..
            }
        ),
        "{error}"
    );
    // Encoders 1 and 2 are plugged in the wrong way round.
    let mut swapped = visits.clone();
    for visit in &mut swapped {
        visit.readings_rad.swap(0, 1);
    }
    let error = fit(&instrument, &swapped).expect_err("another machine");
    println!("{error}");
    // Poses that scatter by 20 um: no sound machine.
    let mut loose = visits.clone();
    let random = &mut Random::new(3);
    for visit in &mut loose {
        spoil(visit, 20_000.0 * random.normal());
    }
    let error = fit(&instrument, &loose).expect_err("too much scatter");
    assert!(matches!(error, FitError::TooManyOutliers { .. }), "{error}");
    // A camera's rows for an interferometer.
    let mut other = visits.clone();
    other[30].seen = Seen::Mark {
        mark: 0,
        camera: 0,
        off: [0.0; 2],
    };
    let error = fit(&instrument, &other).expect_err("no mark");
    assert_eq!(error.to_string(), "visit 31: the plate has no such mark");
    let mut lost = visits;
    lost[30].readings_rad[1] = f64::NAN;
    assert!(fit(&instrument, &lost).is_err());
}

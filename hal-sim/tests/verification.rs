//! A calibration is judged by what an instrument sees of commanded poses: a sound one holds what is predicted of it, another machine's,
//! one with two pivots exchanged and one with a changed number do not. The truth is the plant's geometry, in formulas of its own.

use calibration::frames::without_frames;
use calibration::plan::stops;
use calibration::{Accuracy, DRAWN, Instrument, Judged, Kit, Machine, Noise, Predicted, Visit};
use calibration::{fit, judge, numbers, plan};
use hal_sim::machine::instruments::interferometer::Interferometer;
use hal_sim::machine::instruments::{QuasiStatic, commanded, survey, workshop};
use hal_sim::random::Random;

const RADIUS_M: f64 = 0.1;
/// nm in a track radius.
const NM: f64 = 1e9 * RADIUS_M;
/// Poses of the sequence that a plan may have.
const PASSED: usize = 5000;

fn instrument() -> Instrument {
    let noise = Noise {
        length: 50.0 / NM,
        angle_rad: 1e-6,
        encoder_rad: Noise::ENCODER_RAD,
    };
    Instrument::new(Kit::Xyt, noise)
}

fn calibrated(truth: &QuasiStatic, seed: u64) -> (Machine, Predicted, Vec<Visit>) {
    let instrument = instrument();
    let planned = plan(&instrument, 200).expect("finite numbers");
    let random = &mut Random::new(1000 + seed);
    let visits = survey(truth, &instrument, &planned.stops, random).expect("inside the disk");
    let fit = fit(&instrument, &visits).expect("a fit");
    let accuracy = Accuracy::new(&fit.machine, &fit.factor, &instrument.sizes());
    let accuracy = accuracy.expect("a factor of full rank");
    let predicted = Predicted {
        place: accuracy.place_rms,
        turn_rad: accuracy.turn_rms_rad,
    };
    (fit.machine, predicted, visits)
}

/// What an instrument, set up anew, sees of poses that are commanded with the numbers of `given`; and the true errors, nm rms.
fn verified(
    truth: &QuasiStatic,
    given: &Machine,
    predicted: &Predicted,
    count: usize,
    seed: u64,
) -> (Judged, f64) {
    let instrument = instrument();
    let random = &mut Random::new(2000 + seed);
    let beams = Interferometer::set_up(instrument.noise, random);
    let poses = stops(&instrument, PASSED, count);
    let poses = poses.iter().map(|stop| stop.pose);
    let pairs = commanded(truth, given, poses, random).expect("inside the disk");
    let visits: Vec<Visit> = (pairs.iter())
        .map(|pair| {
            let [x, y, theta] = pair.reached;
            let pose = [x * RADIUS_M, y * RADIUS_M, theta];
            let seen = beams.read(pose, RADIUS_M, random);
            Visit::commanded(&pair.asked, seen).expect("inside the disk")
        })
        .collect();
    let judged = judge(&instrument, &DRAWN, &visits, predicted).expect("finite numbers");
    (judged, without_frames(&pairs).size().place_rms * NM)
}

#[test]
fn a_sound_calibration_holds_what_is_predicted() {
    for seed in 1..=3 {
        let truth = workshop::machine(seed);
        let (machine, predicted, _) = calibrated(&truth, seed);
        let (judged, true_nm) = verified(&truth, &machine, &predicted, 120, seed);
        let (places, turns) = (judged.places.expect("seen"), judged.turns.expect("seen"));
        println!(
            "seed {seed}: {:.1} nm seen, {:.1} nm of the stage, truly {true_nm:.1}, predicted {:.1}; ratios {:.3} {:.3}",
            places.seen * NM,
            places.of_stage() * NM,
            places.predicted_of_stage() * NM,
            places.ratio(),
            turns.ratio()
        );
        assert!((0.77..1.3).contains(&places.ratio()), "{places:?}");
        assert!((0.77..1.3).contains(&turns.ratio()), "{turns:?}");
    }
}

#[test]
fn wrong_calibrations_are_found() {
    let truth = workshop::machine(1);
    let (machine, predicted, visits) = calibrated(&truth, 1);
    let (others, ..) = calibrated(&workshop::machine(2), 2);
    let [first, second, third] = machine;
    let mut list = numbers::to_list(&machine[1]);
    // A digit of the guide's offset: 10 um.
    list[numbers::GUIDE_OFFSET] += 1e-4;
    let damaged = [first, numbers::from_list(&list), third];
    let instrument = instrument();
    let explained = |machine: &Machine| {
        let judged = judge(&instrument, machine, &visits, &Predicted::default());
        judged.expect("finite numbers").chi2
    };
    let (own, drawn) = (explained(&machine), explained(&DRAWN));
    println!("chi^2 of what was measured: own {own:.3}, drawn {drawn:.0}");
    for (what, wrong) in [
        ("another machine's", others),
        ("exchanged", [second, first, third]),
        ("damaged", damaged),
    ] {
        let (judged, true_nm) = verified(&truth, &wrong, &predicted, 60, 1);
        let places = judged.places.expect("seen");
        let chi2 = explained(&wrong);
        println!(
            "{what}: {:.0} nm seen, truly {true_nm:.0}; ratio {:.1}; chi^2 {chi2:.0}",
            places.seen * NM,
            places.ratio()
        );
        assert!(places.ratio() > 1.3, "{what}: {places:?}");
        assert!(chi2 > 1.2 * own, "{what}: {chi2} {own}");
    }
}

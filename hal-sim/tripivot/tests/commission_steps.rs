//! Single steps of commissioning, on machines whose controllers have been told of them.

use calibration::Seen;
use commissioning::drive_model::Electrical;
use commissioning::record::Timing;
use commissioning::tuning::{Gains, MOST_MS, PLACES, Plant};
use desk::calibrate::{Reader, Wanted, Way, measure};
use desk::commission::{ChoiceError, Chosen, Finding, GainsError, Machine, PutError, run};
use firmware::parameters::Parameters;
use hal_sim::machine::devices::{COUNTS_PER_TURN, SettingsFlash, StageParameters};
use hal_sim::machine::plant::Imperfections;
use hal_sim::machine::unknown;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use hal_sim::rig::{Told, loop_model};
use tripivot::attended::SimulatedMachine;

#[test]
fn a_slow_move_that_fails_leaves_the_speed_as_it_was() {
    let mut stage = StageParameters::REFERENCE;
    // A gap through which no servo of it holds still.
    stage.plant.backlash_rad = 5e-3;
    let mut machine = SimulatedMachine::told(&stage, SettingsFlash::in_memory(), Told::Machine);
    let speed = machine.ask("VLS?").expect("it answers");
    let chosen = Chosen::only("reference").expect("a step");
    let ran = run(&mut machine, &chosen, &mut |_| ()).expect("it answers");
    let failure = ran.done[0].failure.as_ref().expect("a failure");
    println!("{failure:?}");
    assert_eq!(machine.ask("VLS?").expect("it answers"), speed);
}

/// Under a frame of its user's, or another centre of rotation, a stage would go elsewhere than is meant, and be measured there.
#[test]
fn who_goes_to_places_is_told_of_a_frame_before_anything_moves() {
    for (lines, words) in [
        (["KSF HERE", "KEN HERE"], "the frame HERE is in force"),
        (["SPI R 5", "SPI S 2"], "is at R 5 S 2 mm"),
    ] {
        let stage = &StageParameters::REFERENCE;
        let mut machine = SimulatedMachine::told(stage, SettingsFlash::in_memory(), Told::Machine);
        for line in ["CCL 1 ADVANCED", "SPA 1 0x54500900 17", "FRF"] {
            machine.ask(line).expect("it is taken");
        }
        machine.delay(1.0).expect("it goes on");
        for line in lines {
            machine.ask(line).expect("it is taken");
        }
        let state = |machine: &mut SimulatedMachine| {
            ["SVO? X", "MOV?", "SPA? 1 0x54500900", "KEN?", "SPI?"]
                .map(|question| machine.ask(question).expect("it answers"))
        };
        let before = state(&mut machine);
        let mut told = Vec::new();
        let chosen = Chosen::only("verification").expect("a step");
        if let Err(error) = run(&mut machine, &chosen, &mut |_| ()) {
            told.push(error.to_string());
        }
        let way = Way {
            stops: &[],
            first: 0,
            radius_mm: 100.0,
            ends: &[],
            is_from_both_sides: false,
        };
        if let Err(error) = measure(&mut machine, &mut Nobody, &way, &mut |_| Ok(())) {
            told.push(error.to_string());
        }
        assert!(
            told.len() == 2 && told.iter().all(|told| told.contains(words)),
            "{told:?}"
        );
        assert_eq!(state(&mut machine), before);
    }
}

struct Nobody;

impl Reader for Nobody {
    fn read(&mut self, _: &Wanted) -> Result<Seen, String> {
        Err("nobody reads".to_owned())
    }
}

/// A kind machine has next to no friction: it creeps for a while once its motors are off, and goes where their cogging pulls it where no jig holds it.
#[test]
fn a_kind_machine_comes_to_rest_before_it_is_looked_at_and_its_jig_holds_it() {
    let options = RunOptions::default();
    let stage = stage_parameters(&options);
    for step in ["wiring", "zeros"] {
        let mut machine = SimulatedMachine::told(&stage, SettingsFlash::in_memory(), Told::Machine);
        let chosen = Chosen::only(step).expect("a step");
        let ran = run(&mut machine, &chosen, &mut |_| ()).expect("it answers");
        for finding in &ran.done[0].found.findings {
            println!("{step}: {}: {}", finding.name, finding.value);
        }
        assert_eq!(ran.done[0].failure, None, "{step}");
        // The jig stands where its words say, as well as it holds: 0.2 mrad, and 28 um at the track's radius. The worst here is 0.47, and a tenth more.
        for (told, truth) in machine.parameters().encoders.iter().zip(&stage.encoders) {
            let turns = (f64::from(told.zero_counts) - f64::from(truth.zero_counts))
                / f64::from(COUNTS_PER_TURN);
            let off_mrad = 1e3 * std::f64::consts::TAU * (turns - turns.round());
            println!("{step}: zero {off_mrad:.3} mrad off");
            assert!(step != "zeros" || off_mrad.abs() < 0.52, "{off_mrad}");
        }
    }
}

/// What its steps record with is not what the user does: neither after some that keep what they find nor after some that do not.
#[test]
fn the_recorder_is_the_users_again_after_commissioning() {
    for (chosen, last) in [
        (Chosen::only("forces").expect("a step"), "keep"),
        (Chosen::response(), "response"),
    ] {
        let stage = &StageParameters::REFERENCE;
        let mut machine = SimulatedMachine::told(stage, SettingsFlash::in_memory(), Told::Machine);
        machine.ask("CCL 1 ADVANCED").expect("it is taken");
        for line in ["SPA 1 0x16000201 2100 1 0x54500900 17", "DRC 2 Y 1"] {
            machine.ask(line).expect("it is taken");
        }
        let recorder = |machine: &mut SimulatedMachine| {
            ["SPA? 1 0x16000201", "SPA? 1 0x54500900", "DRC?"]
                .map(|question| machine.ask(question).expect("it answers"))
        };
        let before = recorder(&mut machine);
        let ran = run(&mut machine, &chosen, &mut |_| ()).expect("it answers");
        let done = ran.done.last().expect("a step");
        assert_eq!((done.step.name, &done.failure), (last, &None));
        assert_eq!(recorder(&mut machine), before);
        if chosen.keeps() {
            machine.ask("RPA").expect("it is taken");
            assert_eq!(recorder(&mut machine), before);
        }
    }
}

/// The settling window, encoder counts, that verification leaves a machine whose servos have this integral gain; as told, where it is none.
fn window_left(integral: Option<f64>) -> Result<f64, String> {
    let stage = StageParameters::REFERENCE;
    let mut machine = SimulatedMachine::told(&stage, SettingsFlash::in_memory(), Told::Machine);
    machine.ask("CCL 1 ADVANCED").expect("it is taken");
    if let Some(integral) = integral {
        let line = format!("SPA 1 0x54500302 {integral} 1 0x54500400 100");
        machine.ask(&line).expect("it is taken");
    }
    let chosen = Chosen::only("verification").expect("a step");
    let ran = run(&mut machine, &chosen, &mut |_| ()).expect("it answers");
    let findings = &ran.done[0].found.findings;
    let widened = |finding: &&Finding| finding.name.contains("window is widened");
    let widened = findings.iter().filter(widened).count() as i32;
    if let Some(failure) = &ran.done[0].failure {
        return Err(failure.what.clone());
    }
    let answer = machine.ask("SPA? 1 0x54500400").expect("it answers");
    let text = answer.expect("a value");
    let window = text.rsplit('=').next().and_then(|text| text.parse().ok());
    // Each time that it is widened is told.
    assert_eq!(window, Some(2.0 * 2.0_f64.powi(widened)));
    Ok(window.expect("a number"))
}

#[test]
fn a_stage_that_friction_holds_off_gets_a_wider_settling_window_and_not_any() {
    assert_eq!(window_left(None), Ok(2.0));
    assert_eq!(window_left(Some(200.0)), Ok(4.0));
    let refused = window_left(Some(0.0)).expect_err("further off than any window");
    assert!(refused.contains("has not come to its end"), "{refused}");
}

/// The worst of what gains that are in force make of the plants that were measured with them, beside the loops as measured, and a tenth more.
const MOST_MS_OFF: f64 = 0.096;

#[test]
fn loops_are_measured_with_the_gains_in_force_and_others_are_judged_before_they_are() {
    let options = RunOptions::reference();
    let stage = stage_parameters(&options);
    let mut machine = SimulatedMachine::told(&stage, SettingsFlash::in_memory(), options.told);
    let gain =
        |machine: &mut SimulatedMachine| machine.ask("SPA? 1 0x54500311").expect("it answers");
    machine.ask("CCL 1 ADVANCED").expect("it is taken");
    let kept = gain(&mut machine);
    // In force and not kept: that is what is measured, and what is there afterwards.
    machine.ask("SPA 1 0x54500311 25").expect("it is taken");
    let ran = run(&mut machine, &Chosen::response(), &mut |_| ()).expect("it answers");
    for done in &ran.done {
        assert_eq!(done.failure, None);
    }
    assert_eq!(gain(&mut machine), Some("1 0x54500311=25".to_owned()));
    assert_ne!(kept, gain(&mut machine));
    let tunable = ran.tunable.expect("loops");
    let in_force = tunable.numbers();
    assert!((in_force[0][1] - 25.0).abs() < 1e-9);
    let same = tunable.predict(&in_force).expect("gains");
    assert!(same.is_stable);
    for (predicted, measured) in same.loops.iter().zip(tunable.measured()) {
        let off = predicted.ms / measured.ms - 1.0;
        println!("{}: Ms {:.3}, off {off:.3}", measured.place, measured.ms);
        assert!(off.abs() < MOST_MS_OFF);
    }
    // Slower ones reject less; ten times as fast ones are not put in force, and none is no number.
    let scaled = |by: f64| {
        in_force.map(|mut all| {
            // Velocity and integral gain: the whole loop.
            all[1] *= by;
            all[2] *= by;
            all
        })
    };
    let slower = tunable.predict(&scaled(0.7)).expect("gains");
    for (slower, measured) in slower.loops.iter().zip(tunable.measured()) {
        assert!(
            slower.rejection > 1.2 * measured.rejection,
            "{slower:?}, {measured:?}"
        );
    }
    let wild = scaled(10.0);
    assert!(!tunable.predict(&wild).expect("gains").is_stable);
    let refused = tunable.put_in_force(&mut machine, &wild).err();
    assert!(matches!(
        refused,
        Some(PutError::Gains(GainsError::Unstable))
    ));
    assert_eq!(tunable.predict(&scaled(f64::NAN)), Err(GainsError::NoGain));
    assert_eq!(gain(&mut machine), Some("1 0x54500311=25".to_owned()));
    tunable
        .put_in_force(&mut machine, &scaled(0.9))
        .expect("it is taken");
    assert_eq!(gain(&mut machine), Some("1 0x54500311=22.5".to_owned()));
}

#[test]
fn ends_that_are_not_where_they_are_drawn_are_refused_and_nothing_is_changed() {
    let mut machine = unknown(1);
    // Something in the way at the inner ends.
    machine.plant.guide_range_m[0] += 10e-3;
    let flash = SettingsFlash::in_memory();
    let mut stage = SimulatedMachine::told(&machine, flash, Told::Everything);
    // What is in force again after a failure is what is kept.
    let kept = stage.ask("WPA 100");
    assert!(kept.is_ok(), "{kept:?}");
    let before = stage.parameters().clone();
    let chosen = Chosen::only("ends").expect("a step");
    let ran = run(&mut stage, &chosen, &mut |_| ()).unwrap_or_else(|error| panic!("{error}"));
    let failure = ran.done[0].failure.as_ref().expect("refused");
    println!("{}: {}", failure.what, failure.advice);
    assert!(failure.what.contains("ends are off"), "{}", failure.what);
    assert_eq!(*stage.parameters(), before);
}

/// In the middle, and 0.7 of the track's radius out, 30 degrees beside the guides.
const BESIDE: [[f64; 2]; 4] = [[0.0, 0.0], [0.7, 0.0], [-0.35, 0.6], [-0.35, -0.6]];

/// Ms of gains on the true machine with so many kg more on its platform, its windings cold, and as warm as at work.
fn ms_with_more(
    (stage, more_kg): (&StageParameters, f64),
    places: &[[f64; 2]],
    parameters: &Parameters,
) -> [f64; 2] {
    let (chain, electrical) = loop_model(stage);
    let heavier = chain.carrying(more_kg, stage.plant.track_radius_m);
    let at_work = electrical.each_ref().map(Electrical::at_work);
    [electrical, at_work].map(|electrical| {
        let at = |chain| Plant::at_places(&electrical, chain, places, &Timing::STAGE);
        let plants: Vec<_> = (at(&heavier).into_iter().zip(&at(&chain)))
            .map(|(heavier, known)| heavier.scheduled_by(known))
            .collect();
        let worst = Gains::of(parameters).at_worst(&plants);
        worst.expect("a plant").ms
    })
}

#[test]
fn gains_and_limits_are_for_what_the_platform_also_carries() {
    const MORE_KG: f64 = 5.0;
    // 2.00 and a little: 2 is aimed at there as well.
    const MOST_MS_AT_RIM: f64 = 2.02;
    let mut stage = StageParameters::REFERENCE;
    stage.plant.imperfections = Imperfections::ALL;
    let flash = SettingsFlash::in_memory();
    let mut machine = SimulatedMachine::told(&stage, flash, Told::Machine);
    let before = machine.parameters().clone();
    let for_one = Told::Reference.parameters(&before, &stage);
    let for_both = Chosen::tune().also_carrying(MORE_KG).expect("a weight");
    let ran = run(&mut machine, &for_both, &mut |_| ()).expect("it answers");
    for done in &ran.done {
        assert_eq!(done.failure, None);
    }
    let told = |name: &str| {
        let findings = ran.done.iter().flat_map(|done| &done.found.findings);
        findings
            .filter(|finding| finding.name.contains(name))
            .count()
    };
    assert_eq!(told("Ms with what it also carries"), 1);
    assert_eq!(told("with this load and 5 kg more"), 2);
    let for_both = machine.parameters();
    let heavier = (&stage, MORE_KG);
    let [one, both] = [&for_one, for_both].map(|all| ms_with_more(heavier, &BESIDE, all));
    let at_rim = ms_with_more(heavier, &PLACES, for_both);
    let accelerations = [&before, for_both].map(|all| all.limits.pivot_acceleration_rad_s2);
    println!(
        "Ms with {MORE_KG} kg more {one:.2?}, with gains for both {both:.2?}, at the rim {at_rim:.2?}; {accelerations:.0?}"
    );
    assert!(one[0] > MOST_MS && both.iter().all(|ms| *ms < MOST_MS));
    assert!(at_rim.iter().all(|ms| *ms < MOST_MS_AT_RIM));
    assert!(accelerations[1] < 0.53 * accelerations[0]);
    for weight in [-1.0, 21.0, f64::NAN] {
        let refused = Chosen::tune().also_carrying(weight).err();
        assert!(matches!(refused, Some(ChoiceError::Weight)));
    }
}

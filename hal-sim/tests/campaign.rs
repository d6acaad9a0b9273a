//! The campaign of faults: it finds nothing wrong with the controller, and would if there were.

use firmware::fault::FaultKind;
use firmware::parameters::Parameters;
use hal_sim::campaign::{
    Campaign, Commissioned, CommissionedError, End, Injection, Known, MARGIN, Measure, NAMES,
    Outcome, Problem, SETTINGS, Scenario, ToRest, both, replay, run, table,
};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::machine::unknown;
use hal_sim::rig::Told;

const SHORT: Campaign<'_> = Campaign {
    runs: 12,
    seed: 9,
    jobs: 2,
    machines: &[],
};

/// The first run of the campaign's kind in which this breaks and is noticed.
fn noticed(of: fn(&Injection) -> bool) -> Outcome {
    (1..)
        .map(Scenario::new)
        .filter(|scenario| of(&scenario.injection))
        .map(|scenario| run(scenario, false))
        .find(|outcome| outcome.effect.is_some())
        .expect("one of so many")
}

#[test]
fn the_same_seed_gives_the_same_campaign_whatever_the_threads() {
    let outcomes = SHORT.run(|_| true);
    let alone = Campaign { jobs: 1, ..SHORT }.run(|_| true);
    assert_eq!(format!("{outcomes:?}"), format!("{alone:?}"));
    assert_eq!(outcomes.len(), 24);
    for outcome in &outcomes {
        assert_eq!(outcome.problem(), None, "{outcome}");
    }
    let table = table(&outcomes);
    for name in NAMES {
        assert!(table.contains(name), "{name}:\n{table}");
    }
}

#[test]
fn on_commissioned_machines_it_has_them_and_what_their_controllers_keep() {
    let mut parameters = Told::Machine.parameters(&Parameters::REFERENCE, &unknown(7));
    parameters.servo.gains[1].velocity_v_s_rad = 12.5;
    let machines = [Commissioned {
        machine: 7,
        parameters: parameters.clone(),
    }];
    for seed in 0..20 {
        let scenario = Scenario::on(seed, &machines);
        let plant = &scenario.stage.plant;
        assert_eq!(plant.platform_mass_kg, unknown(7).plant.platform_mass_kg);
        assert_eq!(scenario.parameters.servo, parameters.servo);
        assert_ne!(Scenario::new(seed).parameters.servo, parameters.servo);
    }
}

#[test]
fn a_folder_without_commissioned_machines_is_refused() {
    let folder = std::env::temp_dir().join(format!("campaign-machines-{}", std::process::id()));
    let of_machine = folder.join("3");
    std::fs::create_dir_all(&of_machine).expect("a folder");
    let found = Commissioned::all_of(&folder);
    assert!(
        matches!(found, Err(CommissionedError::NoMachine(_))),
        "{found:?}"
    );
    drop(SettingsFlash::open(&of_machine.join(SETTINGS)).expect("an erased flash"));
    let found = Commissioned::all_of(&folder);
    assert!(
        matches!(found, Err(CommissionedError::NotCommissioned(_))),
        "{found:?}"
    );
    std::fs::remove_dir_all(&folder).expect("it is there");
    let found = Commissioned::all_of(&folder);
    assert!(
        matches!(found, Err(CommissionedError::Folder { .. })),
        "{found:?}"
    );
}

#[test]
fn every_kind_of_injection_comes_up() {
    let mut seen = [false; NAMES.len()];
    for seed in 0..400 {
        seen[Scenario::new(seed).injection.index()] = true;
    }
    assert_eq!(seen, [true; NAMES.len()]);
}

#[test]
fn a_fault_that_is_not_reported_rightly_is_a_problem() {
    let good = noticed(|injection| *injection == Injection::BadCrc);
    assert_eq!(good.problem(), None, "{good}");
    let latched = good.fault.expect("noticed");
    let judged = |fault| {
        let outcome = Outcome {
            fault,
            ..good.clone()
        };
        outcome.problem()
    };
    assert_eq!(judged(None), Some(Problem::Undetected));
    let late = firmware::fault::Fault {
        tick: latched.tick + 3,
        ..latched
    };
    assert_eq!(judged(Some(late)), Some(Problem::Late(3)));
    let kind = FaultKind::SupplyLow;
    let wrong = firmware::fault::Fault { kind, ..latched };
    assert_eq!(judged(Some(wrong)), Some(Problem::WrongKind));
    let pivot = Some((good.scenario.axis as u8 + 1) % 3);
    let elsewhere = firmware::fault::Fault { pivot, ..latched };
    assert_eq!(judged(Some(elsewhere)), Some(Problem::WrongPivot));
    let early = firmware::fault::Fault {
        tick: good.scenario.at - 1,
        ..latched
    };
    assert_eq!(judged(Some(early)), Some(Problem::FalseAlarm));
}

#[test]
fn an_event_is_no_answer_where_a_fault_is_due_and_an_alarm_where_nothing_is_wrong() {
    let loose = (1..)
        .map(Scenario::new)
        .find(|scenario| matches!(scenario.injection, Injection::LooseCoupling(_)))
        .expect("one of so many");
    let sound = run(loose, true);
    assert_eq!(sound.problem(), None, "{sound}");
    let told = Some(sound.scenario.at + 1);
    let alarm = Outcome {
        told,
        ..sound.clone()
    };
    assert_eq!(alarm.problem(), Some(Problem::FalseAlarm));
    let knocks = Outcome {
        is_control: false,
        ..alarm
    };
    assert_eq!(knocks.problem(), None);
    let due = Outcome {
        deadline: Some(sound.scenario.at + 10),
        ..knocks
    };
    assert_eq!(due.problem(), Some(Problem::Undetected));
}

#[test]
fn a_fault_that_comes_before_its_reason_is_a_problem() {
    let good = noticed(|injection| *injection == Injection::Jam);
    assert!(good.is_founded, "{good}");
    let unfounded = Outcome {
        is_founded: false,
        ..good
    };
    assert_eq!(unfounded.problem(), Some(Problem::Unfounded));
}

#[test]
fn a_second_encoder_that_is_not_told_is_a_problem() {
    // At rest the first one brakes at once, and there is no stop that a second one could end.
    let good = (1..)
        .map(Scenario::new)
        .filter(|scenario| matches!(scenario.injection, Injection::TwoEncoders(_)))
        .map(|scenario| run(scenario, false))
        .find(|outcome| outcome.second.is_some())
        .expect("one of so many");
    assert!(good.second.is_some() && good.worse.is_some(), "{good}");
    assert_eq!(good.problem(), None, "{good}");
    let untold = Outcome {
        worse: None,
        ..good
    };
    assert_eq!(untold.problem(), Some(Problem::SecondMissed));
}

#[test]
fn what_is_told_as_an_event_or_an_error_has_to_be_told() {
    for of in [
        |injection: &Injection| *injection == Injection::HostSilent,
        |injection: &Injection| *injection == Injection::LoopStands,
        |injection: &Injection| *injection == Injection::QueueFull,
    ] {
        let good = noticed(of);
        assert_eq!(good.problem(), None, "{good}");
        let untold = Outcome { told: None, ..good };
        assert_eq!(untold.problem(), Some(Problem::Undetected), "{untold}");
    }
}

#[test]
fn an_alarm_without_a_fault_is_a_problem() {
    let fault = noticed(|injection| *injection == Injection::EmergencyStop).fault;
    for control in [true, false] {
        let scenario = (1..)
            .map(Scenario::new)
            .find(|scenario| scenario.injection.expected().causes.is_empty())
            .expect("one of so many");
        let quiet = run(scenario, control);
        assert_eq!((quiet.fault, quiet.problem()), (None, None));
        let alarmed = Outcome { fault, ..quiet };
        assert_eq!(alarmed.problem(), Some(Problem::FalseAlarm));
    }
}

/// Each measure is held to its own bound: just inside the margin it passes, just outside it is told.
#[test]
fn what_goes_beyond_its_bound_is_a_problem() {
    let good = noticed(|injection| *injection == Injection::EmergencyStop);
    let bound = ToRest {
        way_mm: 10.0,
        turn_deg: 10.0,
        depth_mm: 10.0,
        blow_j: 10.0,
        deviation_mm: 10.0,
        rests: true,
    };
    let judged = |share: f64, measure: Measure| {
        let mut reaction = ToRest {
            rests: true,
            ..ToRest::default()
        };
        *match measure {
            Measure::Way => &mut reaction.way_mm,
            Measure::Turn => &mut reaction.turn_deg,
            Measure::Deviation => &mut reaction.deviation_mm,
            Measure::Depth => &mut reaction.depth_mm,
            Measure::Blow => &mut reaction.blow_j,
        } = 10.0 * share;
        let outcome = Outcome {
            reaction,
            bound: Some(bound),
            ..good.clone()
        };
        outcome.problem()
    };
    for measure in Measure::ALL {
        assert_eq!(judged(MARGIN, measure), None);
        let broken = judged(MARGIN + 0.02, measure);
        assert!(
            matches!(broken, Some(Problem::Beyond(of, ..)) if of == measure),
            "{broken:?}"
        );
    }
}

#[test]
fn a_stage_that_could_rest_has_to() {
    let good = noticed(|injection| *injection == Injection::EmergencyStop);
    assert!(good.bound.is_some_and(|bound| bound.rests), "{good}");
    let moving = Outcome {
        end: End::Moving,
        ..good
    };
    assert_eq!(moving.problem(), Some(Problem::StillMoving));
}

/// A loop that stands still is cut by the watchdog alone, within its time; nothing in the run does it.
#[test]
fn the_watchdog_has_to_cut_in_time() {
    let good = noticed(|injection| *injection == Injection::LoopStands);
    let cut = good.cut.expect("the watchdog bites");
    // 0.39 to 0.49 ms after the last tick, which was the one before, and seen in the tick behind it.
    assert!((7..=10).contains(&(cut - good.scenario.at)), "{good}");
    let late = Outcome {
        cut: Some(good.scenario.at + 13),
        ..good.clone()
    };
    assert_eq!(late.problem(), Some(Problem::CutLate(3)));
    let never = Outcome { cut: None, ..good };
    assert!(matches!(never.problem(), Some(Problem::CutLate(_))));
}

/// Nothing tells an encoder that drifts slowly; frames that fail are seen.
#[test]
fn what_nobody_could_detect_is_told_from_what_nobody_has() {
    let undetected = |of: fn(&Injection) -> bool| {
        (1..)
            .filter(|seed| of(&Scenario::new(*seed).injection))
            .map(|seed| replay(seed, &[])[0].clone())
            .find(|outcome| outcome.detected().is_none())
            .expect("one of so many")
    };
    let frames = undetected(|injection| matches!(injection, Injection::FewBadFrames(_)));
    let differs = frames.differs.expect("it is told");
    // No day makes a line fail, and no push.
    assert_eq!(differs.known(), Known::Beyond, "{frames}: {differs:?}");
    let drift = undetected(
        |injection| matches!(injection, Injection::Drift(rad_s) if rad_s.abs() < 0.5e-3),
    );
    let differs = drift.differs.expect("it is told");
    assert_ne!(differs.known(), Known::Beyond, "{drift}: {differs:?}");
}

/// What pushes a ring is told as a push, by its size; a motor that has lost a third of its torque, or a sensor that reads an ampere too much, is none
/// once it turns.
#[test]
fn a_push_is_told_from_a_drive_that_is_not_sound() {
    const PUSH_N_M: f64 = 3.0;
    let with = |of: fn(&Injection) -> bool| {
        (1..)
            .map(Scenario::new)
            .filter(move |scenario| of(&scenario.injection))
            .take(4)
    };
    let known = |scenarios: &mut dyn Iterator<Item = Scenario>| -> Vec<_> {
        scenarios
            .filter_map(|scenario| both(scenario)[0].differs)
            .collect()
    };
    let mut knocks = with(|injection| matches!(injection, Injection::Knock(_))).map(|scenario| {
        let expected_n = PUSH_N_M / scenario.stage.plant.track_radius_m;
        let injection = Injection::Knock(PUSH_N_M);
        let [outcome, _] = both(Scenario {
            injection,
            ..scenario
        });
        let differs = outcome.differs.expect("it is told");
        // What of it moves the platform is not counted.
        let share = differs.push_n / expected_n;
        assert!((0.5..1.1).contains(&share), "{outcome}: {differs:?}");
        differs
    });
    let pushes: Vec<_> = knocks.by_ref().collect();
    // A blow rings in the transmission: that is a little beyond noise in some.
    let within = pushes
        .iter()
        .filter(|push| push.known() == Known::WithinPush);
    assert!(within.count() >= 3, "{pushes:?}");
    assert!(pushes.iter().all(|push| push.than_push < 1.2), "{pushes:?}");
    for (of, broken) in [
        (
            (|injection| matches!(injection, Injection::Fading(_))) as fn(&Injection) -> bool,
            Injection::Fading(0.33),
        ),
        (
            |injection| matches!(injection, Injection::CurrentBias(_)),
            Injection::CurrentBias(1.0),
        ),
    ] {
        let mut scenarios = with(of).map(|scenario| Scenario {
            injection: broken,
            ..scenario
        });
        // Where it is more than another day: the others rest.
        let mut more = known(&mut scenarios);
        more.retain(|differs| differs.than_another_day > 1.0);
        let beyond = (more.iter()).filter(|differs| differs.known() == Known::Beyond);
        assert!(2 * beyond.count() > more.len(), "{broken:?}: {more:?}");
    }
}

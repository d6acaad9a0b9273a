//! The image on the emulated chip. Needs `cargo stage` first, then
//! `cargo chip-test --test chip`.

use firmware::mode::Mode;
use firmware::parameters::Parameters;
use hal_sim::machine::devices::{BridgeState, EncoderFault, Stage, StageParameters};
use image::chip::{Action, Bench, Outcome, Period, ResetCause, Twin, elf_file};
use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::mpsc;

const BRIDGES_ASLEEP: [BridgeState; 3] = [BridgeState::RESET; 3];
/// Numbers of the image's reset causes.
const POWER_ON: u32 = 1;
const WATCHDOG: u32 = 5;

fn stage() -> Stage {
    Stage::new(&StageParameters::REFERENCE)
}

fn run<F>(stage: Stage, on_period: F) -> Outcome
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send + 'static,
{
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let outcome = bench.run(on_period).expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    outcome
}

/// Whether no bridge is driven: asleep, or without a pulse.
fn quiet(pins: &[BridgeState; 3]) -> bool {
    pins.iter()
        .all(|bridge| !bridge.awake || bridge.pulse == 0.0)
}

#[test]
fn chip_and_host_agree_to_the_bit_through_a_move() {
    let mut twin = Twin::new(&Parameters::REFERENCE);
    let (send, receive) = mpsc::channel();
    let outcome = run(stage(), move |period| {
        let script: &[u8] = match period.tick {
            20 => b"FRF X\n",
            100 => b"MOV X 20 Y -30 W 90\n",
            _ => b"",
        };
        twin.look(period)
            .unwrap_or_else(|divergence| panic!("{divergence}"));
        let mut mode = None;
        while let Some(agreed) = twin
            .catch_up()
            .unwrap_or_else(|divergence| panic!("{divergence}"))
        {
            mode = agreed.record.sample.as_ref().map(|sample| sample.mode);
        }
        twin.receive(script);
        period.send(script);
        if period.tick < 20_000 {
            return Continue(());
        }
        send.send((mode, period.trace(), period.stage.plant.pose()))
            .expect("the test waits");
        Break(())
    });
    let (mode, trace, pose) = receive.recv().expect("the last period");
    assert_eq!(mode, Some(Mode::Holding));
    assert_eq!((trace.commands, trace.reset_cause), (2, POWER_ON));
    assert!(
        (pose[0] - 0.02).abs() < 1e-6 && (pose[1] + 0.03).abs() < 1e-6,
        "{pose:?}"
    );
    assert!(outcome.cost.latest_end_ns < 25_000, "{:?}", outcome.cost);
    println!("{:?}, mean {:.1}", outcome.cost, outcome.cost.mean());
}

#[test]
fn the_emergency_stop_cuts_the_pwm_in_the_same_period_and_its_twin_drives_on() {
    for pressed in [true, false] {
        let (send, receive) = mpsc::channel();
        run(stage(), move |period| {
            match period.tick {
                20 => period.send(b"FRF X\n"),
                100 => period.send(b"MOV X 60\n"),
                1_000 => {
                    // 30 us into the period: after the control task, in the PWM period in which its duty acts.
                    let at = period.tick_at_ns() + 30_000;
                    period.at(at - 1_000, Action::Probe);
                    if pressed {
                        period.at(at, Action::EmergencyStop(true));
                    }
                    period.at(at + 100, Action::Probe);
                }
                1_100 => period.send(b"ERR?\n"),
                1_200 => {
                    let answer = String::from_utf8_lossy(&period.received()).into_owned();
                    send.send((period.probes.to_vec(), answer, period.pins))
                        .expect("the test waits");
                    return Break(());
                }
                _ => {}
            }
            Continue(())
        });
        let (probes, answer, pins) = receive.recv().expect("the last period");
        assert!(!quiet(&probes[0].1), "it drove before: {:?}", probes[0]);
        assert_eq!(quiet(&probes[1].1), pressed, "{:?}", probes[1]);
        assert_eq!(quiet(&pins), pressed, "{pins:?}");
        assert_eq!(answer, if pressed { "1024\n" } else { "0\n" });
    }
}

#[test]
fn silent_encoders_leave_the_bridges_asleep_and_the_reference_refused() {
    let mut stage = stage();
    for encoder in &mut stage.encoders {
        encoder.set_fault(EncoderFault::StuckHigh);
    }
    stage.set_pose_at_rest([0.0; 3]);
    let (send, receive) = mpsc::channel();
    run(stage, move |period| {
        assert!(quiet(&period.pins));
        match period.tick {
            100 => period.send(b"FRF X\nERR?\nSVO X 1\nERR?\nFLT?\n"),
            2_000 => {
                send.send((period.received(), period.pins))
                    .expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        Continue(())
    });
    let (answers, pins) = receive.recv().expect("the last period");
    let answers = String::from_utf8_lossy(&answers).into_owned();
    assert!(answers.starts_with("45\n"), "{answers:?}");
    let says_so = answers.contains("encoder does not answer, pivot 1");
    assert!(says_so, "{answers:?}");
    assert_eq!(pins, BRIDGES_ASLEEP);
}

#[test]
fn a_halted_loop_is_reset_by_the_watchdog_which_the_image_tells() {
    let (send, receive) = mpsc::channel();
    let outcome = run(stage(), move |period| {
        match (period.resets.len(), period.tick) {
            (0, 20) => period.send(b"FRF X\n"),
            (0, 500) => {
                let at = period.tick_at_ns();
                period.at(at, Action::HaltLoop);
            }
            (1, 100) => period.send(b"FLT?\n"),
            (1, 200) => {
                let answer = String::from_utf8_lossy(&period.received()).into_owned();
                send.send((period.trace(), period.pins, answer))
                    .expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        Continue(())
    });
    let (trace, pins, answer) = receive.recv().expect("the last period");
    assert_eq!(trace.reset_cause, WATCHDOG);
    assert_eq!(
        answer,
        "0 no fault, started by the watchdog: the control loop or the command side stood still\n"
    );
    assert_eq!(pins, BRIDGES_ASLEEP);
    assert_eq!(outcome.resets.len(), 1);
    assert_eq!(outcome.resets[0].cause, ResetCause::Model("IWDG"));
}

#[test]
fn a_restart_by_command_is_told_as_one_and_the_loop_counts_its_cost() {
    const COMMAND: u32 = 7;
    let (send, receive) = mpsc::channel();
    let mut answers = Vec::new();
    let mut before = String::new();
    let outcome = run(stage(), move |period| {
        answers.extend(period.received());
        if period.resets.is_empty() {
            match period.tick {
                20 => period.send(b"FRF X\n"),
                400 => period.send(b"LST?\n"),
                800 => {
                    before = String::from_utf8_lossy(&std::mem::take(&mut answers)).into_owned();
                    period.send(b"RBT\n");
                }
                2_000 => panic!("no restart"),
                _ => {}
            }
        } else if period.tick == 100 {
            answers.clear();
            period.send(b"FLT?\nFRF? X\n");
        } else if period.tick == 400 {
            let after = String::from_utf8_lossy(&answers).into_owned();
            send.send((before.clone(), after, period.trace().reset_cause))
                .expect("the test waits");
            return Break(());
        }
        Continue(())
    });
    let (before, after, cause) = receive.recv().expect("the last period");
    assert_eq!(cause, COMMAND);
    assert_eq!(after, "0 no fault\nX=0\n");
    let told = |name: &str| -> f64 {
        let line = before.lines().find_map(|line| line.strip_prefix(name));
        let value = line.unwrap_or_else(|| panic!("{name} in {before:?}"));
        value.trim().parse().expect("a number")
    };
    // The bench counts from the interrupt's first instruction, the chip between two readings inside it.
    let (worst, mean) = (told("CYCLES_WORST="), told("CYCLES_MEAN="));
    let most = outcome.cost.worst as f64;
    assert!(0.7 * most < worst && worst <= most, "{worst} of {most}");
    assert!(0.5 * worst < mean && mean <= worst, "{mean} of {worst}");
    assert_eq!(told("LATE="), 0.0);
}

/// The duties of a tick act 32 us after it, 47 us after the latch that they come of, and not before.
#[test]
fn duties_act_32_us_after_their_tick() {
    const ACT_NS: u64 = 32_000;
    const BESIDE_NS: u64 = 200;
    let (send, receive) = mpsc::channel();
    let mut before = [0.0; 3];
    let mut changes = 0;
    run(stage(), move |period| {
        let pulses = |pins: &[BridgeState; 3]| pins.map(|bridge| bridge.pulse);
        let now = pulses(&period.pins);
        if let [.., (_, early), (_, late)] = period.probes {
            assert_eq!((pulses(early), pulses(late)), (before, now));
            changes += u32::from(before != now);
        }
        before = now;
        match period.tick {
            20 => period.send(b"FRF X\n"),
            100 => period.send(b"MOV X 20 Y -30 W 90\n"),
            1_000 => {
                send.send(changes).expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        if period.tick >= 600 {
            let acts_at = period.tick_at_ns() + ACT_NS;
            period.at(acts_at - BESIDE_NS, Action::Probe);
            period.at(acts_at + BESIDE_NS, Action::Probe);
        }
        Continue(())
    });
    let changes = receive.recv().expect("the last period");
    assert!(changes > 300, "{changes}");
}

#[test]
fn a_tick_is_followed_from_its_begin_to_its_end() {
    let image = elf_file::find().expect("`cargo stage` builds it");
    let (_, steps) = image::chip::follow(600).expect("as many instructions as were counted");
    let first = steps.first().expect("some").at;
    let code = image::proof::Code::read(&image).expect("understood");
    assert_eq!(code.named("TIM1_CC"), Some(first));
}

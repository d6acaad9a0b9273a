//! The controller's own words: events, statistics of the loop, heartbeat, restart, and which axes have moved.

mod gcs_bench;

use firmware::fault::FaultKind;
use firmware::gcs::{Identity, Interpreter};
use firmware::parameters::Parameters;
use gcs_bench::Bench;

/// What `EVT?` tells, without the ticks.
fn events(bench: &mut Bench) -> Vec<String> {
    let answer = bench.say("EVT?\n");
    let without_tick = |line: &str| {
        let mut words = line.trim().splitn(3, ' ');
        let (number, _, what) = (
            words.next().unwrap(),
            words.next().unwrap(),
            words.next().unwrap(),
        );
        format!("{number} {what}")
    };
    answer.lines().map(without_tick).collect()
}

#[test]
fn events_are_told_in_order_with_their_ticks() {
    let mut bench = Bench::new();
    assert_eq!(events(&mut bench), ["1 start"]);
    bench.say("FRF\n");
    bench.run(100);
    bench.say("SPA 1 0x54500100 150 1 0x54500702 0.1\n");
    bench.say("SPA 1 0x54500100 1e9\n");
    bench.say("MOV X 10\n");
    bench.say("HLT X\n");
    bench.say("STP\n");
    bench.run_to_rest();
    bench.tick.fail(FaultKind::FollowingError, Some(1));
    let tick = bench.tick.now.tick;
    bench.run(1);
    bench.say("FLC\n");
    bench.say("FRF\n");
    bench.say("SVO X 0\n");
    assert_eq!(
        events(&mut bench)[1..],
        [
            "2 referenced",
            "3 servo on",
            "4 parameter 0x54500100 set to 150",
            "5 parameter 0x54500702 set to 0.1",
            "6 halted by command",
            "7 stopped by command",
            &*format!(
                "8 fault: following error too large, pivot 2: 3e-3 rad, limit 2e-3 rad, at tick {tick}"
            ),
            "9 fault acknowledged",
            "10 servo on",
            "11 servo off",
        ]
    );
    assert!(bench.say("EVT?\n").contains(&format!("8 {tick} fault")));
}

#[test]
fn the_oldest_event_goes_and_the_numbers_tell_it() {
    let mut bench = Bench::new();
    for _ in 0..50 {
        bench.say("STP\nHLT\n");
    }
    let events = events(&mut bench);
    assert_eq!(events.len(), 64);
    assert_eq!(
        (&*events[0], &*events[63]),
        ("38 stopped by command", "101 halted by command")
    );
}

#[test]
fn stops_do_not_wash_a_fault_out_of_the_events() {
    let mut bench = Bench::ready();
    bench.tick.fail(FaultKind::FollowingError, Some(1));
    bench.run(1);
    let fault = "4 fault: following error too large, pivot 2: 3e-3 rad, limit 2e-3 rad, at tick";
    // Of repeats at rest one is kept.
    bench.say(&"\x18".repeat(300));
    let told = events(&mut bench);
    assert_eq!(told.len(), 5, "{told:?}");
    assert!(told[3].starts_with(fault), "{told:?}");
    // Whatever else happens: faults have places of their own.
    for _ in 0..100 {
        bench.say("STP\nHLT\n");
    }
    let told = events(&mut bench);
    assert_eq!(told.len(), 65, "{told:?}");
    assert!(told[0].starts_with(fault), "{told:?}");
    assert_eq!(told[64], "204 halted by command");
}

#[test]
fn a_start_with_a_cause_is_told_with_it() {
    let identity = Identity {
        serial: "1",
        version: "1",
    };
    let mut panel = Interpreter::new(&Parameters::REFERENCE, identity);
    panel.set_start_cause("the watchdog");
    let mut bench = Bench::with(panel);
    assert_eq!(events(&mut bench), ["1 start by the watchdog"]);
}

#[test]
fn commands_that_the_loop_refuses_are_an_event() {
    let mut bench = Bench::ready();
    let count = events(&mut bench).len();
    bench.tick.now.refused += 2;
    bench.run(2);
    assert_eq!(
        events(&mut bench)[count..],
        [format!("{} 2 commands refused by the loop", count + 1)]
    );
}

fn statistic(bench: &mut Bench, name: &str) -> f64 {
    let answer = bench.say("LST?\n");
    let value = |line: &str| {
        line.trim()
            .strip_prefix(name)?
            .strip_prefix('=')?
            .parse()
            .ok()
    };
    answer
        .lines()
        .find_map(value)
        .unwrap_or_else(|| panic!("{name} in {answer:?}"))
}

#[test]
fn statistics_add_up_and_start_again() {
    let mut bench = Bench::ready();
    let tick = bench.tick.now.tick;
    bench.say("LST\n");
    for cycles in [100, 300, 200] {
        bench.tick.now.loop_counters.cycles = cycles;
        bench.tick.now.loop_counters.cycles_sum += cycles;
        bench.tick.now.loop_counters.cycles_worst = cycles;
        bench.tick.now.loop_counters.late = u32::from(cycles == 300);
        bench.tick.now.loop_counters.peak_error = cycles;
        bench.run(1);
    }
    let answer = bench.say("LST?\n");
    let rad = 300.0 * std::f64::consts::TAU / 4_294_967_296.0;
    // The answer was asked for before the three ticks that `say` runs.
    let ticks = bench.tick.now.tick - tick - 3;
    let (told, rest) = answer.split_once(" \n").unwrap();
    let told: u64 = told.strip_prefix("TICKS=").unwrap().parse().unwrap();
    assert!(told.abs_diff(ticks) <= 1, "{told} of {ticks}");
    let mean = 600.0 / told as f64;
    let servos: String = (1..=3)
        .map(|i| format!("LEARNT{i}=0.00000 0.00000 0.00000 0.00000 \nINTEGRAL{i}=0.0000 \nCURRENT{i}=0.0000 \n"))
        .collect();
    assert_eq!(
        rest,
        format!(
            "CYCLES_LAST=200 \nCYCLES_MEAN={mean:.1} \nCYCLES_WORST=300 \nLATE=1 \nPEAK_ERROR_RAD={rad:e} \nCOMMANDS=0 \nREFUSED=0 \n{servos}LOOSENED=0\n"
        )
    );
    // The peak since it was told; the rest since `LST`.
    assert_eq!(statistic(&mut bench, "PEAK_ERROR_RAD"), 0.0);
    assert_eq!(statistic(&mut bench, "CYCLES_WORST"), 300.0);
    bench.say("MOV X 1\n");
    assert_eq!(statistic(&mut bench, "COMMANDS"), 1.0);
    bench.say("LST\n");
    for name in ["CYCLES_WORST", "CYCLES_MEAN", "LATE", "COMMANDS"] {
        assert_eq!(statistic(&mut bench, name), 0.0, "{name}");
    }
    assert!(statistic(&mut bench, "TICKS") < 17.0);
}

#[test]
fn a_silent_host_stops_the_stage_and_one_that_is_heard_does_not() {
    for silent in [true, false] {
        let mut bench = Bench::ready();
        assert_eq!(bench.error_after("HBT 20"), "0");
        assert_eq!(bench.say("HBT?\n"), "20\n");
        let other = bench.connect();
        bench.say("MOV X 50 W 90\n");
        for _ in 0..60 {
            // A byte that asks for nothing is as good as a line; somebody else's lines are not.
            if !silent {
                bench.offer(0, b"\n");
            }
            bench.say_to(other, "POS?\n");
            bench.run(197);
        }
        assert!(bench.tick.now.settled);
        let told = events(&mut bench);
        assert_eq!(
            told.last()
                .unwrap()
                .ends_with("stopped: no host heard for 20 ms"),
            silent,
            "{told:?}"
        );
        assert_eq!(bench.value("MOV? X") < 50.0, silent);
        let error = if silent { "10\n" } else { "0\n" };
        assert_eq!(bench.say_to(other, "ERR?\n"), error);
        // What 14,400 deg/s^2 make of a tick.
        assert!(bench.tick.worst_jump < 0.0127, "{}", bench.tick.worst_jump);
    }
}

#[test]
fn a_silent_host_ends_waits_and_macros_and_is_told_once() {
    let mut bench = Bench::ready();
    bench.say("MAC BEG m\nDEL 10000\nMOV X 1\nMAC END\nMAC START m\n");
    bench.say("HBT 10\nDEL 5000\n");
    bench.run(5_000);
    assert_eq!(bench.say("\x08"), "0\n");
    assert_eq!(bench.say("ERR?\n"), "10\n");
    let silent = |bench: &mut Bench| {
        events(bench)
            .iter()
            .filter(|e| e.contains("no host"))
            .count()
    };
    assert_eq!(silent(&mut bench), 1);
    // Heard again, and gone again.
    bench.run(5_000);
    assert_eq!(silent(&mut bench), 2);
    assert_eq!(bench.error_after("HBT 0"), "10");
    bench.run(5_000);
    assert_eq!(silent(&mut bench), 2);
    for (line, error) in [
        ("HBT 9", "17"),
        ("HBT -1", "17"),
        ("HBT 1e9", "17"),
        ("HBT", "24"),
        ("HBT 10", "0"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
}

/// Whether a move goes on to its end while one connection sends something every 10 ms and another one nothing.
fn goes_on(bench: &mut Bench, heard: usize) -> bool {
    bench.say("ERR?\n");
    bench.say("MOV X 0\n");
    bench.run_to_rest();
    for number in 0..3 {
        bench.offer(number, b"\n");
    }
    bench.say("MOV X 30\n");
    for _ in 0..40 {
        bench.offer(heard, b"\n");
        bench.run(200);
    }
    bench.value("MOV? X") == 30.0
}

#[test]
fn who_has_promised_to_be_heard_has_to_be() {
    let mut bench = Bench::ready();
    let (other, third) = (bench.connect(), bench.connect());
    bench.say_to(other, "HBT 20\n");
    assert!(goes_on(&mut bench, other));
    assert!(!goes_on(&mut bench, third), "it has promised nothing");
    // Nobody stands for another one.
    bench.say_to(third, "HBT 20\n");
    assert!(!goes_on(&mut bench, third));
    assert!(!goes_on(&mut bench, other));
    bench.say_to(other, "HBT 0\n");
    assert!(!goes_on(&mut bench, other));
    assert!(goes_on(&mut bench, third));
}

#[test]
fn nobody_ends_the_heartbeat_of_another_connection() {
    for line in [
        "HBT 0\n",
        "HBT 86400000\n",
        "SPA 1 0x54500510 0\n",
        "RPA\n",
        "RBT\n",
    ] {
        let mut bench = Bench::ready();
        let other = bench.connect();
        bench.say("HBT 20\n");
        bench.say_to(other, line);
        let error = bench.say_to(other, "ERR?\n");
        assert!(line != "RBT\n" || error == "89\n", "{error}");
        bench.say("MOV X 50\n");
        for _ in 0..60 {
            bench.say_to(other, "POS?\n");
            bench.run(197);
        }
        assert!(bench.value("MOV? X") < 50.0, "{line}");
    }
}

#[test]
fn a_connection_that_has_promised_to_be_heard_and_ended_is_missed_once() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say_to(other, "HBT 20\n");
    bench.say("MOV X 50\n");
    bench.disconnect(other);
    bench.run_to_rest();
    assert!(bench.value("MOV? X") < 50.0);
    bench.say("ERR?\n");
    for target in [50, 0] {
        bench.say(&format!("MOV X {target}\n"));
        bench.run_to_rest();
        assert_eq!(bench.value("MOV? X"), f64::from(target));
    }
}

/// It has stopped the stage once, and whoever comes then is not stopped for the sake of the one who has gone.
#[test]
fn who_has_gone_does_not_stop_those_who_come_after() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say_to(other, "HBT 20\nMOV X 50\n");
    bench.run_to_rest();
    assert!(bench.value("MOV? X") < 50.0);
    bench.say("ERR?\nMOV X 50\n");
    bench.run_to_rest();
    assert_eq!(bench.value("MOV? X"), 50.0);
    // Back again, and gone again.
    bench.say_to(other, "\n");
    bench.say("MOV X 0\n");
    bench.run_to_rest();
    assert!(bench.value("MOV? X") > 0.0);
}

#[test]
fn a_heartbeat_that_no_connection_has_promised_is_anybodys() {
    for way in [
        "SPA 1 0x54500510 20\n",
        "MAC BEG m\nHBT 20\nMAC END\nMAC START m\n",
    ] {
        let mut bench = Bench::ready();
        let other = bench.connect();
        bench.connect();
        bench.say(way);
        bench.run(10);
        assert_eq!(bench.say("HBT?\n"), "20\n", "{way}");
        assert!(goes_on(&mut bench, other), "{way}");
        assert!(goes_on(&mut bench, 0), "{way}");
        bench.say("MOV X 0\n");
        bench.run(8_000);
        assert!(bench.value("MOV? X") > 0.0, "{way}");
    }
}

#[test]
fn a_restart_is_asked_for_only_at_rest() {
    let mut bench = Bench::ready();
    bench.say("MOV X 10\n");
    assert_eq!(bench.error_after("RBT"), "53");
    assert!(!bench.panel().wants_restart());
    bench.run_to_rest();
    assert_eq!(bench.error_after("RBT"), "0");
    assert!(bench.panel().wants_restart());
}

#[test]
fn axes_that_have_moved_since_their_position_was_asked_for() {
    let mut bench = Bench::ready();
    // Never asked: they may have.
    assert_eq!(bench.say("\x06"), "23\n");
    bench.say("POS?\n");
    assert_eq!(bench.say("\x06\x06"), "0\n0\n");
    bench.say("MOV X 1\n");
    bench.run_to_rest();
    assert_eq!(bench.say("\x06"), "1\n");
    bench.say("MOV Y 1 W 1\n");
    bench.run_to_rest();
    assert_eq!(bench.say("\x06"), "23\n");
    bench.say("\x03");
    assert_eq!(bench.say("\x06"), "0\n");
    // Each connection asks for itself.
    let other = bench.connect();
    assert_eq!(bench.say_to(other, "\x06"), "23\n");
}

#[test]
fn the_heartbeat_is_a_parameter_too() {
    let mut bench = Bench::ready();
    bench.say("SPA 1 0x54500510 40\n");
    assert_eq!(bench.say("HBT?\n"), "40\n");
    // What a connection promises is its own.
    bench.say("HBT 250\n");
    assert_eq!(
        bench.say("HBT?\nSPA? 1 0x54500510\n"),
        "250\n1 0x54500510=40\n"
    );
    bench.say("HBT 0\n");
    assert_eq!(
        bench.say("SPA 1 0x54500510 5\nERR?\n"),
        "17\n",
        "too short for any host"
    );
    assert_eq!(bench.say("HBT?\n"), "40\n");
}

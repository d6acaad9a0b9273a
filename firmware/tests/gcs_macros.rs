//! Macros and variables: recorded on one connection, run in the background, stopped from anywhere, bounded in
//! everything.

mod gcs_bench;

use firmware::fault::FaultKind;
use firmware::gcs::{
    LINES_PER_TICK, MACRO_BYTES, MAX_CALL_DEPTH, MAX_MACROS, MAX_VARIABLES, NAME_BYTES, TEXT_BYTES,
};
use gcs_bench::Bench;

/// Referenced, with these macros.
fn with(macros: &[(&str, &str)]) -> Bench {
    let mut bench = Bench::ready();
    for (name, text) in macros {
        record(&mut bench, name, text);
    }
    bench
}

fn record(bench: &mut Bench, name: &str, text: &str) {
    let lines: String = text
        .split(';')
        .map(|line| format!("{}\n", line.trim()))
        .collect();
    assert_eq!(
        bench.error_after(&format!("MAC BEG {name}\n{lines}MAC END")),
        "0",
        "{name}"
    );
}

/// Runs until no macro does.
fn finish(bench: &mut Bench) {
    for _ in 0..200_000 {
        if bench.say("\x08") == "0\n" {
            return;
        }
    }
    panic!("still running: {}", bench.say("RMC?\n"));
}

#[test]
fn recorded_lines_wait_and_then_run() {
    let mut bench = Bench::ready();
    assert_eq!(
        bench.say("MAC BEG there\nMOV X 5\nWAC ONT? X = 1\nMOV Y 3\nMAC END\nERR?\n"),
        "0\n"
    );
    assert!(bench.tick.log.is_empty());
    assert_eq!(
        bench.say("MAC?\nMAC? THERE\n"),
        "there\nMOV X 5 \nWAC ONT? X = 1 \nMOV Y 3\n"
    );
    assert_eq!(bench.say("\x08RMC?\nMAC ERR?\n"), "0\n\n\n");
    assert_eq!(bench.error_after("MAC START there"), "0");
    assert_eq!(bench.say("\x08RMC?\n"), "1\nthere\n");
    finish(&mut bench);
    assert_eq!(bench.say("MOV? X Y\nRMC?\nMAC ERR?\n"), "X=5 \nY=3\n\n\n");
    assert_eq!(bench.tick.log, ["move", "move"]);
}

#[test]
fn others_go_on_while_one_records() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("MAC BEG there\nMOV X 5\n");
    assert_eq!(
        bench.say_to(other, "MOV Y 1\nMOV? Y\nMAC BEG here\nERR?\n"),
        "Y=1\n1005\n"
    );
    // Queries are answered and are no part of it; single bytes act.
    assert_eq!(bench.say("MOV? X\n\x04ERR?\n"), "X=0\n65536\n0\n");
    assert_eq!(bench.say("MAC END\nMAC? there\n"), "MOV X 5\n");
    assert_eq!(bench.say_to(other, "MAC BEG here\nMAC END\nERR?\n"), "0\n");
    assert_eq!(bench.say("MAC?\nMAC? here\n"), "there \nhere\n\n");
}

#[test]
fn an_abandoned_recording_keeps_nobody_out_for_long() {
    let mut bench = Bench::ready();
    let other = bench.connect();
    bench.say("MAC BEG there\nMOV X 5\n");
    bench.run(199_900);
    assert_eq!(bench.say_to(other, "MAC BEG here\nERR?\n"), "1005\n");
    bench.run(200);
    assert_eq!(bench.say_to(other, "MAC BEG here\nMOV Y 2\nERR?\n"), "0\n");
    // Who had it is told, and its lines are not carried out.
    assert_eq!(
        bench.say("MOV X 7\nERR?\nMOV X 8\nMAC END\nERR?\n"),
        "1005\n1005\n"
    );
    assert_eq!(bench.say("MOV? X\n"), "X=0\n");
    assert_eq!(bench.say_to(other, "MAC END\nMAC? here\n"), "MOV Y 2\n");
    assert!(bench.tick.log.is_empty());
}

#[test]
fn a_macro_replaces_the_one_of_its_name() {
    let mut bench = with(&[
        ("a", "MOV X 1; MOV X 2"),
        ("b", "MOV Y 1"),
        ("c", "MOV W 1"),
    ]);
    let free = bench.say("MAC FREE?\n");
    record(&mut bench, "A", "MOV X 9; MOV X 8");
    assert_eq!(
        bench.say("MAC? a\nMAC? b\nMAC? c\n"),
        "MOV X 9 \nMOV X 8\nMOV Y 1\nMOV W 1\n"
    );
    assert_eq!(bench.say("MAC FREE?\n"), free);
    assert_eq!(bench.error_after("MAC DEL b"), "0");
    assert_eq!(bench.say("MAC?\nMAC? c\n"), "A \nc\nMOV W 1\n");
    assert_eq!(bench.error_after("MAC DEL b"), "20");
    assert_eq!(bench.error_after("MAC DEL a\nMAC DEL c"), "0");
    assert_eq!(bench.say("MAC?\nMAC FREE?\n"), format!("\n{MACRO_BYTES}\n"));
}

#[test]
fn a_line_that_could_never_be_carried_out_spoils_the_recording() {
    for (line, error) in [
        ("MOVE X 1", "2"),
        ("MOV Q 1", "15"),
        ("MOV X", "24"),
        ("$X", "2"),
        ("QQQ $X", "2"),
        ("MOV\u{7f} $X", "1"),
        ("MAC BEG x", "1003"),
        ("MAC NSTART x 0", "17"),
    ] {
        let mut bench = with(&[("a", "MOV X 1")]);
        bench.say("MAC BEG a\n");
        let error = if line == "$X" { "0" } else { error };
        assert_eq!(
            bench.error_after(&format!("{line}\nMOV X 2")),
            error,
            "{line}"
        );
        assert_eq!(bench.error_after("MAC END"), error, "{line}");
        let kept = if error == "0" {
            "$X \nMOV X 2\n"
        } else {
            "MOV X 1\n"
        };
        assert_eq!(bench.say("MAC? a\n"), kept, "{line}");
    }
}

#[test]
fn names_and_keywords() {
    let mut bench = with(&[("a", "MOV X 1")]);
    let long = "n".repeat(NAME_BYTES + 1);
    let longer = "v".repeat(TEXT_BYTES + 1);
    for (line, error) in [
        ("MAC", "24"),
        ("MAC BEG", "24"),
        ("MAC PLAY a", "1003"),
        ("MAC BEG a-b", "18"),
        (&*format!("MAC BEG {long}"), "18"),
        ("MAC START b", "20"),
        ("MAC? b", "20"),
        ("MAC STOP b", "20"),
        ("MAC STOP a", "0"),
        ("MAC STOP", "0"),
        ("MAC END", "1002"),
        ("MAC START a 1 2 3", "24"),
        (&*format!("MAC START a {longer}"), "17"),
        ("MAC NSTART a", "24"),
        ("MAC NSTART a 1.5", "17"),
        ("MAC NSTART a -1", "17"),
        ("JRC -1 ONT? X = 1", "89"),
        ("MEX ONT? X = 1", "89"),
        ("JRC x ONT? X = 1", "25"),
        ("JRC 0.5 ONT? X = 1", "17"),
        ("JRC 1 VAR? = 1", "1006"),
        ("MEX CSV? = 2", "17"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(bench.say("\x08"), "0\n");
}

#[test]
fn arguments_and_variables_are_put_in() {
    let mut bench = with(&[(
        "go",
        "VAR COUNT $0; MOV X $1 Y ${2}5; WAC ONT? X = 1; VAR 3 W; MOV $3 $TURN",
    )]);
    assert_eq!(bench.error_after("VAR TURN -7.5"), "0");
    assert_eq!(bench.error_after("MAC START go 2.5 -1"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("MOV? X Y W\n"), "X=2.5 \nY=-15 \nW=-7.5\n");
    assert_eq!(
        bench.say("VAR? count turn\nVAR?\n"),
        "TURN=-7.5 \nCOUNT=2\nTURN=-7.5 \nCOUNT=2\n"
    );
    // On a connection too; local ones are the macro's.
    assert_eq!(bench.error_after("MOV X $COUNT"), "0");
    assert_eq!(bench.say("MOV? X\n"), "X=2\n");
    assert_eq!(bench.error_after("MOV X $1"), "1007");
    assert_eq!(bench.error_after("VAR 1 5"), "1007");
    // Without its argument it fails in the second line, and says so.
    assert_eq!(bench.error_after("MAC START go 2.5"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("MAC ERR?\n"), "go 2=1007 <MOV X $1 Y ${2}5>\n");
    assert_eq!(bench.say("VAR? COUNT\n"), "COUNT=1\n");
}

#[test]
fn variables_are_set_added_to_and_forgotten() {
    let mut bench = Bench::new();
    for (line, error) in [
        ("VAR A 1", "0"),
        ("ADD A $A 0.25", "0"),
        ("ADD B 1e300 1e300", "0"),
        ("ADD C 1.1111111111111e-300 0", "0"),
        ("VAR D hello", "0"),
        ("ADD D $D 1", "25"),
        ("ADD D 1e308 1e308", "17"),
        ("ADD D 1", "24"),
        ("VAR", "24"),
        ("VAR a-b 1", "1006"),
        ("VAR 12 1", "1006"),
        ("VAR X 1 2", "24"),
        ("VAR NONE", "1007"),
        ("VAR? NONE", "1007"),
        ("MOV X ${A", "1006"),
        ("MOV X $", "1006"),
        ("MOV X $NONE", "1007"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(
        bench.say("VAR?\n"),
        "A=1.25 \nB=2e300 \nC=1.1111111111111e-300 \nD=hello\n"
    );
    assert_eq!(bench.error_after("VAR D\nVAR C\nVAR B"), "0");
    assert_eq!(bench.say("VAR?\n"), "A=1.25\n");
    for number in 1..MAX_VARIABLES {
        assert_eq!(bench.error_after(&format!("VAR N{number} {number}")), "0");
    }
    assert_eq!(bench.error_after("VAR MORE 1"), "601");
    assert_eq!(bench.error_after("VAR N7 70"), "0");
    assert_eq!(bench.say("VAR? N7\n"), "N7=70\n");
    // What a line becomes is no longer than a line may be.
    let text = "v".repeat(TEXT_BYTES);
    assert_eq!(bench.error_after(&format!("VAR N1 {text}")), "0");
    assert_eq!(bench.error_after(&format!("MOV {}", "$N1".repeat(9))), "3");
    assert_eq!(bench.error_after(&format!("MOV {}", "$N1".repeat(7))), "15");
}

#[test]
fn variables_belong_to_their_connection_until_a_macro_gets_them() {
    let mut bench = with(&[("count", "ADD N $N 1; ADD N $N 1")]);
    let other = bench.connect();
    assert_eq!(bench.error_after("VAR N 5\nVAR Q 1"), "0");
    assert_eq!(bench.say_to(other, "VAR?\nERR?\n"), "\n0\n");
    assert_eq!(bench.say_to(other, "VAR? Q\nERR?\n"), "1007\n");
    assert_eq!(bench.say_to(other, "MOV X $Q\nERR?\n"), "1007\n");
    // Its own, with the same name.
    assert_eq!(bench.say_to(other, "VAR Q MAC\nVAR? Q\n"), "Q=MAC\n");
    assert_eq!(bench.say("VAR? Q\n"), "Q=1\n");
    assert_eq!(bench.error_after("MAC START count"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("VAR?\nMAC ERR?\n"), "N=7 \nQ=1\n\n");
    // What the macro has is everybody's, behind what is a connection's own.
    assert_eq!(bench.say_to(other, "VAR?\n"), "Q=MAC \nN=7\n");
    assert_eq!(bench.say_to(other, "ADD N $N 1\nVAR Q\nERR?\n"), "0\n");
    assert_eq!(bench.say("VAR? N\n"), "N=8\n");
    assert_eq!(bench.say_to(other, "VAR? Q\n"), "Q=1\n");
    // An owner's macros are the owner's.
    assert_eq!(bench.error_after("OWN 1"), "0");
    assert_eq!(bench.say_to(other, "VAR N 1\nERR?\n"), "4002\n");
    assert_eq!(bench.say_to(other, "VAR M 1\nERR?\n"), "0\n");
    // With no room for them no macro starts.
    assert_eq!(bench.error_after("OWN 0"), "0");
    for number in 2..MAX_VARIABLES {
        assert_eq!(bench.error_after(&format!("VAR N{number} 1")), "0");
    }
    assert_eq!(bench.error_after("MAC START count"), "0");
    finish(&mut bench);
    assert_eq!(bench.say_to(other, "MAC START count\nERR?\n"), "601\n");
    assert_eq!(bench.say_to(other, "VAR? M N\n"), "M=1 \nN=10\n");
}

#[test]
fn loops_count_and_end() {
    let mut bench = with(&[(
        "count",
        "VAR N 0; ADD N $N 1; JRC -1 VAR? N < 5; MEX VAR? N = 5; VAR N never",
    )]);
    assert_eq!(bench.error_after("MAC START count"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("VAR? N\nMAC ERR?\n"), "N=5\n\n");
    record(
        &mut bench,
        "skip",
        "VAR N 1; JRC 2 VAR? N = 1; VAR N 2; ADD N $N 10; JRC 1 VAR? N > 0; ADD N $N 100",
    );
    assert_eq!(bench.error_after("MAC START skip"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("VAR? N\n"), "N=111\n");
}

#[test]
fn a_jump_out_of_the_macro_is_an_error() {
    for (jump, error) in [("-3", "17"), ("3", "17"), ("2147483647", "17"), ("2", "")] {
        let mut bench = with(&[("j", &*format!("VAR N 1; JRC {jump} VAR? N = 1; VAR N 2"))]);
        assert_eq!(bench.error_after("MAC START j"), "0");
        finish(&mut bench);
        let told = bench.say("MAC ERR?\n");
        let wanted = if error.is_empty() {
            "\n".to_owned()
        } else {
            format!("j 2={error} <JRC {jump} VAR? N = 1>\n")
        };
        assert_eq!(
            (told, bench.say("VAR? N\n")),
            (wanted, "N=1\n".to_owned()),
            "{jump}"
        );
    }
}

#[test]
fn repeated_and_nested() {
    let mut bench = with(&[
        ("inner", "ADD N $N $1"),
        ("outer", "MAC NSTART inner 3 10; ADD N $N $1"),
    ]);
    assert_eq!(bench.error_after("VAR N 0\nMAC NSTART outer 4 1"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("VAR? N\nMAC ERR?\n"), "N=124\n\n");
}

#[test]
fn a_macro_that_starts_itself_comes_to_an_end() {
    let mut bench = with(&[("self", "ADD N $N 1; MAC START self")]);
    assert_eq!(bench.error_after("VAR N 0\nMAC START self"), "0");
    finish(&mut bench);
    assert_eq!(
        bench.say("VAR? N\nMAC ERR?\n"),
        format!("N={MAX_CALL_DEPTH}\nself 2=1000 <MAC START self>\n")
    );
}

#[test]
fn while_one_runs() {
    let mut bench = with(&[("wait", "DEL 1000"), ("b", "MOV X 1")]);
    assert_eq!(bench.error_after("MAC START wait"), "0");
    for line in ["MAC START b", "MAC NSTART wait 2", "MAC DEL b", "MAC BEG c"] {
        assert_eq!(bench.error_after(line), "1008", "{line}");
    }
    assert_eq!(
        bench.say("RMC?\nMAC?\nMAC? b\n"),
        "wait\nwait \nb\nMOV X 1\n"
    );
    // Moves are everybody's still.
    assert_eq!(bench.error_after("MOV X 2"), "0");
    // Stopping one that does not run leaves the other alone.
    assert_eq!(bench.error_after("MAC STOP b"), "0");
    assert_eq!(bench.say("\x08"), "1\n");
    assert_eq!(bench.error_after("MAC STOP wait"), "0");
    assert_eq!(bench.say("\x08"), "0\n");
    assert_ne!(bench.say("\x05"), "0\n");
    assert_eq!(bench.error_after("MAC START b"), "0");
}

#[test]
fn a_recording_that_would_replace_the_running_macro_is_dropped() {
    let mut bench = with(&[("a", "DEL 10; MOV X 1")]);
    let other = bench.connect();
    bench.say("MAC BEG a\nMOV X 2\n");
    assert_eq!(bench.say_to(other, "MAC START a\nERR?\n"), "0\n");
    assert_eq!(bench.say("MAC END\nERR?\n"), "1008\n");
    finish(&mut bench);
    assert_eq!(bench.say("MAC? a\nMOV? X\n"), "DEL 10 \nMOV X 1\nX=1\n");
}

#[test]
fn a_stop_ends_it_wherever_it_comes_from() {
    for stop in ["STP\n", "\x18"] {
        for text in [
            "MOV X 50; DEL 5000; MOV X 0",
            "MOV X 50; VAR N 1; JRC 0 VAR? N = 1; MOV X 0",
        ] {
            let mut bench = with(&[("m", text)]);
            let other = bench.connect();
            bench.say("MAC START m\n");
            bench.run(500);
            bench.say_to(other, stop);
            assert_eq!(bench.say("\x08"), "0\n", "{text}");
            bench.run_to_rest();
            assert!(bench.value("MOV? X") < 50.0);
            let log = bench.tick.log.len();
            bench.run(120_000);
            assert_eq!(bench.tick.log.len(), log);
            assert_eq!(bench.say("MAC ERR?\n"), "\n");
        }
    }
}

#[test]
fn stopping_inside_a_macro() {
    let mut bench = with(&[
        ("halt", "MOV X 50; DEL 5; HLT X; WAC ONT? X = 1; MOV Y 1"),
        ("stop", "STP; MOV Y 2"),
    ]);
    assert_eq!(bench.error_after("MAC START halt"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("MOV? Y\nMAC ERR?\n"), "Y=1\n\n");
    bench.run_to_rest();
    assert_eq!(bench.error_after("MAC START stop"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("MOV? Y\n"), "Y=1\n");
}

#[test]
fn it_goes_on_without_its_client_and_errors_are_its_own() {
    let mut bench = with(&[("m", "DEL 5; MOV X 100; MOV X 1")]);
    let client = bench.connect();
    bench.say_to(client, "MAC START m\n");
    // The client is gone.
    *bench.session(client) = firmware::gcs::Session::new();
    finish(&mut bench);
    assert_eq!(
        bench.say("ERR?\nMAC ERR?\nMOV? X\n"),
        "0\nm 2=7 <MOV X 100>\nX=0\n"
    );
    record(&mut bench, "good", "MOV X 1");
    bench.say("MAC START good\n");
    assert_eq!(bench.say("MAC ERR?\n"), "\n");
}

#[test]
fn a_fault_ends_it_and_an_old_one_does_not() {
    let mut bench = with(&[
        ("m", "MOV X 50; WAC ONT? X = 1; MOV X 0"),
        ("again", "FLC; FRF; MOV X 1"),
    ]);
    bench.say("MAC START m\n");
    bench.run(500);
    bench.tick.fail(FaultKind::BridgeFault, Some(0));
    finish(&mut bench);
    assert_eq!(bench.say("MAC ERR?\n"), "m 2=1024 <WAC ONT? X = 1>\n");
    assert_eq!(bench.say("ERR?\nERR?\n"), "1024\n0\n");
    bench.run_to_rest();
    assert_eq!(bench.error_after("MAC START again"), "0");
    finish(&mut bench);
    assert_eq!(bench.say("MAC ERR?\nMOV? X\n"), "\nX=1\n");
}

#[test]
fn waiting_for_what_is_no_number_is_an_error() {
    let mut bench = with(&[("m", "VAR A word; WAC VAR? A = 1")]);
    bench.say("MAC START m\n");
    finish(&mut bench);
    assert_eq!(bench.say("MAC ERR?\n"), "m 2=25 <WAC VAR? A = 1>\n");
    assert_eq!(bench.error_after("WAC VAR? B = 1"), "1007");
}

#[test]
fn the_level_of_who_starts_it_is_the_macros() {
    let mut bench = with(&[("m", "SPA 1 0x54500300 250")]);
    bench.say("MAC START m\n");
    finish(&mut bench);
    assert_eq!(bench.say("MAC ERR?\n"), "m 1=60 <SPA 1 0x54500300 250>\n");
    assert_eq!(bench.error_after("CCL 1 ADVANCED\nMAC START m"), "0");
    finish(&mut bench);
    assert_eq!(
        bench.say("MAC ERR?\nSPA? 1 0x54500300\n"),
        "\n1 0x54500300=250\n"
    );
}

#[test]
fn an_endless_loop_holds_up_nobody() {
    let mut bench = with(&[
        ("jump", "ADD N $N 1; JRC -1 VAR? N > 0"),
        ("count", "ADD N $N 1"),
    ]);
    let other = bench.connect();
    for (start, lines) in [
        ("MAC START jump", 2),
        ("MAC NSTART count 4294967295", LINES_PER_TICK),
    ] {
        assert_eq!(bench.error_after(&format!("VAR N 0\n{start}")), "0");
        bench.say("VAR N 0\n");
        let tick = bench.tick.now.tick;
        // However often it is serviced, however many there are.
        for _ in 0..50 {
            bench.run(1);
            for _ in 0..20 {
                bench.service(other);
            }
            assert_eq!(bench.say_to(other, "CSV?\n"), "2.0\n");
        }
        let count = bench.value("VAR? N");
        let ticks = (bench.tick.now.tick - tick) as f64;
        assert!(
            count > 0.9 * ticks && count <= (ticks + 3.0) * f64::from(lines),
            "{start}: {count} in {ticks}"
        );
        assert_eq!(bench.say_to(other, "MAC STOP\n\x08"), "0\n");
    }
}

#[test]
fn memory_is_bounded() {
    let mut bench = Bench::new();
    let line = format!("MOV X {}1\n", " ".repeat(192));
    let many = MACRO_BYTES / line.len();
    bench.say("MAC BEG big\n");
    for _ in 0..many {
        assert_eq!(bench.error_after(&line[..line.len() - 1]), "0");
    }
    assert_eq!(bench.error_after(&line[..line.len() - 1]), "601");
    assert_eq!(bench.error_after("MAC END"), "601");
    assert_eq!(bench.say("MAC?\nMAC FREE?\n"), format!("\n{MACRO_BYTES}\n"));
    for number in 0..MAX_MACROS {
        record(&mut bench, &format!("m{number}"), "MOV X 1");
    }
    assert_eq!(bench.error_after("MAC BEG more\nMOV X 1\nMAC END"), "601");
    record(&mut bench, "m3", "MOV X 2");
    let used = MAX_MACROS * "MOV X 1\n".len();
    assert_eq!(
        bench.say("MAC FREE?\n"),
        format!("{}\n", MACRO_BYTES - used)
    );
}

//! Any bytes, at any split: no panic, and the same result.

mod gcs_bench;

use firmware::gcs::parse;
use gcs_bench::Bench;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Fixed seed and number of cases, so that every run tests the same. Another seed: PROPTEST_RNG_SEED in the
/// environment.
fn settings() -> ProptestConfig {
    let seed = std::env::var("PROPTEST_RNG_SEED")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(20_260_118);
    println!("proptest seed {seed}");
    ProptestConfig {
        cases: 1_000,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Pieces of lines, whole lines, single bytes and noise, so that many streams mean something.
fn stream() -> impl Strategy<Value = Vec<u8>> {
    let words = prop::sample::select(vec![
        "MOV",
        "MOV?",
        "MVR",
        "POS?",
        "X",
        "Y",
        "Z",
        "W",
        " ",
        " ",
        "  ",
        "\n",
        "\n",
        "\r\n",
        "1",
        "-2.5",
        "1e-3",
        "1e400",
        "nan",
        "SVO",
        "SVO?",
        "0",
        "FRF\n",
        "FRF? X\n",
        "ERR?\n",
        "ERR?\n",
        "ONT?\n",
        "VLS 10\n",
        "VLS?\n",
        "HLP?\n",
        "STP\n",
        "HLT X\n",
        "\x03",
        "\x05",
        "\x07",
        "\x18",
        "\x09",
        "MOV X 1\n",
        "MVR W 10\n",
        "MOV? X W\n",
        "SVO X 0\n",
        "SVO X 1\n",
        "FLT?\n",
        "=",
        "<",
        "WAC ONT? X",
        "MOV X 100\n",
        "*IDN?\n",
        "SAI? ALL\n",
        "CCL 1 ADVANCED\n",
        "SPA 1 0x54500300 250\n",
        "SPA 1 0x54500100",
        "SPA? 1 0x54500100\n",
        "VAR A 1\n",
        "VAR A",
        "VAR? A\n",
        "ADD A $A 1\n",
        "$A",
        "${A}",
        "MAC BEG m\n",
        "MAC END\n",
        "MAC? m\n",
        "MAC DEL m\n",
        "MAC FREE?\n",
        "MEX VAR? A > 0\n",
        "JRC -1",
        "LST\n",
        "EVT?\n",
        "HBT?\n",
    ])
    .prop_map(|word: &str| word.as_bytes().to_vec());
    let noise = prop::collection::vec(any::<u8>(), 0..300);
    prop::collection::vec(prop_oneof![20 => words, 1 => noise], 0..40)
        .prop_map(|pieces| pieces.concat())
}

/// What a refused line leaves as it was.
const STATE: &str = "MOV?\nSVO?\nVLS?\nSPA?\nVAR?\nMAC?\nMAC FREE?\nHBT?\n";

/// The answers to `bytes`, cut at `cuts`, with no tick between them; then the ticks run. `None` when a wait filled the
/// input.
fn answers(bytes: &[u8], cuts: &[prop::sample::Index]) -> Option<(Vec<u8>, Vec<&'static str>)> {
    let mut bench = Bench::ready();
    let mut places: Vec<_> = cuts.iter().map(|cut| cut.index(bytes.len() + 1)).collect();
    places.extend([0, bytes.len()]);
    places.sort_unstable();
    for pair in places.windows(2) {
        if !bench.offer(0, &bytes[pair[0]..pair[1]]) {
            return None;
        }
    }
    bench.run(100);
    bench.offer(0, b"\n\nERR?\nMOV?\nSVO? X\nVLS?\n");
    bench.run(100);
    Some((bench.answers_of(0), bench.tick.log))
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn splits_change_nothing(bytes in stream(), cuts in prop::collection::vec(any::<prop::sample::Index>(), 0..20)) {
        prop_assert_eq!(answers(&bytes, &[]), answers(&bytes, &cuts));
    }

    #[test]
    fn any_line_is_a_request_or_an_error(line in prop::collection::vec(any::<u8>(), 0..64)) {
        if let Err(error) = parse(&line) {
            prop_assert!(error.code.number() != 0);
            prop_assert!((1..=line.len() + 1).contains(&error.column));
        }
    }

    #[test]
    fn any_line_of_words_is_a_request_or_an_error(line in stream()) {
        if let Err(error) = parse(&line) {
            prop_assert!((1..=line.len() + 1).contains(&error.column));
        }
    }

    /// With an error nothing has changed: no command was sent, no target has moved.
    #[test]
    fn an_error_changes_nothing(line in stream()) {
        let line: Vec<u8> = line.into_iter().filter(|byte| (b' '..=b'~').contains(byte)).take(200).collect();
        let mut bench = Bench::ready();
        let before = bench.say(STATE);
        bench.offer(0, &line);
        bench.offer(0, b"\n");
        bench.run(3);
        bench.answers_of(0);
        let waits = !bench.session(0).is_idle();
        if !waits && bench.say("ERR?\n") != "0\n" {
            prop_assert_eq!(bench.say(STATE), before);
            prop_assert!(bench.tick.log.is_empty());
        }
    }

    /// What is commanded comes back as the same number, and the stage goes there.
    #[test]
    fn targets_come_back_exactly(radius in 0.0..79.0f64, direction in -3.0..3.0f64, w in -1e6..1e6f64) {
        let (x, y) = (radius * direction.cos(), radius * direction.sin());
        let mut bench = Bench::ready();
        prop_assert_eq!(bench.error_after(&format!("MOV X {x} Y {y:e} W {w}")), "0");
        prop_assert_eq!(bench.value("MOV? X"), x);
        prop_assert_eq!(bench.value("MOV? Y"), y);
        prop_assert_eq!(bench.value("MOV? W"), w);
    }

    /// Where bytes are lost, whole lines are: what is left of two never makes up a third, and error 304 tells.
    #[test]
    fn a_gap_takes_whole_lines(from in 0..110usize, length in 0..110usize, rests in any::<bool>()) {
        // Almost any beginning of one makes a line with the end of another.
        let lines: Vec<String> = (0..8).map(|k| format!("VAR V{k} 1{k}2.5{k}\n")).collect();
        let text = lines.concat();
        let to = (from + length).min(text.len());
        prop_assume!(from <= text.len());
        let mut bench = Bench::ready();
        bench.offer(0, &text.as_bytes()[..from]);
        if rests {
            bench.run(2);
        }
        bench.session(0).lose();
        bench.offer(0, &text.as_bytes()[to..]);
        bench.run(2);
        let mut at = 0;
        let mut kept = Vec::new();
        for (k, line) in lines.iter().enumerate() {
            let (start, end) = (at, at + line.len());
            at = end;
            // Behind the gap the first LF ends what is thrown away.
            if end <= from || (start >= to && text[to..start].contains('\n')) {
                kept.push(format!("V{k}=1{k}2.5{k}"));
            }
        }
        prop_assert_eq!(bench.say("\nERR?\n"), "304\n");
        let told = bench.say("VAR?\n");
        let told: Vec<&str> = told.split('\n').map(str::trim).filter(|it| !it.is_empty()).collect();
        prop_assert_eq!(told, kept);
    }
}

//! The limits of motion at every tick, whatever is commanded when: random scripts of GCS lines, through the real command
//! side and the arithmetic by which the tick follows plans. `limit_watch/watch.rs` says what is held.
//!
//! 300 scripts by default. In the environment, `SCRIPTS` asks for another number of them, `SEED` for others, `SCRIPT` for
//! one alone:
//!
//! ```text
//! SCRIPTS=10000 cargo test --release -p firmware --test gcs_limits -- --nocapture
//! ```

mod gcs_bench;
mod limit_watch;
mod motion_bench;

use limit_watch::random_script::Theme;
use limit_watch::run::run;
use limit_watch::script::Script;
use limit_watch::survey::{Findings, print_script, survey};
use motion_bench::setting::setting;

/// From full speed, in the middle of an urgent stop, where its acceleration is at its highest.
fn interrupt_an_urgent_stop(by: &str) {
    let script = Script::parse(&format!("MOV X 60\nDEL 200\nSTP\nDEL 12\n{by}\n"));
    let outcome = run(&script);
    print_script(&script, &outcome);
    for (rule, breach) in &outcome.breaches {
        println!("{rule:?}: {breach}");
    }
    assert_eq!(outcome.counts.urgent_stops, 1, "there was a stop");
    assert!(outcome.breaches.is_empty());
}

#[test]
fn a_target_behind_an_urgent_stop_is_within_the_limits() {
    interrupt_an_urgent_stop("MOV X -60");
}

#[test]
fn a_target_ahead_of_an_urgent_stop_is_within_the_limits() {
    interrupt_an_urgent_stop("MOV X 70");
}

/// Scripts of a theme; what came of them.
fn scripts_of(theme: Theme) -> Findings {
    let seed = setting("SEED", 20_260_214);
    let numbers = match setting("SCRIPT", u64::MAX) {
        u64::MAX => 0..setting("SCRIPTS", 300),
        one => one..one + 1,
    };
    println!("{theme:?}, scripts {numbers:?} of seed {seed}");
    let mut findings = survey(theme, seed, &numbers);
    findings.print(theme, seed);
    assert!(findings.failed.is_empty());
    findings
}

#[test]
fn targets_velocities_and_stops_at_any_tick_keep_to_the_limits() {
    let Findings {
        scripts, counts, ..
    } = scripts_of(Theme::Motions);
    assert!(counts.urgent_stops * 2 > scripts || scripts < 100);
}

#[test]
fn streams_and_what_interrupts_them_keep_to_the_limits() {
    let Findings {
        scripts, counts, ..
    } = scripts_of(Theme::Streams);
    assert!(counts.stream_plans > 20 * scripts || scripts < 100);
    assert!(counts.urgent_stops * 4 > scripts || scripts < 100);
}

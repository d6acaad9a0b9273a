//! Many random scripts, and what came of them.

use super::counts::Counts;
use super::random_script::{Theme, random_script};
use super::rule::{Breach, Rule};
use super::run::{Outcome, run};
use super::script::Script;
use super::shrink::shrink;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

/// How one rule was broken.
pub struct Failure {
    /// In so many scripts.
    pub scripts: u64,
    /// Worst of all, in the script of this number.
    pub worst: Breach,
    pub number: u64,
}

/// What came of all scripts.
#[derive(Default)]
pub struct Findings {
    pub scripts: u64,
    pub failures: BTreeMap<Rule, Failure>,
    /// Numbers of the scripts that broke any rule.
    pub failed: Vec<u64>,
    pub counts: Counts,
}

impl Findings {
    fn add(&mut self, number: u64, outcome: Outcome) {
        self.scripts += 1;
        if !outcome.breaches.is_empty() {
            self.failed.push(number);
        }
        for (rule, breach) in outcome.breaches {
            self.add_breach(number, rule, breach);
        }
        self.counts.add(&outcome.counts);
    }

    fn add_breach(&mut self, number: u64, rule: Rule, breach: Breach) {
        match self.failures.get_mut(&rule) {
            None => {
                let scripts = 1;
                let failure = Failure {
                    scripts,
                    worst: breach,
                    number,
                };
                self.failures.insert(rule, failure);
            }
            Some(failure) => {
                failure.scripts += 1;
                if breach.ratio() > failure.worst.ratio() {
                    (failure.worst, failure.number) = (breach, number);
                }
            }
        }
    }

    /// Prints what was broken: of every rule the worst script, as short as it can be.
    pub fn print(&mut self, theme: Theme, seed: u64) {
        println!("{:#?}", self.counts);
        self.failed.sort_unstable();
        println!("{} scripts fail: {:?}", self.failed.len(), self.failed);
        for (rule, failure) in &self.failures {
            let Failure {
                scripts,
                worst,
                number,
            } = failure;
            println!("\n{rule:?}: in {scripts} scripts; worst in script {number}: {worst}");
            let short = shrink(random_script(theme, seed, *number), *rule);
            let outcome = run(&short);
            println!("broken too by: {}", outcome.breaches[rule]);
            print_script(&short, &outcome);
        }
    }
}

/// The script as it can be pasted, with ticks and errors as comments.
pub fn print_script(script: &Script, outcome: &Outcome) {
    for ((line, tick), error) in script.0.iter().zip(&outcome.sent).zip(&outcome.errors) {
        let refused = match error {
            0 | 10 => String::new(),
            error => format!(", error {error}"),
        };
        println!("    {line:40} # tick {tick}{refused}");
    }
}

/// Runs the scripts of these numbers, on all processors.
pub fn survey(theme: Theme, seed: u64, numbers: &Range<u64>) -> Findings {
    let next = AtomicU64::new(numbers.start);
    let findings = Mutex::new(Findings::default());
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if !numbers.contains(&number) {
                return;
            }
            let outcome = run(&random_script(theme, seed, number));
            findings.lock().expect("no panic").add(number, outcome);
        }
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(work);
        }
    });
    findings.into_inner().expect("no panic")
}

//! How much each imperfection of the simulated machine decides: the demonstration with one more, or one less, at a time.

use super::run::{RunOptions, run};
use super::script::Script;
use crate::machine::plant::{Imperfections, NAMED};
use crate::report::Move;
use parallel::of_all;

/// A machine that is compared.
#[derive(Clone, Debug)]
pub struct Compared {
    /// What it has more than a kind machine, or less.
    pub name: String,
    /// What it has.
    pub imperfections: Imperfections,
}

/// What the demonstration comes to on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Following error of the centre, which the encoders see, rms and peak, um.
    pub following_um: [f64; 2],
    /// Error of the centre's true pose, rms and peak, um.
    pub true_um: [f64; 2],
    /// The same of theta, urad.
    pub true_urad: [f64; 2],
    /// What of the centre's error no encoder sees, rms: in motion (sag) and at rest (lost motion), um.
    pub unseen_um: [f64; 2],
    /// Error of the centre's true pose at rest, rms and peak, um.
    pub at_rest_um: [f64; 2],
    /// Settling after the profile, mean and worst, ms.
    pub settling_ms: [f64; 2],
    /// What ended it before its end.
    pub fault: Option<String>,
}

/// The reference stage, or a kind one; one with each imperfection more, or less; and the other of the two. The controllers of an unkind stage have
/// what its commissioning found of it, as far as it is there.
#[must_use]
pub fn compared(of_kind: bool) -> Vec<Compared> {
    let (kind, all) = (Imperfections::CALIBRATED, Imperfections::ALL);
    let [(name, base), other] = if of_kind {
        [("kind", kind), ("with all", all)]
    } else {
        [("reference", all), ("kind", kind)]
    };
    let named = |name: String, imperfections| Compared {
        name,
        imperfections,
    };
    let mut machines = vec![named(name.to_owned(), base)];
    for imperfection in &NAMED {
        let is_on = *(imperfection.flag)(&mut base.clone());
        let word = if is_on { "without" } else { "with" };
        if let Some(switched) = base.switched(imperfection.name, !is_on) {
            machines.push(named(format!("{word} {}", imperfection.name), switched));
        }
    }
    machines.push(named(other.0.to_owned(), other.1));
    machines
}

/// Runs the demonstration on each of them, in so many threads.
#[must_use]
pub fn measure(
    script: &Script,
    machines: &[Compared],
    options: &RunOptions,
    threads: usize,
) -> Vec<Sensitivity> {
    of_all(machines, threads, |machine| {
        demonstrate(script, machine, options)
    })
}

fn demonstrate(script: &Script, machine: &Compared, options: &RunOptions) -> Sensitivity {
    let outcome = run(
        script,
        &RunOptions {
            imperfections: machine.imperfections,
            ..options.clone()
        },
    );
    let statistics = outcome.run.trace.statistics();
    let (seen, truth) = (&statistics.moving.following, &statistics.moving.truth);
    let at_rest = &statistics.at_rest;
    let settling_ms: Vec<f64> = (outcome.run.moves.iter())
        .filter_map(Move::settle_s)
        .map(|settle_s| 1e3 * settle_s)
        .collect();
    let mean_ms = settling_ms.iter().sum::<f64>() / settling_ms.len() as f64;
    let worst_ms = settling_ms.iter().copied().fold(f64::NAN, f64::max);
    Sensitivity {
        following_um: [seen.xy_um.rms(), seen.xy_um.peak()],
        true_um: [truth.xy_um.rms(), truth.xy_um.peak()],
        true_urad: [truth.theta_urad.rms(), truth.theta_urad.peak()],
        unseen_um: [&statistics.moving, &statistics.at_rest].map(|at| at.unseen.xy_um.rms()),
        at_rest_um: [at_rest.truth.xy_um.rms(), at_rest.truth.xy_um.peak()],
        settling_ms: [mean_ms, worst_ms],
        fault: outcome.fault,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_imperfection_is_compared_once() {
        for machines in [compared(true), compared(false)] {
            assert_eq!(machines.len(), NAMED.len() + 2);
            for (i, machine) in machines.iter().enumerate() {
                let alike = |other: &Compared| other.imperfections == machine.imperfections;
                assert!(!machines[..i].iter().any(alike), "{}", machine.name);
            }
        }
    }

    /// What no encoder sees shows in the true pose alone.
    #[test]
    fn a_runout_that_no_encoder_sees_is_in_the_true_pose() {
        let script = Script::parse("short", "FRF\nMOV X 20 W 30\nWAC ONT? X = 1\n").unwrap();
        let machines: Vec<_> = (compared(true).into_iter())
            .filter(|machine| ["kind", "with geometry"].contains(&machine.name.as_str()))
            .collect();
        let options = RunOptions {
            mismatch_percent: 0.0,
            ..RunOptions::default()
        };
        let [kind, built] = &measure(&script, &machines, &options, 2)[..] else {
            panic!("two machines");
        };
        assert_eq!((&kind.fault, &built.fault), (&None, &None));
        assert!(
            built.true_um[0] > 10.0 && kind.true_um[0] < 1.0,
            "{kind:?} {built:?}"
        );
        assert!(built.following_um[0] < 1.0, "{built:?}");
    }
}

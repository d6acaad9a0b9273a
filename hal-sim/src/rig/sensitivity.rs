//! How much each imperfection of the simulated machine decides: the demonstration with one more, or one less, at a time.

use super::run::{RunOptions, run};
use super::script::Script;
use crate::machine::plant::{Imperfections, NAMED};
use crate::parallel::of_all;
use crate::report::Move;

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
    /// Settling after the profile, mean and worst, ms.
    pub settling_ms: [f64; 2],
    /// What ended it before its end.
    pub fault: Option<String>,
}

/// A kind machine, one with each imperfection more, one with each less, and one with all.
#[must_use]
pub fn compared() -> Vec<Compared> {
    let kind = Imperfections::CALIBRATED;
    let named = |name: String, imperfections| Compared {
        name,
        imperfections,
    };
    let mut machines = vec![named("kind".to_owned(), kind)];
    for imperfection in &NAMED {
        let is_on = *(imperfection.flag)(&mut kind.clone());
        let word = if is_on { "without" } else { "with" };
        if let Some(switched) = kind.switched(imperfection.name, !is_on) {
            machines.push(named(format!("{word} {}", imperfection.name), switched));
        }
    }
    machines.push(named("with all".to_owned(), Imperfections::ALL));
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
    let (seen, truth) = (&statistics.following_error, &statistics.true_error);
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
        settling_ms: [mean_ms, worst_ms],
        fault: outcome.fault,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_imperfection_is_compared_once() {
        let machines = compared();
        assert_eq!(machines.len(), NAMED.len() + 2);
        for (i, machine) in machines.iter().enumerate() {
            let alike = |other: &Compared| other.imperfections == machine.imperfections;
            assert!(!machines[..i].iter().any(alike), "{}", machine.name);
        }
    }

    /// What no encoder sees shows in the true pose alone.
    #[test]
    fn a_runout_that_no_encoder_sees_is_in_the_true_pose() {
        let script = Script::parse("short", "FRF\nMOV X 20 W 30\nWAC ONT? X = 1\n").unwrap();
        let machines: Vec<_> = (compared().into_iter())
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

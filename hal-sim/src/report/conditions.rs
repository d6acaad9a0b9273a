//! What a run was made under: with these and its script it can be made again.

use std::fmt;

use crate::machine::plant::Imperfections;
use serde::Serialize;

/// The conditions of a run.
#[derive(Clone, PartialEq, Default, Debug, Serialize)]
pub struct Conditions {
    /// The program that made the run, its version and commit.
    pub program: String,
    /// What was simulated, and what computed its controller.
    pub machine: String,
    /// Seed of the simulated noise.
    pub seed: u64,
    /// By how much the plant departed from the controller's model of it, percent.
    pub mismatch_percent: f64,
    /// Load that the controller knew nothing of, kg.
    pub payload_kg: f64,
    /// Imperfections of a kind machine that were switched off, by their names on the command line.
    pub without: Vec<&'static str>,
    /// Imperfections that were on beyond those of a kind machine.
    pub with: Vec<&'static str>,
    /// File that the controller kept its settings in, if any: without one it had those that the simulated machine comes with.
    pub settings: Option<String>,
}

impl Conditions {
    /// Each with its name, as a reader has them listed.
    pub fn list(&self) -> [(&'static str, String); 7] {
        [
            ("program", self.program.clone()),
            ("machine", self.machine.clone()),
            ("seed", self.seed.to_string()),
            ("mismatch", format!("{} %", self.mismatch_percent)),
            ("payload", format!("{} kg", self.payload_kg)),
            ("imperfections", self.imperfections()),
            (
                "settings",
                self.settings
                    .clone()
                    .unwrap_or_else(|| "the machine's own".into()),
            ),
        ]
    }

    fn imperfections(&self) -> String {
        let beyond = Imperfections::ALL.beyond(Imperfections::CALIBRATED);
        let missing = beyond.iter().filter(|name| !self.with.contains(name));
        let off: Vec<_> = self.without.iter().chain(missing).copied().collect();
        if off.is_empty() {
            return "all".to_owned();
        }
        if off.len() < self.with.len() {
            return format!("all but {}", off.join(", "));
        }
        let mut text = "of a kind machine".to_owned();
        for (names, word) in [(&self.without, "but"), (&self.with, "and")] {
            if !names.is_empty() {
                text += &format!(" {word} {}", names.join(", "));
            }
        }
        text
    }
}

/// All of them in one line.
impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [(_, program), (_, machine), rest @ ..] = self.list();
        write!(f, "{program}; {machine}")?;
        for (name, value) in rest {
            write!(f, "; {name} {value}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_has_all_of_them() {
        let conditions = Conditions {
            program: "tripivot 1.2.3 abc".to_owned(),
            machine: "reference stage".to_owned(),
            seed: 7,
            mismatch_percent: -12.5,
            payload_kg: 5.0,
            without: vec!["backlash", "dead-time"],
            with: vec!["geometry"],
            settings: Some("kept.bin".to_owned()),
        };
        assert_eq!(
            conditions.to_string(),
            "tripivot 1.2.3 abc; reference stage; seed 7; mismatch -12.5 %; payload 5 kg; \
             imperfections of a kind machine but backlash, dead-time and geometry; settings kept.bin"
        );
        let all = Conditions {
            without: Vec::new(),
            with: Imperfections::ALL.beyond(Imperfections::CALIBRATED),
            ..conditions
        };
        assert_eq!(all.list()[5].1, "all");
        let most = Conditions {
            without: vec!["backlash"],
            with: all.with[1..].to_vec(),
            ..all
        };
        assert_eq!(most.list()[5].1, "all but backlash, encoder-eccentricity");
        assert!((Conditions::default().to_string()).ends_with(
            "seed 0; mismatch 0 %; payload 0 kg; imperfections of a kind machine; settings the machine's own"
        ));
    }
}

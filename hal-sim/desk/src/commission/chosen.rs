//! Which steps are run: all, those from one on, or one after a repair. What the steps before have found is asked of the controller.

use super::STEPS;
use super::Step;
use super::bench::Bench;
use super::found::{CommissionError, fail};
use super::known::Known;
use super::servo_gains;
use super::steps::settle_widely;

/// Steps that need more of those before them than the controller's parameters hold.
const NOT_FIRST: [&str; 5] = ["hand", "nudges", "response", "tuning", "guides"];
/// Before it the servo is off, and nothing may be commissioned; after it a servo holds the stage.
const FIRST_SERVO: &str = "sde";
/// Steps that find the encoders' zeros: one of them is enough.
const BY_JIG: &str = "zeros";
const BY_GUIDE_ENDS: &str = "ends";
/// What ends all of them.
const LAST: &str = "keep";

/// See the module.
#[derive(Clone)]
pub struct Chosen {
    pub(super) steps: Vec<&'static Step>,
    is_resumed: bool,
    /// Whether the load is not the one that the gains in force are for.
    is_loaded_anew: bool,
    /// What may stand on the platform besides what is on it, at most, kg.
    also_carries_kg: f64,
}

/// How the encoders' zeros are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ZerosBy {
    /// With the platform in its jig.
    #[default]
    Jig,
    /// From where the guides end.
    GuideEnds,
}

impl ZerosBy {
    /// By whether there is no jig.
    #[must_use]
    pub const fn new(without_jig: bool) -> Self {
        if without_jig {
            Self::GuideEnds
        } else {
            Self::Jig
        }
    }

    const fn left_out(self) -> &'static str {
        match self {
            Self::Jig => BY_GUIDE_ENDS,
            Self::GuideEnds => BY_JIG,
        }
    }
}

/// What is left of gains for another load until it is known: without the largest one motors move a third of what they move with it.
const OTHER_LOAD: f64 = 0.5;

/// What a platform may carry at times besides what is on it, kg.
pub const MOST_ALSO_CARRIED_KG: f64 = 20.0;

/// Why steps cannot be chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    /// No such name.
    #[error("there is no step `{0}`; --list tells their names")]
    NoStep(String),
    /// Not a weight that a stage of this kind carries.
    #[error("what the platform carries at times besides is 0 to {MOST_ALSO_CARRIED_KG} kg")]
    Weight,
    /// It uses what is in no parameter.
    #[error("step `{name}` needs what the one before it finds: begin with `{begin}`")]
    NotFirst {
        /// Which.
        name: String,
        /// With which to begin.
        begin: &'static str,
    },
}

impl Chosen {
    /// All of them.
    #[must_use]
    pub fn all(zeros: ZerosBy) -> Self {
        Self::on(0, zeros.left_out())
    }

    /// A step and those after it. It may itself be the one that finds the zeros the other way.
    ///
    /// # Errors
    /// [`ChoiceError`].
    pub fn from(name: &str, zeros: ZerosBy) -> Result<Self, ChoiceError> {
        let left_out = match name {
            BY_JIG => BY_GUIDE_ENDS,
            BY_GUIDE_ENDS => BY_JIG,
            _ => zeros.left_out(),
        };
        Ok(Self::on(index(name)?, left_out))
    }

    fn on(first: usize, left_out: &str) -> Self {
        let steps = STEPS.iter().skip(first);
        Self {
            steps: steps.filter(|step| step.name != left_out).collect(),
            is_resumed: first > 0,
            is_loaded_anew: false,
            also_carries_kg: 0.0,
        }
    }

    /// A step alone, and keeping what it finds.
    ///
    /// # Errors
    /// [`ChoiceError`].
    pub fn only(name: &str) -> Result<Self, ChoiceError> {
        let at = index(name)?;
        let steps = STEPS.iter().enumerate();
        Ok(Self {
            steps: steps
                .filter(|(k, step)| *k == at || step.name == LAST)
                .map(|(_, step)| step)
                .collect(),
            is_resumed: at > 0,
            is_loaded_anew: false,
            also_carries_kg: 0.0,
        })
    }

    /// What a new payload changes, on a machine that was commissioned.
    #[must_use]
    pub fn tune() -> Self {
        let names = [
            "identification",
            "response",
            "tuning",
            "limits",
            "verification",
            LAST,
        ];
        Self {
            is_loaded_anew: true,
            ..Self::named(&names)
        }
    }

    /// The loop as it is; nothing is kept.
    #[must_use]
    pub fn response() -> Self {
        Self::named(&["identification", "response"])
    }

    fn named(names: &[&str]) -> Self {
        let steps = STEPS.iter();
        Self {
            steps: steps.filter(|step| names.contains(&step.name)).collect(),
            is_resumed: true,
            is_loaded_anew: false,
            also_carries_kg: 0.0,
        }
    }

    /// For a platform that carries so many kg more at times: gains keep their margins with that as well, and motors bear it.
    ///
    /// # Errors
    /// [`ChoiceError::Weight`].
    pub fn also_carrying(self, also_carries_kg: f64) -> Result<Self, ChoiceError> {
        if !(0.0..=MOST_ALSO_CARRIED_KG).contains(&also_carries_kg) {
            return Err(ChoiceError::Weight);
        }
        Ok(Self {
            also_carries_kg,
            ..self
        })
    }

    /// Those that are run.
    #[must_use]
    pub fn steps(&self) -> &[&'static Step] {
        &self.steps
    }

    /// Whether what the steps find stays in force.
    #[must_use]
    pub fn keeps(&self) -> bool {
        self.steps.last().is_some_and(|step| step.name == LAST)
    }

    /// Brings the controller to where the first step expects it.
    pub(super) fn begin(&self, bench: &mut Bench<'_>) -> Result<Known, CommissionError> {
        let also_carries_kg = self.also_carries_kg;
        if !self.is_resumed {
            return Ok(Known {
                also_carries_kg,
                ..Known::default()
            });
        }
        bench.ask("CCL 1 ADVANCED")?;
        bench.ask("SVO X 0")?;
        bench.ask("FLC")?;
        bench.delay(0.2)?;
        if !bench.ask("CMS?")?.starts_with('1') {
            return fail(
                "this controller has not been commissioned",
                "begin with the first step",
            );
        }
        let known = Known {
            is_loaded_anew: self.is_loaded_anew,
            also_carries_kg,
            ..Known::of_controller(bench)?
        };
        if self.is_loaded_anew {
            let gains = servo_gains::read(bench)?.slowed(OTHER_LOAD);
            servo_gains::write(bench, &gains)?;
            settle_widely(bench)?;
        }
        let place = |name: &str| STEPS.iter().position(|step| step.name == name);
        let first = self.steps.first().map_or("", |step| step.name);
        if place(first) < place(FIRST_SERVO) {
            bench.ask("CMS 0")?;
        } else {
            bench.hold()?;
        }
        Ok(known)
    }
}

fn index(name: &str) -> Result<usize, ChoiceError> {
    let position = STEPS.iter().position(|step| step.name == name);
    let at = position.ok_or_else(|| ChoiceError::NoStep(name.to_owned()))?;
    if !NOT_FIRST.contains(&name) {
        return Ok(at);
    }
    let before = STEPS.iter().take(at).rev();
    let begin = before
        .map(|step| step.name)
        .find(|name| !NOT_FIRST.contains(name));
    Err(ChoiceError::NotFirst {
        name: name.to_owned(),
        begin: begin.unwrap_or_default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(chosen: Result<Chosen, ChoiceError>) -> Vec<&'static str> {
        let steps = chosen.map(|chosen| chosen.steps).unwrap_or_default();
        steps.iter().map(|step| step.name).collect()
    }

    #[test]
    fn steps_are_chosen_by_their_names() {
        assert_eq!(names(Chosen::only("friction")), ["friction", "keep"]);
        assert_eq!(
            names(Chosen::from("verification", ZerosBy::Jig)),
            ["verification", "forces", "guides", "keep"]
        );
        assert_eq!(
            Chosen::from("tuning", ZerosBy::Jig).err(),
            Some(ChoiceError::NotFirst {
                name: "tuning".to_owned(),
                begin: "identification"
            })
        );
        assert_eq!(
            Chosen::only("nudges").err().map(|error| error.to_string()),
            Some(
                "step `nudges` needs what the one before it finds: begin with `wiring`".to_owned()
            )
        );
        assert!(Chosen::from("nothing", ZerosBy::Jig).is_err());
    }
    #[test]
    fn zeros_are_found_in_one_way() {
        for (zeros, used, left_out) in [
            (ZerosBy::Jig, "zeros", "ends"),
            (ZerosBy::GuideEnds, "ends", "zeros"),
        ] {
            let all = names(Ok(Chosen::all(zeros)));
            assert_eq!(all.len(), STEPS.len() - 1);
            assert!(all.contains(&used) && !all.contains(&left_out));
            assert_eq!(names(Chosen::from("wiring", zeros)), all);
            let later = names(Chosen::from("ring servo", zeros));
            assert_eq!(later[..3], ["ring servo", used, "reference"]);
            // The step that is asked for itself.
            let asked = names(Chosen::from(left_out, zeros));
            assert_eq!(asked[..2], [left_out, "reference"]);
        }
    }
}

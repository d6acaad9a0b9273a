//! Disturbances in scripts: lines that push or shake a simulated stage.
//!
//! ```text
//! ! PUSH X 5 N 20 MS          a force on the platform's centre for so long
//! ! PUSH W 0.1 NM 20 MS       a torque on the platform
//! ! SHAKE Y 0.05 M/S2 8 HZ 2 S    the floor shakes: a sine of this amplitude, from zero on
//! ```
//!
//! The script goes on with its next line at once. Base frame; a push and a shake along each axis may act at the same time, and the
//! newest of a kind and axis counts. Nothing is sent to the controller: a script with such lines is for a simulated stage only.

use core::f64::consts::TAU;
use std::fmt;

/// Begins a line that is a disturbance.
pub(crate) const MARK: char = '!';

/// What a disturbance acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along x of the base frame.
    X,
    /// Along y.
    Y,
    /// About the platform's centre.
    W,
}

/// How a disturbance acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// A force on the platform, N; about W a torque, N m.
    Push(f64),
    /// The floor's acceleration: amplitude, m/s^2, and frequency.
    Shake {
        /// Amplitude.
        amplitude_m_s2: f64,
        /// Frequency.
        hz: f64,
    },
}

/// A disturbance that a script orders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance {
    /// How.
    pub action: Action,
    /// Along or about what.
    pub direction: Direction,
    /// For how long.
    pub duration_s: f64,
}

impl Disturbance {
    /// Force in N, torque in N m or acceleration in m/s^2, so long after it began; `None` when it is over.
    #[must_use]
    pub fn value_after(&self, time_s: f64) -> Option<f64> {
        (time_s < self.duration_s).then(|| match self.action {
            Action::Push(size) => size,
            Action::Shake { amplitude_m_s2, hz } => amplitude_m_s2 * libm::sin(TAU * hz * time_s),
        })
    }

    /// Whether another one takes the place of this one.
    #[must_use]
    pub fn is_replaced_by(&self, newer: &Self) -> bool {
        self.direction == newer.direction
            && matches!(self.action, Action::Push(_)) == matches!(newer.action, Action::Push(_))
    }
}

/// What is wrong with a line that should be a disturbance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisturbanceError {
    /// Of what is wrong, bytes from the line's beginning.
    pub(crate) offset: usize,
    /// What should stand there.
    pub(crate) expected: &'static str,
}

impl fmt::Display for DisturbanceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected {}", self.expected)
    }
}

/// Largest sizes: what does not break a stage at once. N or N m; m/s^2; Hz, above which a tick has too few points of a sine; s.
const MOST_PUSH: f64 = 1_000.0;
const MOST_SHAKE_M_S2: f64 = 20.0;
const MOST_HZ: f64 = 2_000.0;
const MOST_S: f64 = 3_600.0;

/// Reads a line behind its mark.
pub(crate) fn parse(line: &str) -> Result<Disturbance, DisturbanceError> {
    let mut words = Words {
        line,
        offset: line.find(MARK).map_or(0, |at| at + MARK.len_utf8()),
    };
    let shakes = match &*words.next("PUSH or SHAKE")?.1 {
        "PUSH" => false,
        "SHAKE" => true,
        _ => return words.fail("PUSH or SHAKE"),
    };
    let axes = if shakes { "X or Y" } else { "X, Y or W" };
    let direction = match &*words.next(axes)?.1 {
        "X" => Direction::X,
        "Y" => Direction::Y,
        "W" if !shakes => Direction::W,
        _ => return words.fail(axes),
    };
    let action = if shakes {
        let amplitude_m_s2 = words.number("an acceleration up to 20", MOST_SHAKE_M_S2)?;
        words.unit("M/S2")?;
        let hz = words.number("a frequency up to 2000", MOST_HZ)?;
        words.unit("HZ")?;
        Action::Shake { amplitude_m_s2, hz }
    } else {
        let size = words.number("a number up to 1000", MOST_PUSH)?;
        words.unit(if direction == Direction::W { "NM" } else { "N" })?;
        Action::Push(size)
    };
    let time = words.number("a time up to an hour", f64::INFINITY)?;
    let duration_s = match &*words.next("MS or S")?.1 {
        "MS" => time / 1_000.0,
        "S" => time,
        _ => return words.fail("MS or S"),
    };
    if !(duration_s > 0.0 && duration_s <= MOST_S) {
        return words.fail("a time over zero, up to an hour");
    }
    match words.next("the line's end") {
        Err(_) => Ok(Disturbance {
            action,
            direction,
            duration_s,
        }),
        Ok(_) => words.fail("the line's end"),
    }
}

/// The words of a line, in capitals; `offset` is behind the last one.
struct Words<'a> {
    line: &'a str,
    offset: usize,
}

impl Words<'_> {
    fn next(&mut self, expected: &'static str) -> Result<(usize, String), DisturbanceError> {
        let rest = &self.line[self.offset..];
        let begin = self.offset + (rest.len() - rest.trim_start().len());
        let word = (self.line[begin..].split_whitespace().next()).ok_or(DisturbanceError {
            offset: begin,
            expected,
        })?;
        self.offset = begin + word.len();
        Ok((begin, word.to_ascii_uppercase()))
    }

    fn number(&mut self, expected: &'static str, most: f64) -> Result<f64, DisturbanceError> {
        let (offset, word) = self.next(expected)?;
        (word.parse::<f64>().ok())
            .filter(|number| number.is_finite() && number.abs() <= most)
            .ok_or(DisturbanceError { offset, expected })
    }

    fn unit(&mut self, unit: &'static str) -> Result<(), DisturbanceError> {
        let (offset, word) = self.next(unit)?;
        if word == unit {
            Ok(())
        } else {
            Err(DisturbanceError {
                offset,
                expected: unit,
            })
        }
    }

    /// The last word is not what it should be.
    fn fail<T>(&self, expected: &'static str) -> Result<T, DisturbanceError> {
        let begin = self.line[..self.offset]
            .rfind(char::is_whitespace)
            .map_or(0, |at| at + 1);
        Err(DisturbanceError {
            offset: begin,
            expected,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushes_and_shakes_are_read() {
        let push = parse("! push W -0.1 Nm 20 ms").unwrap();
        assert_eq!(
            push,
            Disturbance {
                action: Action::Push(-0.1),
                direction: Direction::W,
                duration_s: 0.02
            }
        );
        assert_eq!(
            (push.value_after(0.0199), push.value_after(0.02)),
            (Some(-0.1), None)
        );
        let shake = parse("!SHAKE Y 0.05 m/s2 8 Hz 2 s").unwrap();
        assert_eq!(shake.value_after(0.0), Some(0.0));
        let quarter = shake.value_after(1.0 / 32.0).unwrap();
        assert!((quarter - 0.05).abs() < 1e-12, "{quarter}");
        assert!(!push.is_replaced_by(&shake) && push.is_replaced_by(&push));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (line, offset, expected) in [
            ("!", 1, "PUSH or SHAKE"),
            ("! KICK X 1 N 1 S", 2, "PUSH or SHAKE"),
            ("! SHAKE W 1 M/S2 8 HZ 1 S", 8, "X or Y"),
            ("! PUSH X 1 NM 1 S", 11, "N"),
            ("! PUSH X 1e9 N 1 S", 9, "a number up to 1000"),
            ("! PUSH X nan N 1 S", 9, "a number up to 1000"),
            ("! PUSH X 1 N 1 MIN", 15, "MS or S"),
            ("! PUSH X 1 N 0 S", 15, "a time over zero, up to an hour"),
            ("! PUSH X 1 N 1 S now", 17, "the line's end"),
        ] {
            let error = parse(line).unwrap_err();
            assert_eq!((error.offset, error.expected), (offset, expected), "{line}");
        }
    }
}

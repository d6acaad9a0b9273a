//! Which frames are in force, and what they make of a target.

use super::{FrameName, Frames, Kind, Transform, View};
use crate::gcs::error::ErrorCode;

/// Furthest that a work frame may lie from the base frame's origin, mm: far beyond any laboratory, near enough for f64.
const FURTHEST_WORK_MM: f64 = 1e5;

/// Which frames are in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enabled {
    /// The base frame.
    Zero,
    /// A directed frame, or one that was made where the platform was.
    Alone(FrameName),
    /// A work frame, a tool frame, or both.
    Pair {
        /// `None`: the base frame.
        work: Option<FrameName>,
        /// `None`: the platform's own.
        tool: Option<FrameName>,
    },
}

/// The frames that are in force, and the centre of rotation: what `KEN` and `SPI` change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Which frames.
    pub enabled: Enabled,
    /// The point that `SPI` sets, mm.
    pub pivot: [f64; 2],
}

impl Frames {
    /// What would be in force once `name` is enabled.
    pub fn with_enabled(&self, name: FrameName) -> Result<Choice, ErrorCode> {
        let (work, tool) = match self.choice.enabled {
            Enabled::Pair { work, tool } => (work, tool),
            _ => (None, None),
        };
        let enabled = if name == FrameName::ZERO {
            Enabled::Zero
        } else {
            match self.find(name).ok_or(ErrorCode::OutOfRange)?.kind {
                Kind::Directed | Kind::Here => Enabled::Alone(name),
                Kind::Work => Enabled::Pair {
                    work: Some(name),
                    tool,
                },
                Kind::Tool => Enabled::Pair {
                    work,
                    tool: Some(name),
                },
            }
        };
        Ok(Choice {
            enabled,
            ..self.choice
        })
    }

    /// What would be in force with another centre of rotation.
    pub fn with_pivot(&self, pivot: [f64; 2]) -> Result<Choice, ErrorCode> {
        if matches!(self.choice.enabled, Enabled::Pair { .. }) {
            return Err(ErrorCode::PivotNotSettable);
        }
        Ok(Choice {
            pivot,
            ..self.choice
        })
    }

    /// The centre of rotation that `SPI` has set, as far as it counts.
    pub fn pivot(&self) -> [f64; 2] {
        match self.choice.enabled {
            Enabled::Pair { .. } => [0.0; 2],
            _ => self.choice.pivot,
        }
    }

    /// How targets are poses with these frames; [`ErrorCode::OutOfRange`] for a tool that is more than `most_arm_mm` from
    /// the platform centre, or a work frame out of any laboratory.
    pub fn view(&self, choice: &Choice, most_arm_mm: f64) -> Result<View, ErrorCode> {
        let pivot = Transform::to(choice.pivot);
        let view = match choice.enabled {
            Enabled::Zero => View {
                work: pivot,
                tool: pivot,
                zero: pivot.origin(),
            },
            Enabled::Alone(name) => {
                let work = self.total(name).then(&pivot);
                match self.find(name).map(|frame| frame.kind) {
                    Some(Kind::Here) => View {
                        work,
                        tool: pivot,
                        zero: pivot.origin(),
                    },
                    _ => View {
                        work,
                        tool: work,
                        zero: work.origin(),
                    },
                }
            }
            Enabled::Pair { work, tool } => {
                let total = |name: Option<FrameName>| {
                    name.map_or(Transform::IDENTITY, |name| self.total(name))
                };
                View {
                    work: total(work),
                    tool: total(tool),
                    zero: [0.0; 2],
                }
            }
        };
        let [x, y] = view.work.origin();
        if view.arm_mm() > most_arm_mm || libm::hypot(x, y) > FURTHEST_WORK_MM {
            return Err(ErrorCode::OutOfRange);
        }
        Ok(view)
    }
}

//! The one table of the supervisor: what every event does in every mode.

use crate::fault::Reaction;
use crate::mode::Mode;

/// A command, a fault, or the end of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Command: take theta and the turns from the encoders, and hold.
    Reference,
    /// Command: servo on.
    ServoOn,
    /// Command: servo off.
    ServoOff,
    /// Command: a plan.
    Move,
    /// Command: another centre of rotation.
    Centre,
    /// Command: other constants.
    Constants,
    /// Command: other constants, an encoder's mounting among them.
    Mounting,
    /// Command: an excitation.
    Excite,
    /// Command: end it.
    EndExcitation,
    /// Command: acknowledge the fault.
    Acknowledge,
    /// The motion, or the excitation, has come to its end.
    AtRest,
    /// A fault that is answered by a controlled stop.
    StopFault,
    /// A fault that is answered by braking.
    BrakeFault,
    /// A fault that is answered by letting go.
    CoastFault,
}

/// What comes of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// This state from now on, which may be the one there was.
    To(Mode),
    /// This state, if the stage is such that it can be had; else refused.
    If(Mode),
    /// A command is counted as refused, and nothing changes.
    Refused,
    /// Nothing: it does not matter in this state, or can not happen.
    Nothing,
}

/// All states, in the order of the table.
pub const MODES: [Mode; 6] = [
    Mode::Off,
    Mode::Holding,
    Mode::Moving,
    Mode::Stopping,
    Mode::Fault,
    Mode::Exciting,
];

/// All events with what they do in each of the [`MODES`].
#[rustfmt::skip]
pub const TRANSITIONS: [(Event, [Outcome; 6]); 14] = {
    use Event::{Acknowledge, AtRest, BrakeFault, Centre, CoastFault, Constants, EndExcitation, Excite, Mounting, Move, Reference, ServoOff, ServoOn, StopFault};
    use Mode::{Exciting, Fault, Holding, Moving, Off, Stopping};
    use Outcome::{If, Nothing, Refused, To};
    [
        //              off           holding      moving        stopping   fault      exciting
        (Reference,     [If(Holding),  To(Holding), To(Moving),   Refused,   Refused,   Refused]),
        (ServoOn,       [If(Holding),  To(Holding), To(Moving),   Refused,   Refused,   Refused]),
        (ServoOff,      [To(Off),      To(Off),     To(Off),      Refused,   Refused,   To(Off)]),
        (Move,          [Refused,      If(Moving),  If(Moving),   Refused,   Refused,   Refused]),
        (Centre,        [To(Off),      To(Holding), Refused,      Refused,   Refused,   Refused]),
        (Constants,     [To(Off),      To(Holding), Refused,      Refused,   To(Fault), Refused]),
        (Mounting,      [To(Off),      Refused,     Refused,      Refused,   To(Fault), Refused]),
        // With the servo on it is added to what the servo asks for.
        (Excite,        [If(Exciting), If(Holding), If(Moving),   Refused,   Refused,   Refused]),
        // It brakes before it lets go.
        (EndExcitation, [To(Off),      To(Holding), To(Moving),   Nothing,   Nothing,   To(Exciting)]),
        (Acknowledge,   [Nothing,      Nothing,     Nothing,      Refused,   If(Off),   Nothing]),
        (AtRest,        [Nothing,      Nothing,     To(Holding),  To(Fault), Nothing,   To(Off)]),
        (StopFault,     [To(Fault),    To(Fault),   To(Stopping), Nothing,   Nothing,   To(Fault)]),
        (BrakeFault,    [To(Fault),    To(Fault),   To(Fault),    To(Fault), Nothing,   To(Fault)]),
        // A bridge that does not drive does not matter.
        (CoastFault,    [Nothing,      To(Fault),   To(Fault),    To(Fault), Nothing,   To(Fault)]),
    ]
};

impl Event {
    /// A fault, by what is done about it.
    pub(super) const fn of(reaction: Reaction) -> Self {
        match reaction {
            Reaction::Stop => Self::StopFault,
            Reaction::Brake => Self::BrakeFault,
            Reaction::Coast => Self::CoastFault,
        }
    }
}

/// What `event` does in a state.
#[inline]
pub(super) fn outcome(mode: Mode, event: Event) -> Outcome {
    // With a name, by which the image's linker finds it: what the tick reads lies in RAM there.
    static TABLE: [(Event, [Outcome; 6]); 14] = TRANSITIONS;
    // Both enumerations are in the table's order, which the tests hold.
    TABLE
        .get(event as usize)
        .and_then(|(_, outcomes)| outcomes.get(mode.row()))
        .copied()
        .unwrap_or(Outcome::Nothing)
}

impl Mode {
    /// Its place in [`MODES`].
    const fn row(self) -> usize {
        match self {
            Self::Off => 0,
            Self::Holding => 1,
            Self::Moving => 2,
            Self::Stopping => 3,
            Self::Fault => 4,
            Self::Exciting => 5,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::control::supervisor::transitions::*;

    #[test]
    fn events_and_states_stand_where_they_are_looked_up() {
        for (row, (event, _)) in TRANSITIONS.iter().enumerate() {
            assert_eq!(*event as usize, row);
        }
        for (column, mode) in MODES.iter().enumerate() {
            assert_eq!(mode.row(), column);
        }
    }

    #[test]
    fn a_fault_is_left_by_its_acknowledgement_alone() {
        for (event, outcomes) in TRANSITIONS {
            let left = !matches!(
                outcomes[Mode::Fault.row()],
                Outcome::To(Mode::Fault) | Outcome::Refused | Outcome::Nothing
            );
            assert_eq!(left, event == Event::Acknowledge, "{event:?}");
        }
    }
}

//! The modes of the controller, as the tick, the queues, the recorder and the command side all name them.

/// State of the supervisor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Servo off: the motors coast.
    #[default]
    Off,
    /// Servo on, at rest.
    Holding,
    /// Servo on, a plan is being executed.
    Moving,
    /// A fault is latched, the motors are in the safe state.
    Fault,
    /// A fault is latched, the motion under way is being brought to rest under control.
    Stopping,
    /// Servo off, an excitation has the motors.
    Exciting,
}

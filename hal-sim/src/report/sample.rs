//! What a run records: one sample a tick, one entry a move.

/// The state of the stage at one tick of the controller, all of it at the instant of the encoders' latch.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sample {
    /// Simulated time, s.
    pub time_s: f64,
    /// Whether the setpoint is on its way: the statistics of the errors count only these ticks.
    pub moving: bool,
    /// Setpoint x and y in mm, theta in deg, multi-turn.
    pub setpoint: [f64; 3],
    /// Rate of the setpoint: mm/s, mm/s, deg/s.
    pub setpoint_rate: [f64; 3],
    /// The plant's true pose at the same instant: mm, mm, deg.
    pub pose: [f64; 3],
    /// Following error, what the encoders see: the pivots' measured minus setpoint, as a pose by the controller's geometry; um, um,
    /// urad.
    pub following_error: [f64; 3],
    /// True pose error, where the platform is: true pose minus setpoint; um, um, urad. Not taken from the two above, where the
    /// difference would drown in roundings.
    pub true_error: [f64; 3],
    /// Setpoints of the pivots on the track, deg, multi-turn.
    pub pivot_setpoint_deg: [f64; 3],
    /// Rates of the pivots' setpoints, rad/s.
    pub pivot_rate_rad_s: [f64; 3],
    /// How the setpoint of the moved point moves.
    pub motion: MotionSample,
    /// Measured minus setpoint at the pivots, in encoder LSB.
    pub pivot_error_lsb: [f64; 3],
    /// Duty of the three bridges, -1 to 1.
    pub duty: [f64; 3],
    /// What the pivots' feedback has collected, V; of each pivot as it was at most four ticks before, as all that follows.
    pub integral_v: [f64; 3],
    /// Their motors' currents by the controller's model, A.
    pub model_current_a: [f64; 3],
    /// What the servos have learnt of the rate besides the model's, V s/rad.
    pub learnt_rate_v_s_rad: [f64; 3],
    /// Of the torque, V/(N m).
    pub learnt_torque_v_n_m: [f64; 3],
    /// Of friction, V.
    pub learnt_friction_v: [f64; 3],
    /// Smallest angle between two neighbouring pivots, deg.
    pub separation_deg: f64,
}

/// What the limits of motion are about: rates of the setpoint of the point that is moved, and of the pivots' setpoints.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct MotionSample {
    /// Along the path: speed (mm/s), size of the acceleration (mm/s^2) and of the jerk (mm/s^3).
    pub translation: [f64; 3],
    /// Of theta: rate (deg/s), acceleration (deg/s^2), jerk (deg/s^3).
    pub rotation: [f64; 3],
    /// Of the pivots, rad/s^2.
    pub pivots_rad_s2: [f64; 3],
}

/// Length of an error's x and y.
pub(super) fn xy(error: &[f64; 3]) -> f64 {
    error[0].hypot(error[1])
}

/// One move from rest to rest.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Move {
    /// When the setpoint started, s.
    pub start_s: f64,
    /// When the setpoint arrived, s.
    pub profile_end_s: f64,
    /// When the stage came to stay within the settling window, s; `None` if it had not before the next move or the end.
    pub settled_s: Option<f64>,
    /// Where to: x and y in mm, theta in deg.
    pub target: [f64; 3],
}

impl Move {
    /// Duration of the profile, s.
    pub fn profile_s(&self) -> f64 {
        self.profile_end_s - self.start_s
    }

    /// From the end of the profile until settled, s; zero for a stage that never left the window.
    pub fn settle_s(&self) -> Option<f64> {
        self.settled_s
            .map(|settled_s| (settled_s - self.profile_end_s).max(0.0))
    }
}

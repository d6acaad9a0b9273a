//! What a servo learns of its drive.

/// Signals of the setpoint that feedforward learns the weight of: rate, torque, friction.
pub(super) const FEATURES: usize = 3;

/// What a servo has learnt: what the model of its drive has wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Learnt {
    /// Weights of the signals of feedforward besides the model's: V s/rad for the rate, V/(N m) for the torque, V for friction.
    pub weights: [f32; FEATURES],
    /// What the motor constant at the ring is more than the model has it, by the measured current, V s/rad.
    pub motor_constant_excess: f32,
}

impl Learnt {
    /// From what the parameters keep of a pivot.
    pub fn new(kept: &crate::parameters::Learnt) -> Self {
        Self {
            weights: [kept.rate_v_s_rad, kept.torque_v_n_m, kept.friction_v].map(|v| v as f32),
            motor_constant_excess: kept.motor_constant_v_s_rad as f32,
        }
    }

    /// As the parameters keep it.
    pub fn to_keep(&self) -> crate::parameters::Learnt {
        let [rate_v_s_rad, torque_v_n_m, friction_v] = self.weights.map(f64::from);
        crate::parameters::Learnt {
            rate_v_s_rad,
            torque_v_n_m,
            friction_v,
            motor_constant_v_s_rad: f64::from(self.motor_constant_excess),
        }
    }
}

//! A controller that is told of the machine before it.

use crate::machine::devices::StageParameters;
use firmware::parameters::Parameters;

/// The controller's parameters with the drives and the platform as they are on this machine, and gains that fit its motors. Payload
/// and everything else stay what the controller takes them for.
#[must_use]
pub fn with_drives_told(parameters: &Parameters, stage: &StageParameters) -> Parameters {
    let mut told = parameters.clone();
    let plant = &stage.plant;
    for (drive, gains) in told.drives.iter_mut().zip(&mut told.servo.gains) {
        let weaker = drive.torque_constant_n_m_a / plant.torque_constant_n_m_a;
        gains.velocity_v_s_rad *= weaker;
        gains.integral_v_rad *= weaker;
        drive.torque_constant_n_m_a = plant.torque_constant_n_m_a;
        drive.inertia_kg_m2 = plant.ring_inertia_kg_m2 + plant.motor_inertia_kg_m2;
        drive.viscous_n_m_s = plant.ring_friction.viscous;
        drive.coulomb_n_m = plant.ring_friction.coulomb;
    }
    told.platform.mass_kg = plant.platform_mass_kg;
    told.platform.inertia_kg_m2 = plant.platform_inertia_kg_m2;
    told
}

//! A machine as the mathematics of its loops has it.

use commissioning::chain::{Chain, Load};
use commissioning::drive_model::Electrical;
use hal_sim::machine::devices::StageParameters;

/// From the simulator's own numbers; windings are cold.
pub fn model(stage: &StageParameters) -> (Chain, [Electrical; 3]) {
    let plant = &stage.plant;
    let payload = &plant.payload;
    let square = plant.track_radius_m * plant.track_radius_m;
    let moment = payload.mass_kg * payload.eccentricity_m * plant.track_radius_m;
    let (sin, cos) = payload.direction_rad.sin_cos();
    // Rigid guides: as stiff as makes no difference.
    let guide = if plant.imperfections.guide_compliance {
        1.0
    } else {
        1e3
    };
    let chain = Chain {
        motor_inertia: plant.motor_inertia_kg_m2,
        ring_inertia: plant.ring_inertia_kg_m2,
        stiffness: plant.transmission_stiffness_n_m_rad,
        damping: plant.transmission_damping_n_m_s_rad,
        viscous: plant.ring_friction.viscous,
        guide_stiffness: guide * square * plant.guide_stiffness_n_m,
        guide_damping: square * plant.guide_damping_n_s_m,
        along_stiffness: 0.0,
        along_damping: 0.0,
        load: Load {
            mass: square * (plant.platform_mass_kg + payload.mass_kg),
            inertia: plant.platform_inertia_kg_m2
                + payload.inertia_kg_m2
                + payload.mass_kg * payload.eccentricity_m.powi(2),
            moment: [moment * cos, moment * sin],
        },
    };
    let electrical = Electrical {
        resistance_ohm: plant.resistance_ohm,
        inductance_h: plant.inductance_h,
        motor_constant: plant.ring_torque_constant_n_m_a(),
        dead_time_v: 0.0,
        deviations: [0.0; 4],
    };
    (chain, [electrical; 3])
}

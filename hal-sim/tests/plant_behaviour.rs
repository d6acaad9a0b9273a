//! What the machine does as a machine: friction holds and slips, motors reach their speeds and currents, guides end.

use hal_sim::machine::plant::{
    AXES, Broken, Drive, External, Imperfections, Plant, PlantParameters,
};

const STEP_S: f64 = 12.5e-6;

fn run(plant: &mut Plant, seconds: f64, drives: &[Drive; AXES]) {
    for _ in 0..(seconds / STEP_S).round() as u64 {
        plant.step(STEP_S, drives);
    }
}

fn with(imperfections: Imperfections) -> Plant {
    Plant::new(PlantParameters {
        imperfections,
        ..PlantParameters::REFERENCE
    })
}

/// A plant with open windings under a torque that rises to its value in a second and stays for half of one.
fn twisted_by(torque_n_m: f64) -> Plant {
    let mut plant = with(Imperfections {
        dry_friction: true,
        ..Imperfections::NONE
    });
    for millis in 1..=1500 {
        let risen = f64::from(millis.min(1000)) / 1000.0;
        plant.set_external(External {
            torque_n_m: torque_n_m * risen,
            ..External::default()
        });
        run(&mut plant, 1e-3, &[Drive::Coast; AXES]);
    }
    plant
}

#[test]
fn static_friction_holds_a_small_torque() {
    // In the centre three rings of 0.12 N m each hold the platform together.
    let plant = twisted_by(0.2);
    let theta_rad = plant.pose()[2];
    // The bristles give way: -120 urad ln(1 - 0.2/0.36), the integral of z' = v (1 - z / z_ss),
    // and a little more because the end of the rise overshoots.
    assert!((97e-6..103e-6).contains(&theta_rad), "{theta_rad}");
    assert!(plant.velocity()[2].abs() < 1.5e-8, "{:?}", plant.velocity());
}

#[test]
fn static_friction_slips_over_it() {
    let theta_rad = twisted_by(0.4).pose()[2];
    assert!(theta_rad > 0.195, "{theta_rad}");
}

#[test]
fn bristles_spring_back_in_part_when_the_torque_goes() {
    let mut plant = twisted_by(0.2);
    for millis in (0..1000).rev() {
        let left = f64::from(millis) / 1000.0;
        plant.set_external(External {
            torque_n_m: 0.2 * left,
            ..External::default()
        });
        run(&mut plant, 1e-3, &[Drive::Coast; AXES]);
    }
    // Presliding has hysteresis: the way back is only 120 urad ln(1 + 0.2/0.36) = 53 urad.
    let theta_rad = plant.pose()[2];
    assert!((44e-6..50e-6).contains(&theta_rad), "{theta_rad}");
}

#[test]
fn motors_reach_the_speed_of_their_voltage() {
    let mut plant = with(Imperfections {
        torque_ripple: false,
        ..Imperfections::CALIBRATED
    });
    run(&mut plant, 1.0, &[Drive::Voltage(12.0); AXES]);
    // 12 V = R i + K w and K i = Tc + b w, with K = 3 N m/A seen at the ring.
    let (resistance_ohm, constant, coulomb_n_m, viscous) = (2.1, 3.0, 0.1, 0.05);
    let rate_rad_s = (12.0 - resistance_ohm * coulomb_n_m / constant)
        / (constant + resistance_ohm * viscous / constant);
    let current_a = (coulomb_n_m + viscous * rate_rad_s) / constant;
    for i in 0..AXES {
        assert!((plant.pivot_rates_rad_s()[i] / rate_rad_s - 1.0).abs() < 2.2e-9);
        assert!((plant.currents_a()[i] / current_a - 1.0).abs() < 1.2e-7);
    }
    assert!(
        plant.pose()[2] > 3.5 && plant.pose()[0].abs() < 1e-12,
        "{:?}",
        plant.pose()
    );
}

#[test]
fn supply_limits_the_voltage() {
    let mut plant = with(Imperfections::NONE);
    run(&mut plant, 1.0, &[Drive::Voltage(1e6); AXES]);
    assert!(
        (plant.velocity()[2] / 16.0 - 1.0).abs() < 2e-12,
        "{:?}",
        plant.velocity()
    );
}

#[test]
fn stalled_motors_draw_voltage_over_resistance() {
    let mut plant = Plant::new(PlantParameters {
        platform_mass_kg: 1e6,
        platform_inertia_kg_m2: 1e6,
        imperfections: Imperfections::NONE,
        ..PlantParameters::REFERENCE
    });
    run(&mut plant, 0.05, &[Drive::Voltage(21.0); AXES]);
    for current_a in plant.currents_a() {
        assert!((current_a - 10.0).abs() < 1.7e-5, "{current_a}");
    }
}

#[test]
fn brake_stops_the_stage_and_coast_lets_it_run() {
    let spin_after = |drive| {
        let mut plant = with(Imperfections::NONE);
        plant.set_velocity([0.0, 0.0, 5.0]);
        run(&mut plant, 0.1, &[drive; AXES]);
        plant.velocity()[2]
    };
    assert!(spin_after(Drive::Brake).abs() < 2.4e-7);
    assert!((spin_after(Drive::Coast) - 5.0).abs() < 1.9e-11);
}

#[test]
fn coasting_current_dies_through_the_diodes() {
    let mut plant = with(Imperfections::NONE);
    run(&mut plant, 1e-3, &[Drive::Voltage(20.0); AXES]);
    assert!(plant.currents_a()[0] > 7.6);
    run(&mut plant, 1e-3, &[Drive::Coast; AXES]);
    assert_eq!(plant.currents_a(), [0.0; AXES]);
}

#[test]
fn backlash_lets_the_motor_turn_before_the_ring() {
    let mut plant = Plant::new(PlantParameters {
        backlash_rad: 1e-3,
        imperfections: Imperfections {
            torque_ripple: false,
            ..Imperfections::CALIBRATED
        },
        ..PlantParameters::REFERENCE
    });
    plant.set_pose_at_rest([0.0; 3]);
    let start = plant.motors_rad()[0];
    while plant.motors_rad()[0] - start < 0.49e-3 {
        run(&mut plant, STEP_S, &[Drive::Voltage(1.0); AXES]);
    }
    assert_eq!(plant.pose()[2], 0.0);
    run(&mut plant, 0.1, &[Drive::Voltage(1.0); AXES]);
    assert!(plant.pose()[2] > 0.026);
}

#[test]
fn torque_ripple_disturbs_a_steady_rotation() {
    // In the rotation itself the three ripples cancel, 120 deg of their period apart. They show as a sway: 1.5 times 0.03 N m at
    // 0.1 m are 0.45 N, at 650 rad/s (1,300 periods in a turn, at 0.5 rad/s) against 6 kg and the currents that the motors' voltage
    // drives: 0.118 mm/s, and 2 % more by the transmission, of whose resonance they are an eighth.
    let sway = |torque_ripple| {
        let mut plant = with(Imperfections {
            torque_ripple,
            ..Imperfections::NONE
        });
        run(&mut plant, 0.2, &[Drive::Voltage(1.5); AXES]);
        let mut fastest_m_s = 0.0_f64;
        for _ in 0..200 {
            run(&mut plant, 1e-4, &[Drive::Voltage(1.5); AXES]);
            fastest_m_s = fastest_m_s.max(plant.velocity()[0].abs());
        }
        let spin_rad_s = plant.velocity()[2];
        assert!((spin_rad_s - 0.5).abs() < 3.8e-5, "{spin_rad_s}");
        fastest_m_s
    };
    let (without_m_s, with_m_s) = (sway(false), sway(true));
    println!("sway: {without_m_s:e} m/s without ripple, {with_m_s:e} m/s with");
    assert!(without_m_s < 1e-12);
    assert!((1.19e-4..1.22e-4).contains(&with_m_s));
}

#[test]
fn guides_end_without_breaking_the_stage() {
    let mut plant = with(Imperfections::ALL);
    // Guide 2 points along y: force the platform out there at full voltage, and let it turn all the while.
    plant.set_external(External {
        force_n: [0.0, 200.0],
        torque_n_m: 1.0,
        ..External::default()
    });
    let mut farthest_m = 0.0_f64;
    for _ in 0..2000 {
        run(
            &mut plant,
            1e-3,
            &[Drive::Voltage(48.0), Drive::Voltage(-48.0), Drive::Brake],
        );
        farthest_m = farthest_m.max(plant.pose()[0].hypot(plant.pose()[1]));
        assert_eq!(plant.broken(), None);
    }
    assert!((0.08..0.096).contains(&farthest_m), "{farthest_m}");
}

#[test]
fn a_torn_out_platform_is_reported_and_mended() {
    // A tooth would break first.
    let mut plant = with(Imperfections {
        tooth_limit: false,
        ..Imperfections::ALL
    });
    plant.set_external(External {
        force_n: [1e9, 0.0],
        ..External::default()
    });
    run(&mut plant, 1e-2, &[Drive::Brake; AXES]);
    assert!(
        matches!(plant.broken(), Some(Broken::Unreachable { .. })),
        "{:?}",
        plant.broken()
    );
    assert!(plant.pose().iter().all(|coordinate| coordinate.is_finite()));
    plant.set_external(External::default());
    plant.set_pose_at_rest([0.01, 0.0, 0.0]);
    assert_eq!(plant.broken(), None);
    run(&mut plant, 1e-2, &[Drive::Brake; AXES]);
    assert_eq!(plant.broken(), None);
}

#[test]
fn an_impossible_pose_or_voltage_is_reported() {
    let mut plant = with(Imperfections::ALL);
    plant.set_pose_at_rest([0.2, 0.0, 0.0]);
    assert!(matches!(plant.broken(), Some(Broken::Unreachable { .. })));
    plant.set_pose_at_rest([0.0; 3]);
    plant.step(
        STEP_S,
        &[Drive::Voltage(f64::NAN), Drive::Brake, Drive::Brake],
    );
    assert_eq!(plant.broken(), Some(Broken::NotFinite));
    assert_eq!(plant.pose(), [0.0; 3]);
}

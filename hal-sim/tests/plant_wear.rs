//! What wears or comes loose: weaker motors, more friction, couplings with play, carriages that jam and carriages that meet.

use hal_sim::machine::plant::{
    AXES, CARRIAGE_RAD, Drive, External, Imperfections, Plant, PlantParameters,
};

const STEP_S: f64 = 12.5e-6;

fn ideal() -> Plant {
    Plant::new(PlantParameters {
        imperfections: Imperfections::NONE,
        ..PlantParameters::REFERENCE
    })
}

fn worn(external: External) -> Plant {
    let mut plant = ideal();
    plant.set_external(external);
    plant
}

fn run(plant: &mut Plant, seconds: f64, drive: Drive) {
    for _ in 0..(seconds / STEP_S).round() as u64 {
        plant.step(STEP_S, &[drive; AXES]);
    }
}

/// At no load a motor turns so fast that its back-EMF is the voltage: half of the magnet, twice the speed.
#[test]
fn a_motor_that_has_lost_its_magnet_turns_faster() {
    for (lost, rate_rad_s) in [(0.0, 2.0), (0.5, 4.0)] {
        let mut plant = worn(External {
            lost_torque: [lost; AXES],
            ..External::default()
        });
        run(&mut plant, 0.5, Drive::Voltage(6.0));
        let [_, _, turning] = plant.velocity();
        assert!((turning - rate_rad_s).abs() < 0.01, "{turning}");
    }
}

/// Three rings that rub by 2 N m more stop the turning stage: 0.08 kg m^2 from 3 rad/s in 60 mrad.
#[test]
fn more_friction_takes_the_energy() {
    let mut plant = worn(External {
        more_friction_n_m: [2.0; AXES],
        ..External::default()
    });
    plant.set_velocity([0.0, 0.0, 3.0]);
    run(&mut plant, 0.1, Drive::Coast);
    let [_, _, turned] = plant.pose();
    assert!((turned / 0.060 - 1.0).abs() < 0.03, "{turned}");
}

#[test]
fn a_loose_coupling_lets_the_motor_run_ahead() {
    let loose_rad = 1e-3;
    let mut plant = worn(External {
        loose_rad: [loose_rad; AXES],
        more_friction_n_m: [0.5; AXES],
        ..External::default()
    });
    run(&mut plant, 0.2, Drive::Voltage(3.0));
    for (motor, ring) in plant.motors_rad().into_iter().zip(plant.pivots_rad()) {
        assert!((motor - ring - loose_rad).abs() < 1e-5, "{}", motor - ring);
    }
}

/// 100 N on a platform that one guide holds by 1e6 N/m, along x as far as that guide lies in x.
#[test]
fn a_jammed_carriage_holds_the_platform() {
    let push = |guide_jammed_at_m| {
        let mut plant = worn(External {
            force_n: [0.0, 100.0],
            guide_jammed_at_m,
            ..External::default()
        });
        run(&mut plant, 0.02, Drive::Brake);
        plant.pose()[1]
    };
    let at_m = ideal().rhos_m()[1];
    let (free_m, held_m) = (push([None; AXES]), push([None, Some(at_m), None]));
    assert!(
        held_m < 0.2e-3 && free_m > 5.0 * held_m,
        "{free_m} {held_m}"
    );
}

/// Carriages that are driven against each other stop at their bumpers, and the energy of the blow is told. The guides are longer than
/// they are, or their ends would come first.
#[test]
fn carriages_meet_with_the_energy_that_they_have() {
    let mut plant = Plant::new(PlantParameters {
        imperfections: Imperfections::NONE,
        guide_range_m: [2e-3, 0.3],
        ..PlantParameters::REFERENCE
    });
    // Where two carriages are as close as they come 87 mm out; towards each other.
    let mut closest_at = |turn: f64| {
        plant.set_pose_at_rest([0.087, 0.0, turn]);
        closest_rad(&plant)
    };
    let turns = (0..360).map(|degrees| f64::from(degrees).to_radians());
    let turn = turns.min_by(|a, b| closest_at(*a).total_cmp(&closest_at(*b)));
    let turn = turn.expect("there are 360");
    assert!(closest_at(turn) > CARRIAGE_RAD, "they do not touch yet");
    let velocities = [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, -0.2, 0.0]];
    let closing = |velocity: &[f64; 3]| {
        let mut plant = plant.clone();
        plant.set_velocity(*velocity);
        let carriages = &plant.contacts()[6..];
        (carriages.iter())
            .map(|it| it.closing_m_s)
            .fold(0.0, f64::max)
    };
    let fastest = (velocities.into_iter()).max_by(|a, b| closing(a).total_cmp(&closing(b)));
    plant.set_velocity(fastest.expect("three of them"));
    let moving_j = plant.kinetic_energy_j();
    let (mut blow_j, mut closest) = (0.0_f64, f64::MAX);
    for _ in 0..4_000 {
        plant.step(STEP_S, &[Drive::Coast; AXES]);
        let carriages = &plant.contacts()[6..];
        if blow_j == 0.0 && carriages.iter().any(|it| it.pressed_m > 0.0) {
            blow_j = carriages.iter().map(|it| it.energy_j).fold(0.0, f64::max);
        }
        closest = closest.min(closest_rad(&plant));
    }
    assert!(
        blow_j > 0.0 && blow_j <= 1.01 * moving_j,
        "{turn}: {blow_j} of {moving_j} J"
    );
    assert!(closest > CARRIAGE_RAD - 0.05, "{closest}");
}

fn closest_rad(plant: &Plant) -> f64 {
    let rings = plant.pivots_rad();
    (0..AXES)
        .map(|i| (rings[(i + 1) % AXES] - rings[i]).rem_euclid(std::f64::consts::TAU))
        .fold(f64::MAX, f64::min)
}

//! A machine as a workshop would build it: every number drawn by the sizes that such machines have, from a seed.

use core::f64::consts::TAU;

use super::devices::{AnalogParameters, COUNTS_PER_TURN, EncoderParameters, StageParameters};
use super::instruments::workshop::{encoder_of, pivot_of};
use super::plant::{AXES, FrictionParameters, Imperfections, Payload};
use crate::random::Random;

/// How far inertias, friction and motors are off the reference stage, over themselves.
const OFF: f64 = 0.35;
/// Resonance of the reference stage's transmission, Hz, and what others have.
const REFERENCE_RESONANCE_HZ: f64 = 1500.0;
const RESONANCE_HZ: [f64; 2] = [600.0, 2000.0];

/// The machine of a seed, with everything that a machine can have but what commissioning does not know yet, and wires and zeros as they came.
#[must_use]
pub fn unknown(seed: u64) -> StageParameters {
    let mut random = Random::new(seed);
    let mut machine = StageParameters::REFERENCE;
    draw_drives(&mut machine, &mut random);
    draw_guides(&mut machine, &mut random);
    draw_load(&mut machine, &mut random);
    for pivot in &mut machine.plant.pivots {
        *pivot = pivot_of(&mut random);
    }
    for encoder in &mut machine.encoders {
        *encoder = self::encoder(&mut random);
    }
    draw_surroundings(&mut machine, &mut random);
    machine.wiring.bridge_of_ring = order(&mut random);
    machine.wiring.port_of_ring = order(&mut random);
    machine.wiring.leads_exchanged = [(); AXES].map(|()| random.once_in(2));
    draw_losses(&mut machine, &mut random);
    machine.plant.imperfections = Imperfections {
        // Commissioning knows none of them yet, and would find windings, motors, friction and encoders off by them.
        current_ripple: false,
        gear_losses: false,
        track_heat: false,
        ..Imperfections::ALL
    };
    machine
}

fn draw_drives(machine: &mut StageParameters, random: &mut Random) {
    let plant = &mut machine.plant;
    let mut share = || random.between(1.0 - OFF, 1.0 + OFF);
    plant.ring_inertia_kg_m2 *= share();
    plant.motor_inertia_kg_m2 *= share();
    plant.torque_constant_n_m_a *= share();
    plant.resistance_ohm *= share();
    plant.inductance_h *= share();
    plant.ring_friction.coulomb *= share();
    plant.ring_friction.viscous *= share();
    plant.ripple_n_m *= share();
    let resonance = random.between(RESONANCE_HZ[0], RESONANCE_HZ[1]) / REFERENCE_RESONANCE_HZ;
    plant.transmission_stiffness_n_m_rad *= resonance * resonance;
    // The same share of critical damping.
    plant.transmission_damping_n_m_s_rad *= resonance;
    plant.backlash_rad = random.between(0.0, 2e-6);
    plant.gear.cyclic_error_rad = random.between(50e-6, 300e-6);
    plant.gear.cyclic_phase_rad = phases(random);
    plant.gear.preload_n_m = random.between(9.0, 16.0);
    plant.motor_friction.coulomb = random.between(0.15, 0.3);
    plant.commutation_ripple = random.between(0.01, 0.03);
    plant.winding.start_k = random.between(0.0, 60.0);
}

fn draw_guides(machine: &mut StageParameters, random: &mut Random) {
    let plant = &mut machine.plant;
    let share = random.between(10e6, 50e6) / plant.guide_stiffness_n_m;
    plant.guide_stiffness_n_m *= share;
    plant.guide_damping_n_s_m *= share.sqrt();
    plant.guide_friction = FrictionParameters {
        coulomb: random.between(0.5, 3.0),
        ..plant.guide_friction
    };
}

fn draw_load(machine: &mut StageParameters, random: &mut Random) {
    let plant = &mut machine.plant;
    plant.platform_mass_kg *= random.between(1.0 - OFF, 1.0 + OFF);
    plant.platform_inertia_kg_m2 *= random.between(1.0 - OFF, 1.0 + OFF);
    let mass_kg = random.between(0.0, 5.0);
    plant.payload = Payload {
        mass_kg,
        // A cylinder of 50 mm radius.
        inertia_kg_m2: mass_kg * 0.05 * 0.05 / 2.0,
        eccentricity_m: random.between(0.0, 0.02),
        direction_rad: random.between(0.0, TAU),
    };
}

fn encoder(random: &mut Random) -> EncoderParameters {
    let [[cosine_rad, sine_rad], harmonics_rad @ ..] = encoder_of(random).harmonics_rad;
    EncoderParameters {
        zero_counts: random.below(COUNTS_PER_TURN),
        reversed: random.once_in(2),
        noise_rad: random.between(30e-9, 200e-9),
        // A cos psi + B sin psi as a sine that is zero and rising at its phase.
        eccentricity_rad: cosine_rad.hypot(sine_rad),
        eccentricity_phase_rad: (-cosine_rad).atan2(sine_rad),
        harmonics_rad,
        subdivisional_error_rad: random.between(0.2e-6, 0.8e-6),
        ..EncoderParameters::REFERENCE
    }
}

fn draw_surroundings(machine: &mut StageParameters, random: &mut Random) {
    let plant = &mut machine.plant;
    plant.ball_runout_m = random.between(20e-9, 100e-9);
    plant.ball_phase_rad = phases(random);
    plant.cable_stiffness_n_m = random.between(1.2, 12.0);
    plant.floor_acceleration_m_s2 = random.between(0.02e-3, 0.1e-3);
    draw_sensors(&mut machine.analog, random);
}

/// Offsets and gains of the sensors of current and supply, within what they are good for.
pub(crate) fn draw_sensors(analog: &mut AnalogParameters, random: &mut Random) {
    analog.current_offset_counts = [(); AXES].map(|()| 2.0 * random.normal());
    analog.current_gain = [(); AXES].map(|()| 1.0 + 5e-3 * random.normal());
    analog.supply_gain = 1.0 + 5e-3 * random.normal();
}

/// What came later, drawn last: a seed keeps all other numbers that it had.
fn draw_losses(machine: &mut StageParameters, random: &mut Random) {
    let plant = &mut machine.plant;
    plant.gear.efficiency = random.between(0.88, 0.95);
    plant.track.start_k = random.between(-3.0, 3.0);
    let heat = &mut machine.bridge.heat;
    heat.thermal_resistance_k_w *= random.between(0.7, 1.3);
    heat.air_c = random.between(20.0, 50.0);
    machine.bus.ripple_v = random.between(0.02, 0.15);
    machine.bus.ripple_hz = if random.once_in(2) { 100.0 } else { 120.0 };
}

fn phases(random: &mut Random) -> [f64; AXES] {
    [(); AXES].map(|()| random.between(0.0, TAU))
}

/// 0, 1 and 2 in any order.
fn order(random: &mut Random) -> [u8; AXES] {
    let mut order = [0, 1, 2];
    order.swap(2, random.index(3));
    order.swap(1, random.index(2));
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::file::{from_text, to_text};

    #[test]
    fn a_seed_is_a_machine_that_a_file_can_hold() {
        let mut orders = std::collections::BTreeSet::new();
        for seed in 0..500 {
            let machine = unknown(seed);
            assert_eq!(machine, unknown(seed));
            assert_ne!(machine, unknown(seed + 1));
            // Whatever is drawn is inside the range of what a machine may have, and survives the file to the bit.
            assert_eq!(
                from_text(&to_text(&machine), &[]),
                Ok(machine),
                "seed {seed}"
            );
            orders.insert((machine.wiring.bridge_of_ring, machine.wiring.port_of_ring));
        }
        // Of 36 ways to plug in.
        assert_eq!(orders.len(), 36);
    }

    /// What is drawn later comes last: other machines of a seed would be other results of everything that names one.
    #[test]
    fn a_seed_keeps_the_machine_that_it_had() {
        let machine = unknown(7);
        assert_eq!(machine.plant.platform_mass_kg, 3.366_590_115_242_271_3);
        assert_eq!(machine.analog.supply_gain, 0.995_429_633_390_001_1);
        assert_eq!(machine.wiring.port_of_ring, [1, 2, 0]);
        assert_eq!(machine.wiring.leads_exchanged, [false, true, true]);
    }

    /// The mean and the spread of what is drawn, over a thousand machines.
    #[test]
    fn sizes_are_those_of_a_workshop() {
        let machines: Vec<_> = (0..1000).map(unknown).collect();
        let spread = |value: fn(&StageParameters) -> f64| {
            let mean = machines.iter().map(value).sum::<f64>() / 1e3;
            let square = machines.iter().map(|m| value(m).powi(2)).sum::<f64>() / 1e3;
            (mean, (square - mean * mean).sqrt())
        };
        let (mean, deviation) = spread(|m| m.plant.pivots[1].guide_error_rad);
        assert!(mean.abs() < 0.2e-3 && (deviation / 2e-3 - 1.0).abs() < 0.08);
        let (mean, deviation) = spread(|m| m.plant.torque_constant_n_m_a / 0.06);
        assert!(
            (mean - 1.0).abs() < 0.03 && (deviation / (OFF / 3.0_f64.sqrt()) - 1.0).abs() < 0.08
        );
        let (mean, _) = spread(|m| m.plant.guide_stiffness_n_m);
        assert!((mean / 30e6 - 1.0).abs() < 0.05);
        let (mean, deviation) = spread(|m| m.plant.gear.efficiency);
        assert!(
            (mean - 0.915).abs() < 2e-3
                && (deviation / (0.035 / 3.0_f64.sqrt()) - 1.0).abs() < 0.08
        );
        let reversed = machines.iter().filter(|m| m.encoders[2].reversed).count();
        assert!((430..570).contains(&reversed), "{reversed}");
    }
}

//! One ring drive: bridge terminals, winding, motor side of the transmission, spring.

use super::parameters::PlantParameters;
use super::pivot_geometry::AXES;
use kinematics::Scalar;

/// What the bridge does to the motor terminals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Average bridge voltage, V. More than the supply is cut to it.
    Voltage(f64),
    /// Terminals shorted through the two low sides.
    Brake,
    /// All switches open: the current dies through the diodes against the supply, then the motor turns freely.
    Coast,
}

/// Strain of a flank at which its damper has reached half of its size, rad: 1 nm on the track, what a contact is rough.
const CONTACT_STRAIN_RAD: f64 = 10e-9;

/// Precomputed constants of one drive, everything seen at the ring.
#[derive(Clone, Copy, Debug)]
pub struct DriveModel {
    torque_constant_n_m_a: f64,
    /// Amplitude of the torque constant's ripple over itself.
    commutation_ripple: f64,
    inverse_inductance_1_h: f64,
    supply_v: f64,
    inverse_inertia_1_kg_m2: f64,
    stiffness_n_m_rad: f64,
    damping_n_m_s_rad: f64,
    half_backlash_rad: f64,
    /// Strain at which the preload opens, and how far it then gives way.
    preload_strain_rad: f64,
    preload_way_rad: f64,
    cyclic_error_rad: f64,
    cyclic_phase_rad: [f64; AXES],
    /// Coulomb friction in the gear over the torque that it transmits.
    lost_share: f64,
    gear_ratio: f64,
    ripple_n_m: f64,
    ripple_periods_per_rad: f64,
}

/// Cyclic error of a gear where its motor stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CyclicError {
    /// By how much the motor is ahead of the ring while nothing strains the transmission, rad.
    pub angle_rad: f64,
    /// Its derivative by the motor's angle.
    pub slope: f64,
}

impl DriveModel {
    /// Takes the constants, with the switched-off effects at zero.
    #[must_use]
    pub fn new(parameters: &PlantParameters) -> Self {
        let flags = parameters.imperfections;
        let gate = |flag: bool, value: f64| if flag { value } else { 0.0 };
        // Without compliance: four times the resonance, at the same fraction of critical damping.
        let (stiffer, more_damped) = if flags.compliance {
            (1.0, 1.0)
        } else {
            (16.0, 4.0)
        };
        let gear = &parameters.gear;
        let stiffness_n_m_rad = parameters.transmission_stiffness_n_m_rad * stiffer;
        Self {
            torque_constant_n_m_a: parameters.ring_torque_constant_n_m_a(),
            commutation_ripple: gate(flags.commutation_ripple, parameters.commutation_ripple),
            inverse_inductance_1_h: 1.0 / parameters.inductance_h,
            supply_v: parameters.supply_v,
            inverse_inertia_1_kg_m2: 1.0 / parameters.motor_inertia_kg_m2,
            stiffness_n_m_rad,
            damping_n_m_s_rad: parameters.transmission_damping_n_m_s_rad * more_damped,
            half_backlash_rad: gate(flags.backlash, 0.5 * parameters.backlash_rad),
            preload_strain_rad: if flags.preload {
                gear.preload_n_m / stiffness_n_m_rad
            } else {
                f64::INFINITY
            },
            preload_way_rad: gear.preload_way_rad,
            cyclic_error_rad: gate(flags.gear_error, gear.cyclic_error_rad),
            cyclic_phase_rad: gear.cyclic_phase_rad,
            lost_share: gate(flags.gear_losses, 1.0 - gear.efficiency),
            gear_ratio: parameters.gear_ratio,
            ripple_n_m: gate(flags.torque_ripple, parameters.ripple_n_m),
            ripple_periods_per_rad: parameters.ripple_periods_per_motor_turn
                * parameters.gear_ratio
                / core::f64::consts::TAU,
        }
    }

    /// Changes the supply, V.
    pub const fn set_supply_v(&mut self, supply_v: f64) {
        self.supply_v = supply_v;
    }

    /// Torque for each ampere, N m/A, and back-EMF for each rad/s, V s/rad, where the motor stands. Both ripple alike: what
    /// the current gives is what the motion takes.
    #[must_use]
    pub fn torque_constant(&self, angle_rad: f64) -> f64 {
        if self.commutation_ripple == 0.0 {
            return self.torque_constant_n_m_a;
        }
        let ripple = sine_of_turns(angle_rad * self.ripple_periods_per_rad);
        self.torque_constant_n_m_a * (1.0 + self.commutation_ripple * ripple)
    }

    /// Cyclic error of the gear of drive `i` with its motor at an angle, rad.
    #[must_use]
    pub fn cyclic_error(&self, i: usize, motor_rad: f64) -> CyclicError {
        if self.cyclic_error_rad == 0.0 {
            return CyclicError::default();
        }
        let (sin, cos) =
            <f64 as Scalar>::sin_cos(self.gear_ratio * motor_rad + self.cyclic_phase_rad[i]);
        CyclicError {
            angle_rad: self.cyclic_error_rad * sin,
            slope: self.cyclic_error_rad * self.gear_ratio * cos,
        }
    }

    /// Voltage at the motor's terminals over a step that begins with this current and back-EMF, V; none while all switches are open and
    /// nothing flows. It is the same over all of the step: a current that dies in the diodes has not reversed at its end.
    #[must_use]
    pub fn terminal_v(&self, drive: Drive, current_a: f64, back_emf_v: f64) -> Option<f64> {
        match drive {
            Drive::Voltage(volts) => Some(volts.clamp(-self.supply_v, self.supply_v)),
            Drive::Brake => Some(0.0),
            Drive::Coast if current_a != 0.0 => Some(-self.supply_v.copysign(current_a)),
            // The diodes conduct only what drives more than the supply, and against it.
            Drive::Coast => {
                (back_emf_v.abs() > self.supply_v).then(|| self.supply_v.copysign(back_emf_v))
            }
        }
    }

    /// Time derivative of the current, A/s, with the back-EMF and the resistance that the winding has.
    #[must_use]
    pub fn current_rate(
        &self,
        terminal_v: Option<f64>,
        current_a: f64,
        back_emf_v: f64,
        resistance_ohm: f64,
    ) -> f64 {
        terminal_v.map_or(0.0, |volts| {
            (volts - resistance_ohm * current_a - back_emf_v) * self.inverse_inductance_1_h
        })
    }

    /// The current at the end of a step in which it went from `before_a` to `after_a`: diodes block its reversal.
    #[must_use]
    pub fn settle_current(&self, drive: Drive, before_a: f64, after_a: f64) -> f64 {
        if drive == Drive::Coast && before_a * after_a < 0.0 {
            0.0
        } else {
            after_a
        }
    }

    /// Torque of a motor, N m, at an angle and with a torque constant.
    #[must_use]
    pub fn motor_torque(&self, torque_constant_n_m_a: f64, current_a: f64, angle_rad: f64) -> f64 {
        torque_constant_n_m_a * current_a + self.ripple(angle_rad)
    }

    /// Acceleration of the motor side, rad/s^2, under a torque.
    #[must_use]
    pub fn motor_acceleration(&self, torque_n_m: f64) -> f64 {
        torque_n_m * self.inverse_inertia_1_kg_m2
    }

    /// Torque on the ring, N m, for a windup (motor minus ring angle, rad) and its rate (rad/s). Where there is a gap its flanks push
    /// and never pull, and their damper grows with the strain (Hunt and Crossley, 1975), so that nothing jumps at the contact.
    #[must_use]
    pub fn transmitted_torque(&self, windup_rad: f64, windup_rate_rad_s: f64) -> f64 {
        let strain_rad = self.strain(windup_rad);
        let damping_n_m = self.damping_n_m_s_rad * windup_rate_rad_s;
        if self.half_backlash_rad == 0.0 {
            return self.stiffness_n_m_rad * strain_rad + damping_n_m;
        }
        let grown = strain_rad.abs() / (strain_rad.abs() + CONTACT_STRAIN_RAD);
        let torque_n_m = self.stiffness_n_m_rad * strain_rad + grown * damping_n_m;
        if torque_n_m * strain_rad > 0.0 {
            torque_n_m
        } else {
            0.0
        }
    }

    /// Coulomb friction in the gear, N m, while it transmits a torque.
    #[must_use]
    pub fn gear_loss(&self, transmitted_n_m: f64) -> f64 {
        self.lost_share * transmitted_n_m.abs()
    }

    /// Energy stored in the spring, J.
    #[must_use]
    pub fn spring_energy_j(&self, windup_rad: f64) -> f64 {
        let strain_rad = self.strain(windup_rad);
        let spring_j = 0.5 * self.stiffness_n_m_rad * strain_rad * strain_rad;
        let opened_rad = self.preload_opening(self.beyond_backlash(windup_rad));
        if opened_rad == 0.0 {
            return spring_j;
        }
        spring_j + self.stiffness_n_m_rad * self.preload_strain_rad * opened_rad
    }

    /// What of a windup strains the transmission.
    fn strain(&self, windup_rad: f64) -> f64 {
        let beyond_rad = self.beyond_backlash(windup_rad);
        beyond_rad - self.preload_opening(beyond_rad).copysign(beyond_rad)
    }

    /// Windup beyond the dead zone.
    fn beyond_backlash(&self, windup_rad: f64) -> f64 {
        windup_rad - windup_rad.clamp(-self.half_backlash_rad, self.half_backlash_rad)
    }

    /// How far the preload has opened: it holds up to its torque, gives way, and is hard again at its end.
    fn preload_opening(&self, beyond_rad: f64) -> f64 {
        (beyond_rad.abs() - self.preload_strain_rad).clamp(0.0, self.preload_way_rad)
    }

    fn ripple(&self, angle_rad: f64) -> f64 {
        if self.ripple_n_m == 0.0 {
            return 0.0;
        }
        self.ripple_n_m * sine_of_turns(angle_rad * self.ripple_periods_per_rad)
    }
}

/// A sine to three digits: parabolas through the zeros and the peaks, sharpened once. The ripple's true shape is not
/// known any better, and a library sine would be a tenth of the cost of a step.
fn sine_of_turns(turns: f64) -> f64 {
    // The cast truncates towards zero, so the fraction lies in (-1, 1); the sine's odd symmetry does the rest.
    let fraction = turns - (turns as i64) as f64;
    let centred = if fraction > 0.5 {
        fraction - 1.0
    } else if fraction < -0.5 {
        fraction + 1.0
    } else {
        fraction
    };
    let parabola = 8.0 * centred * (1.0 - 2.0 * centred.abs());
    parabola * (0.775 + 0.225 * parabola.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ripple_is_a_sine_to_three_digits() {
        for step in -2000..2000 {
            let turns = f64::from(step) * 1.25e-3;
            let exact = (turns * core::f64::consts::TAU).sin();
            assert!((sine_of_turns(turns) - exact).abs() < 2e-3, "{turns}");
        }
    }

    #[test]
    fn backlash_passes_no_torque_inside_its_gap() {
        let model = DriveModel::new(&PlantParameters {
            backlash_rad: 5e-6,
            ..PlantParameters::REFERENCE
        });
        assert_eq!(model.transmitted_torque(2.4e-6, 1.0), 0.0);
        assert!(model.transmitted_torque(2.6e-6, 0.0) > 0.0);
        assert!(model.transmitted_torque(-2.6e-6, 0.0) < 0.0);
    }

    #[test]
    fn a_contact_never_pulls_and_never_jumps() {
        let model = DriveModel::new(&PlantParameters::REFERENCE);
        let edge_rad = 0.5 * PlantParameters::REFERENCE.backlash_rad;
        for rate_rad_s in [-0.5, -0.05, -1e-3, 0.0, 1e-3, 0.05, 0.5] {
            let mut last_n_m = 0.0;
            for step in 0..10_000 {
                let windup_rad = edge_rad + f64::from(step) * 1e-11;
                let torque_n_m = model.transmitted_torque(windup_rad, rate_rad_s);
                assert!(torque_n_m >= 0.0, "{windup_rad} {rate_rad_s}: {torque_n_m}");
                // A thousandth of the strain at half the damper: the step of spring and damper is no larger.
                let step_n_m = 7.46e5 * 1e-11 + 3.2 * rate_rad_s.abs() * 1e-3;
                assert!(
                    (torque_n_m - last_n_m).abs() <= step_n_m * 1.001,
                    "{windup_rad} {rate_rad_s}"
                );
                let mirrored_n_m = model.transmitted_torque(-windup_rad, -rate_rad_s);
                assert_eq!(torque_n_m, -mirrored_n_m);
                last_n_m = torque_n_m;
            }
        }
    }

    #[test]
    fn a_quick_motor_charges_a_supply_that_has_sagged() {
        let mut model = DriveModel::new(&PlantParameters::REFERENCE);
        model.supply_v = 12.0;
        // 3 V of the back-EMF drive the current against the motor.
        let coasting = |current_a, back_emf_v| {
            let terminal_v = model.terminal_v(Drive::Coast, current_a, back_emf_v);
            model.current_rate(terminal_v, current_a, back_emf_v, 2.1)
        };
        let rate_a_s = coasting(0.0, 15.0);
        assert!((rate_a_s + 3.0 / 0.7e-3).abs() < 1e-9, "{rate_a_s}");
        assert_eq!(model.settle_current(Drive::Coast, 0.0, -0.1), -0.1);
        assert_eq!(coasting(0.0, 11.7), 0.0);
        // It goes on while the back-EMF exceeds the supply, and ends at (15 - 12) / 2.1 A.
        let settled_a = -3.0 / 2.1;
        assert!(coasting(settled_a, 15.0).abs() < 1e-9);
    }

    #[test]
    fn diodes_block_the_reversal_of_a_dying_current() {
        let model = DriveModel::new(&PlantParameters::REFERENCE);
        assert_eq!(model.settle_current(Drive::Coast, 0.1, -0.2), 0.0);
        assert_eq!(model.settle_current(Drive::Brake, 0.1, -0.2), -0.2);
        assert_eq!(model.terminal_v(Drive::Coast, 0.0, 15.0), None);
    }

    fn with_everything() -> DriveModel {
        let mut parameters = PlantParameters::REFERENCE;
        parameters.imperfections = super::super::Imperfections::ALL;
        DriveModel::new(&parameters)
    }

    /// Torque in the transmission is the slope of its energy, through the gap, the preload and what lies beyond its end.
    #[test]
    fn torque_is_the_slope_of_the_energy() {
        let model = with_everything();
        let (mut most_n_m, step_rad) = (0.0_f64, 1e-9);
        for step in -8_000..8_000 {
            let windup_rad = f64::from(step) * 0.05e-6 + 1e-8;
            let [after_j, before_j] =
                [0.5, -0.5].map(|part: f64| model.spring_energy_j(windup_rad + part * step_rad));
            let slope_n_m = (after_j - before_j) / step_rad;
            let torque_n_m = model.transmitted_torque(windup_rad, 0.0);
            assert!(
                (slope_n_m - torque_n_m).abs() < 1e-4,
                "{windup_rad}: {slope_n_m} {torque_n_m}"
            );
            most_n_m = most_n_m.max(torque_n_m);
        }
        // 9 N m are reached after 12 urad, the end after 302; 98 urad further are 73 N m more.
        let expected_n_m = 9.0 + (400e-6 - 0.05e-6 - 0.15e-6 - 290e-6) * 7.46e5 - 9.0;
        assert!(
            (most_n_m - expected_n_m).abs() < 0.05,
            "{most_n_m} {expected_n_m}"
        );
    }

    #[test]
    fn a_preload_holds_its_torque_and_gives_way_beyond() {
        let model = with_everything();
        let at = |windup_rad: f64| model.transmitted_torque(windup_rad, 0.0);
        assert!((at(10e-6) - 7.46e5 * (10e-6 - 0.15e-6)).abs() < 1e-9);
        for windup_rad in [13e-6, 100e-6, 300e-6] {
            assert!((at(windup_rad) - 9.0).abs() < 1e-9 && (at(-windup_rad) + 9.0).abs() < 1e-9);
        }
        assert!(at(310e-6) > 9.1);
        // What is switched off bears everything.
        let parameters = PlantParameters::REFERENCE;
        assert!(DriveModel::new(&parameters).transmitted_torque(300e-6, 0.0) > 200.0);
    }

    #[test]
    fn a_cyclic_error_has_the_slope_that_it_says() {
        let model = with_everything();
        for i in 0..AXES {
            for step in 0..500 {
                let motor_rad = f64::from(step) * 3e-4;
                let [after, before] =
                    [0.5e-7, -0.5e-7].map(|way| model.cyclic_error(i, motor_rad + way).angle_rad);
                let error = model.cyclic_error(i, motor_rad);
                assert!(((after - before) / 1e-7 - error.slope).abs() < 1e-6);
                assert!(error.angle_rad.abs() <= 100e-6);
            }
        }
    }
}

//! What a reaction may cost at most, by physics: the machine's masses, motors, currents and voltages, and the time that it takes to find
//! a fault. None of the controller's thresholds is taken for granted but those that say how far off a pivot may be before it is found.
//!
//! Brake and coast: a copy of the machine, in the tick in which the reaction had to begin, with shorted or open windings. What
//! shorted windings do to it is in closed form too: momentum over damping, `J^-T M q' R / K^2` rad for each pivot; a test holds the copy
//! to that. Stop: the path at the speed that it had, slower and slower over the stop's time, in which a lost pivot drifts by what its
//! motor does with torques and volts that nobody told the controller of.

use firmware::control::units::SUPPLY_V_PER_COUNT;
use firmware::fault::{Fault, Reaction};
use firmware::parameters::Parameters;

use super::effect::{RESISTOR_OFF_V, RESISTOR_ON_V};
use super::rest::{Rests, ToRest};
use super::scenario::Scenario;
use super::truth::Path;
use crate::front::Wiring;
use crate::machine::devices::{BridgeState, Stage};
use crate::machine::plant::{AXES, Plant};

/// A run may be worse than its bound by this, for what the bound leaves out.
pub const MARGIN: f64 = 1.2;
/// Most ticks that a stage is watched after a fault, until it rests.
pub(super) const AFTERMATH: u64 = 20_000;
/// Break-away over Coulomb friction, of every friction of the machine.
const BREAK_AWAY: f64 = 1.2;

/// The stage in the tick in which a reaction had to begin.
pub(super) struct Moment {
    pub tick: u64,
    pub stage: Stage,
    pub wiring: [Wiring; AXES],
}

impl Moment {
    /// The bound of a fault's reaction; of a start anew where there is no fault.
    pub fn bound(
        self,
        scenario: &Scenario,
        [fault, worse]: [Option<&Fault>; 2],
        asked: &Path,
    ) -> ToRest {
        let parameters = &scenario.parameters;
        let before_mm = found_off_mm(&self.stage.plant, parameters);
        let reaction = fault.map_or(Reaction::Coast, |fault| fault.kind.reaction());
        let mut bound = match reaction {
            Reaction::Brake => self.let_run(scenario, true, asked),
            Reaction::Coast => self.let_run(scenario, false, asked),
            Reaction::Stop => {
                let is_blind = fault.is_some_and(|fault| fault.kind.concerns_encoder());
                let drift_mm = if is_blind {
                    self.drift_mm(scenario)
                } else {
                    0.0
                };
                let stop = self.stop(parameters, drift_mm);
                // A fault that ends the stop brakes: what is left is less than what braking from the start takes.
                let brake = self.let_run(scenario, true, asked);
                ToRest {
                    way_mm: stop.way_mm.max(brake.way_mm),
                    turn_deg: stop.turn_deg.max(brake.turn_deg),
                    // The second is found with pivots as far off as the first.
                    deviation_mm: stop.deviation_mm
                        + worse.map_or(0.0, |_| brake.way_mm + before_mm),
                    rests: true,
                    ..brake
                }
            }
        };
        bound.deviation_mm += before_mm;
        bound
    }

    /// The same machine with windings shorted, or open, from here on; what is broken stays broken. Bridges that have tripped brake by their
    /// diodes, onto a bus that the resistor holds down as the controller sees it.
    fn let_run(mut self, scenario: &Scenario, awake: bool, asked: &Path) -> ToRest {
        let told = BridgeState {
            awake,
            ..BridgeState::RESET
        };
        let pins = self.wiring.map(|wiring| wiring.pass(told));
        let mut rests = Rests::default();
        let mut is_on = self.stage.brake_resistor_is_on();
        scenario.injection.let_go(&mut self.stage.plant);
        rests.look(self.tick, &self.stage.plant, asked);
        for tick in self.tick + 1..self.tick + AFTERMATH {
            if !scenario.injection.lets_go() {
                let age = tick.saturating_sub(scenario.at);
                (scenario.injection).push(&mut self.stage.plant, scenario.axis, age);
            }
            let (_, supply_counts) = self.stage.analog();
            let volts = f64::from(supply_counts) * SUPPLY_V_PER_COUNT;
            is_on = volts > if is_on { RESISTOR_OFF_V } else { RESISTOR_ON_V };
            self.stage.set_brake_resistor(is_on);
            self.stage.advance_period(pins);
            rests.look(tick, &self.stage.plant, asked);
            if rests.to_rest().rests && tick > self.tick + 20 {
                break;
            }
        }
        rests.to_rest()
    }

    /// The plan under way, followed at a rate that falls from one to nothing: half of the stop's time at the speed that it had, which may
    /// still grow.
    fn stop(&self, parameters: &Parameters, drift_mm: f64) -> ToRest {
        let [x_m_s, y_m_s, turn_rad_s] = self.stage.plant.velocity();
        let limits = &parameters.limits;
        let half_s = 0.5 * parameters.supervision.stop_s;
        let way = |speed: f64, acceleration: f64, most: f64| {
            let fastest = most.max(speed);
            (speed * half_s + 0.5 * acceleration * half_s * half_s).min(fastest * half_s)
        };
        let speed_mm_s = x_m_s.hypot(y_m_s) * 1e3;
        let turn_deg_s = turn_rad_s.abs().to_degrees();
        let drift_deg = (drift_mm / parameters.geometry.radius_mm).to_degrees();
        ToRest {
            // A pivot that drifts takes the platform there and may bring it back.
            way_mm: way(speed_mm_s, limits.acceleration_mm_s2, limits.speed_mm_s) + 2.0 * drift_mm,
            turn_deg: way(
                turn_deg_s,
                limits.turn_acceleration_deg_s2,
                limits.turn_speed_deg_s,
            ) + drift_deg,
            deviation_mm: drift_mm,
            ..ToRest::default()
        }
    }

    /// How far the platform drifts while a pivot is driven by its model alone. Its motor, at a voltage, turns wrongly by what the
    /// voltage is wrong over its constant: torques that the model does not have, at the winding's resistance; the current that it needs,
    /// at the resistance that the model has wrong; the back-EMF that it has wrong.
    fn drift_mm(&self, scenario: &Scenario) -> f64 {
        let plant = &self.stage.plant;
        let machine = plant.parameters();
        let flags = machine.imperfections;
        let axis = scenario.axis;
        let told = &scenario.parameters.drives[axis];
        let (constant, told_constant) = (
            machine.ring_torque_constant_n_m_a(),
            told.torque_constant_n_m_a * told.gear_ratio,
        );
        let warmer = machine.winding.resistance_per_k * plant.windings_warmer_k()[axis];
        let resistance_ohm = machine.resistance_ohm * (1.0 + warmer);
        let gate = |flag: bool, value: f64| if flag { value } else { 0.0 };
        let ring_n_m = BREAK_AWAY * machine.ring_friction.coulomb - told.coulomb_n_m;
        let unknown_n_m = ring_n_m.abs()
            + gate(
                flags.motor_friction,
                BREAK_AWAY * machine.motor_friction.coulomb,
            )
            + gate(
                flags.guide_friction,
                BREAK_AWAY * machine.guide_friction.coulomb * machine.track_radius_m * 3.0,
            )
            + gate(flags.torque_ripple, machine.ripple_n_m);
        let rate_rad_s = plant.pivot_rates_rad_s()[axis].abs();
        // The stop itself asks for half as much again as its mean.
        let stop_rad_s2 = 1.5 * rate_rad_s / scenario.parameters.supervision.stop_s;
        let carried = 1.0 / plant.jacobian().row(axis).norm_squared();
        let inertia_kg_m2 = machine.drive_inertia_kg_m2()
            + carried * (machine.platform_mass_kg + machine.payload.mass_kg);
        let current_a =
            (plant.currents_a()[axis].abs()).max(inertia_kg_m2 * stop_rad_s2 / constant);
        let lost_n_m = gate(
            flags.gear_losses,
            BREAK_AWAY * (1.0 - machine.gear.efficiency) * constant * current_a,
        );
        let wrong_v = (unknown_n_m + lost_n_m) * resistance_ohm / constant
            + current_a * (resistance_ohm - told.resistance_ohm).abs()
            + rate_rad_s * (constant - told_constant).abs();
        let drift_rad = wrong_v / constant * scenario.parameters.supervision.stop_s;
        drift_rad * by_pivots_mm(plant)[axis]
    }
}

/// How far the platform may be off its path when a fault is found: each pivot as far as it may be unnoticed.
fn found_off_mm(plant: &Plant, parameters: &Parameters) -> f64 {
    let supervision = &parameters.supervision;
    let rates_rad_s = plant.pivot_rates_rad_s();
    (by_pivots_mm(plant).into_iter().zip(rates_rad_s))
        .map(|(by_pivot_mm, rate_rad_s)| {
            let lag_s = supervision.following_error_s
                + f64::from(supervision.bridged_frames) / parameters.limits.rate_hz;
            let off_rad =
                supervision.following_error_rad + supervision.frozen_rad + lag_s * rate_rad_s.abs();
            by_pivot_mm * off_rad
        })
        .sum()
}

/// How far the centre goes when one pivot turns, mm/rad.
fn by_pivots_mm(plant: &Plant) -> [f64; AXES] {
    plant
        .jacobian()
        .try_inverse()
        .map_or([0.0; AXES], |inverse| {
            [0, 1, 2].map(|i| inverse[(0, i)].hypot(inverse[(1, i)]) * 1e3)
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::devices::StageParameters;
    use crate::machine::plant::{Drive, Imperfections};
    use nalgebra::{Matrix3, Vector3};

    /// Shorted windings take the momentum: the pivots turn by momentum over damping, and by no more where friction helps.
    #[test]
    fn braking_takes_the_way_that_momentum_and_damping_give() {
        let mut parameters = StageParameters::REFERENCE.plant;
        parameters.imperfections = Imperfections::NONE;
        let mut plant = Plant::new(parameters);
        let velocity = Vector3::new(0.1, -0.05, 1.0);
        plant.set_velocity(velocity.into());
        let jacobian = plant.jacobian();
        let motors: Matrix3<f64> = parameters.motor_inertia_kg_m2 * jacobian.tr_mul(&jacobian);
        let momentum = (plant.mass_matrix() + motors) * velocity;
        let constant = parameters.ring_torque_constant_n_m_a();
        let damping = constant * constant / parameters.resistance_ohm;
        let damped = damping * jacobian.tr_mul(&jacobian);
        let way_m = damped
            .try_inverse()
            .expect("the centre is no singular pose")
            * momentum;
        let from = Vector3::from(plant.pose());
        for _ in 0..20_000 {
            plant.step(16e-6, &[Drive::Brake; AXES]);
        }
        let gone = Vector3::from(plant.pose()) - from;
        assert!(
            (gone - way_m).norm() < 0.03 * way_m.norm(),
            "{gone} {way_m}"
        );
    }
}

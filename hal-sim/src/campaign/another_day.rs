//! The same machine, as sound as before, on another day: what the controller cannot know, and what differs from it by less it cannot find.
//!
//! | what | by how much |
//! |---|---|
//! | windings | as warm as 0 to 60 K of work leave them |
//! | magnets | 3 %: 15 K of them, and their wear |
//! | grease in rings, motors and guides | a quarter of the friction |
//! | supply | 2 % of the 5 % that it may be off |
//! | sensors of current and supply | offsets of 2 counts rms and gains of 0.5 % rms, drawn anew |
//! | noise, balls, floor | another one |

use core::f64::consts::TAU;

use crate::machine::devices::StageParameters;
use crate::machine::draw_sensors;
use crate::machine::plant::{AXES, FrictionParameters};
use crate::random::Random;

/// The machine then. Its seed, of the noise, is another one.
#[must_use]
pub fn on_another_day(stage: &StageParameters, seed: u64) -> StageParameters {
    let mut random = Random::new(!seed);
    let mut then = *stage;
    then.seed = random.bits();
    let plant = &mut then.plant;
    plant.winding.start_k = random.between(0.0, 60.0);
    plant.torque_constant_n_m_a *= random.between(0.97, 1.03);
    let mut regrease = |friction: &mut FrictionParameters| {
        friction.coulomb *= random.between(0.75, 1.25);
    };
    regrease(&mut plant.ring_friction);
    regrease(&mut plant.motor_friction);
    regrease(&mut plant.guide_friction);
    plant.supply_v *= random.between(0.98, 1.02);
    plant.ball_phase_rad = [(); AXES].map(|()| random.between(0.0, TAU));
    draw_sensors(&mut then.analog, &mut random);
    then
}

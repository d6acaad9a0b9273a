//! Which departures from an ideal machine are simulated, and their names.

use serde::{Deserialize, Serialize};

/// Which departures from an ideal machine are simulated.
///
/// A flag only gates its effect: the size stands in [`PlantParameters`](super::PlantParameters) (or in the parameters of the device), so an
/// effect can be switched off and on again without losing its number. The counts of the encoders have no flag: a frame holds
/// whole counts, and the true angle is the plant's to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Imperfections {
    /// Coulomb, static and presliding friction at the rings (the bristle model).
    pub dry_friction: bool,
    /// Viscous friction at the rings.
    pub viscous_friction: bool,
    /// Elastic transmission. Off, the spring is made so stiff that the resonance is four times as high: a rigid joint
    /// would need another state vector, and nothing in the controller's band can tell the two apart.
    pub compliance: bool,
    /// Dead zone in the transmission.
    pub backlash: bool,
    /// Torque ripple of the motors.
    pub torque_ripple: bool,
    /// Random noise of the encoders, beyond their quantisation.
    pub encoder_noise: bool,
    /// First harmonic error of the encoders.
    pub encoder_eccentricity: bool,
    /// Voltage lost in the bridges' dead time.
    pub dead_time: bool,
    /// Friction of the carriages on their guides.
    pub guide_friction: bool,
    /// Guides and carriages that give way across the guide. Off, they are rigid.
    pub guide_compliance: bool,
    /// Errors of the geometry: [`pivots`](super::PlantParameters::pivots).
    pub geometry: bool,
    /// Cyclic error of the gears.
    pub gear_error: bool,
    /// A preload of the transmission that opens under torque. Off, it bears everything.
    pub preload: bool,
    /// Friction on the motors' side of the gears.
    pub motor_friction: bool,
    /// Friction in the gears that grows with the torque that they transmit.
    pub gear_losses: bool,
    /// Teeth of the gears that break under too much torque. Off, they bear everything.
    pub tooth_limit: bool,
    /// Torque ripple that grows with the current.
    pub commutation_ripple: bool,
    /// Run-out of the rings that does not repeat.
    pub ball_runout: bool,
    /// Cables that draw the platform to the centre.
    pub cable_drag: bool,
    /// Second to twelfth harmonic error of the encoders.
    pub encoder_harmonics: bool,
    /// Error of the encoders within a period of their scale.
    pub subdivisional_error: bool,
    /// Bits that are wrong on the encoders' lines.
    pub bit_errors: bool,
    /// Noise, offset and gain errors of the analog inputs.
    pub analog_errors: bool,
    /// Ripple of the PWM in the motor currents that the analog inputs sample.
    pub current_ripple: bool,
    /// Floor that shakes.
    pub floor_vibration: bool,
    /// Windings that become warm, and have more resistance then.
    pub winding_heat: bool,
    /// A track that becomes warm, and larger.
    pub track_heat: bool,
    /// A supply that ripples at twice the mains' frequency.
    pub supply_ripple: bool,
    /// A bus behind a diode, with a capacitor. Off, the supply gives and takes any current.
    pub bus: bool,
    /// Bridges that trip, that become too hot, and that need time to wake up.
    pub bridge_limits: bool,
    /// Counts of the PWM. Off, a period has [`FINE_PWM`](crate::machine::devices::FINE_PWM) counts, as many as a duty can name.
    pub pwm_quantisation: bool,
}

impl Imperfections {
    /// An ideal machine: no friction, no backlash, no noise. Integers stay integers: counts of encoders and PWM.
    pub const NONE: Self = Self {
        dry_friction: false,
        viscous_friction: false,
        compliance: true,
        backlash: false,
        torque_ripple: false,
        encoder_noise: false,
        encoder_eccentricity: false,
        dead_time: false,
        guide_friction: false,
        guide_compliance: false,
        geometry: false,
        gear_error: false,
        preload: false,
        motor_friction: false,
        gear_losses: false,
        tooth_limit: false,
        commutation_ripple: false,
        ball_runout: false,
        cable_drag: false,
        encoder_harmonics: false,
        subdivisional_error: false,
        bit_errors: false,
        analog_errors: false,
        current_ripple: false,
        floor_vibration: false,
        winding_heat: false,
        track_heat: false,
        supply_ripple: false,
        bus: false,
        bridge_limits: false,
        pwm_quantisation: false,
    };

    /// A kind machine: guides without friction, rigid and exact, gears and bearings that are exact, quiet surroundings, and encoders
    /// that have been calibrated.
    pub const CALIBRATED: Self = Self {
        dry_friction: true,
        viscous_friction: true,
        backlash: true,
        torque_ripple: true,
        encoder_noise: true,
        dead_time: true,
        pwm_quantisation: true,
        ..Self::NONE
    };

    /// Everything.
    pub const ALL: Self = Self {
        encoder_eccentricity: true,
        guide_friction: true,
        guide_compliance: true,
        geometry: true,
        gear_error: true,
        preload: true,
        motor_friction: true,
        gear_losses: true,
        tooth_limit: true,
        commutation_ripple: true,
        ball_runout: true,
        cable_drag: true,
        encoder_harmonics: true,
        subdivisional_error: true,
        bit_errors: true,
        analog_errors: true,
        current_ripple: true,
        floor_vibration: true,
        winding_heat: true,
        track_heat: true,
        supply_ripple: true,
        bus: true,
        bridge_limits: true,
        ..Self::CALIBRATED
    };
}

/// One imperfection: its name on the command line, and its flag.
pub struct Named {
    /// Words with hyphens between.
    pub name: &'static str,
    /// Where it is switched.
    pub flag: fn(&mut Imperfections) -> &mut bool,
}

/// Every imperfection that can be switched.
pub const NAMED: [Named; 31] = [
    named("dry-friction", |on| &mut on.dry_friction),
    named("viscous-friction", |on| &mut on.viscous_friction),
    named("compliance", |on| &mut on.compliance),
    named("backlash", |on| &mut on.backlash),
    named("torque-ripple", |on| &mut on.torque_ripple),
    named("encoder-noise", |on| &mut on.encoder_noise),
    named("encoder-eccentricity", |on| &mut on.encoder_eccentricity),
    named("dead-time", |on| &mut on.dead_time),
    named("guide-friction", |on| &mut on.guide_friction),
    named("guide-compliance", |on| &mut on.guide_compliance),
    named("geometry", |on| &mut on.geometry),
    named("gear-error", |on| &mut on.gear_error),
    named("preload", |on| &mut on.preload),
    named("motor-friction", |on| &mut on.motor_friction),
    named("gear-losses", |on| &mut on.gear_losses),
    named("tooth-limit", |on| &mut on.tooth_limit),
    named("commutation-ripple", |on| &mut on.commutation_ripple),
    named("ball-runout", |on| &mut on.ball_runout),
    named("cable-drag", |on| &mut on.cable_drag),
    named("encoder-harmonics", |on| &mut on.encoder_harmonics),
    named("subdivisional-error", |on| &mut on.subdivisional_error),
    named("bit-errors", |on| &mut on.bit_errors),
    named("analog-errors", |on| &mut on.analog_errors),
    named("current-ripple", |on| &mut on.current_ripple),
    named("floor-vibration", |on| &mut on.floor_vibration),
    named("winding-heat", |on| &mut on.winding_heat),
    named("track-heat", |on| &mut on.track_heat),
    named("supply-ripple", |on| &mut on.supply_ripple),
    named("bus", |on| &mut on.bus),
    named("bridge-limits", |on| &mut on.bridge_limits),
    named("pwm-quantisation", |on| &mut on.pwm_quantisation),
];

const fn named(name: &'static str, flag: fn(&mut Imperfections) -> &mut bool) -> Named {
    Named { name, flag }
}

impl Imperfections {
    /// With one of them, by its name, switched; `None`: there is no such name.
    #[must_use]
    pub fn switched(mut self, name: &str, is_on: bool) -> Option<Self> {
        let named = NAMED.iter().find(|named| named.name == name)?;
        *(named.flag)(&mut self) = is_on;
        Some(self)
    }

    /// Names of those that are on here and not there.
    #[must_use]
    pub fn beyond(mut self, mut other: Self) -> Vec<&'static str> {
        let is_beyond = |named: &&Named| *(named.flag)(&mut self) && !*(named.flag)(&mut other);
        NAMED
            .iter()
            .filter(is_beyond)
            .map(|named| named.name)
            .collect()
    }
}

impl Default for Imperfections {
    fn default() -> Self {
        Self::CALIBRATED
    }
}

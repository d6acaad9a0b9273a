//! Every number of the simulated stage, in SI units, with its origin.
//!
//! "Reference stage" in an origin means the table of the project's reference stage: a given. "Chosen" means that the
//! reference stage leaves it open; the reason follows.

use super::built::BUILT;
use super::imperfections::Imperfections;
use super::pivot_geometry::{AXES, PivotGeometry};
use serde::{Deserialize, Serialize};

/// A load on the platform. Its centre and its own inertia are given in the platform frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// Mass, kg. Reference stage: 0 to 5.
    pub mass_kg: f64,
    /// Moment of inertia about its own centre, kg m^2.
    pub inertia_kg_m2: f64,
    /// Distance of its centre from the platform's, m.
    pub eccentricity_m: f64,
    /// Direction of its centre in the platform frame, rad from the platform's x' axis.
    pub direction_rad: f64,
}

impl Payload {
    /// Nothing on the platform.
    pub const NONE: Self = Self {
        mass_kg: 0.0,
        inertia_kg_m2: 0.0,
        eccentricity_m: 0.0,
        direction_rad: 0.0,
    };
}

/// Friction by the bristle model. A ring's is in N m and rad, a guide's in N and m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionParameters {
    /// Coulomb friction: N m or N.
    pub coulomb: f64,
    /// Break-away over Coulomb friction.
    pub stiction_ratio: f64,
    /// Rate at which half of the static excess has gone (Stribeck): rad/s or m/s.
    pub stribeck_rate: f64,
    /// Presliding distance, Coulomb friction over bristle stiffness: rad or m.
    pub presliding: f64,
    /// Damping of the bristles: N m s/rad or N s/m.
    pub bristle_damping: f64,
    /// Viscous friction: N m s/rad or N s/m.
    pub viscous: f64,
}

/// What a gear is off the drawing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearParameters {
    /// Amplitude of the cyclic error, once a turn of the motor, seen at the ring, rad.
    pub cyclic_error_rad: f64,
    /// Phase of it for each drive, rad of the motor's turn.
    pub cyclic_phase_rad: [f64; AXES],
    /// Torque that the preload of the transmission bears, seen at the ring, N m.
    pub preload_n_m: f64,
    /// How far the transmission gives way where more torque opens the preload, rad.
    pub preload_way_rad: f64,
    /// What a driven gear gives of the torque that it is driven with, beside what rubs without a load.
    pub efficiency: f64,
    /// Torque at which a tooth of the transmission breaks, seen at the ring, N m.
    pub tooth_torque_n_m: f64,
}

/// How a winding becomes warm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindingParameters {
    /// How much warmer it settles for each watt that is lost in it, K/W.
    pub thermal_resistance_k_w: f64,
    /// Time in which it has gone two thirds of the way there, s.
    pub time_constant_s: f64,
    /// Growth of its resistance, 1/K.
    pub resistance_per_k: f64,
    /// How much warmer it is at the start than where the resistance was measured, K.
    pub start_k: f64,
}

/// How the track becomes warm, and how it grows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackParameters {
    /// How much warmer it settles for each watt that is lost in the three windings together, K/W.
    pub thermal_resistance_k_w: f64,
    /// Time in which it has gone two thirds of the way there, s.
    pub time_constant_s: f64,
    /// Growth of its radius over itself, 1/K.
    pub expansion_per_k: f64,
    /// How much warmer it is at the start than where its radius was measured, K.
    pub start_k: f64,
}

/// The machine behind the bridges' terminals. See [`PlantParameters::REFERENCE`] for the origin of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlantParameters {
    /// Track radius, m.
    pub track_radius_m: f64,
    /// Mass of the platform, kg.
    pub platform_mass_kg: f64,
    /// Inertia of the platform about its centre, kg m^2.
    pub platform_inertia_kg_m2: f64,
    /// Load on the platform.
    pub payload: Payload,
    /// Acceleration of gravity in the plane of motion, base frame, m/s^2. Not zero when the stage is mounted at an
    /// angle to the horizontal.
    pub gravity_m_s2: [f64; 2],
    /// Inertia of one ring with its pivot, carriage and output gear, kg m^2.
    pub ring_inertia_kg_m2: f64,
    /// Inertia of one motor with its side of the gear, seen at the ring (rotor times gear ratio squared), kg m^2.
    pub motor_inertia_kg_m2: f64,
    /// Motor turns a ring turn.
    pub gear_ratio: f64,
    /// Torque constant at the motor shaft, N m/A; in SI it is the back-EMF constant too, V s/rad.
    pub torque_constant_n_m_a: f64,
    /// Winding resistance with brushes and bridge, ohm.
    pub resistance_ohm: f64,
    /// Winding inductance, H.
    pub inductance_h: f64,
    /// Warmth of the windings.
    pub winding: WindingParameters,
    /// Warmth of the track.
    pub track: TrackParameters,
    /// Supply of the bridges, V.
    pub supply_v: f64,
    /// Stiffness of one transmission, seen at the ring, N m/rad.
    pub transmission_stiffness_n_m_rad: f64,
    /// Damping of one transmission, seen at the ring, N m s/rad.
    pub transmission_damping_n_m_s_rad: f64,
    /// Full width of the transmission's dead zone, seen at the ring, rad.
    pub backlash_rad: f64,
    /// Cyclic error and preload of the transmission.
    pub gear: GearParameters,
    /// Friction of one ring: N m, rad.
    pub ring_friction: FrictionParameters,
    /// Friction of one motor and its side of the gear, seen at the ring: N m, rad.
    pub motor_friction: FrictionParameters,
    /// Amplitude of the torque ripple, seen at the ring, N m.
    pub ripple_n_m: f64,
    /// Periods of the ripple in one turn of the motor.
    pub ripple_periods_per_motor_turn: f64,
    /// Amplitude of the ripple that grows with the current, over the torque.
    pub commutation_ripple: f64,
    /// Range of rho between a guide's two ends, m.
    pub guide_range_m: [f64; 2],
    /// Stiffness of a guide's end stop, N/m.
    pub stop_stiffness_n_m: f64,
    /// Damping of a guide's end stop while it is pressed, N s/m.
    pub stop_damping_n_s_m: f64,
    /// Stiffness of a carriage and its guide across the guide, N/m.
    pub guide_stiffness_n_m: f64,
    /// Damping across a guide, N s/m.
    pub guide_damping_n_s_m: f64,
    /// Friction of a carriage along its guide: N, m.
    pub guide_friction: FrictionParameters,
    /// Acceleration of the floor along x and along y, 2 to 20 Hz, m/s^2 rms.
    pub floor_acceleration_m_s2: f64,
    /// Stiffness of the cables to the platform, which draw it to the centre, N/m.
    pub cable_stiffness_n_m: f64,
    /// Amplitude of the run-out of a ring that its balls make and that does not repeat, m.
    pub ball_runout_m: f64,
    /// Phase of it for each ring, rad.
    pub ball_phase_rad: [f64; AXES],
    /// How pivots, rings and guides are built.
    pub pivots: [PivotGeometry; AXES],
    /// What of all this is simulated.
    pub imperfections: Imperfections,
}

impl PlantParameters {
    /// The reference stage, empty and level, with the imperfections of a kind machine.
    pub const REFERENCE: Self = Self {
        // Reference stage.
        track_radius_m: 0.1,
        platform_mass_kg: 3.0,
        platform_inertia_kg_m2: 0.02,
        payload: Payload::NONE,
        gravity_m_s2: [0.0, 0.0],
        // Reference stage: 0.02 kg m^2 seen at the ring, both sides of the transmission together. Chosen split:
        // an aluminium ring with its carriage, 0.8 kg at 0.1 m ...
        ring_inertia_kg_m2: 0.008,
        // ... and a rotor with its pinion of 48 g cm^2 times 50^2, a servo of the 35 mm class (makers state 40 to 80).
        motor_inertia_kg_m2: 0.012,
        // Reference stage.
        gear_ratio: 50.0,
        torque_constant_n_m_a: 0.06,
        resistance_ohm: 2.1,
        inductance_h: 0.7e-3,
        winding: WindingParameters {
            // Chosen: 4 A, which the motor bears, make it 100 K warmer at 33 W.
            thermal_resistance_k_w: 3.0,
            // Chosen: the winding of a servo of the 35 mm class, without its housing.
            time_constant_s: 40.0,
            // Copper.
            resistance_per_k: 0.0039,
            start_k: 0.0,
        },
        track: TrackParameters {
            // Chosen: what air takes from 0.2 m^2 at 10 W/m^2 K.
            thermal_resistance_k_w: 0.5,
            // Chosen: with that, rings and a plate of 16 kg of aluminium together, 900 J/kg K. Two hours.
            time_constant_s: 7_200.0,
            // Reference stage: 2.3 um/K at 0.1 m, aluminium.
            expansion_per_k: 23e-6,
            start_k: 0.0,
        },
        supply_v: 48.0,
        // Reference stage: first resonance at 1.5 kHz. Derived for the lowest mode of the assembled stage, empty and
        // centred. That mode is a translation: its ring-side inertia a drive is I_ring + m R^2 / 1.5 (J^T J = 1.5/R^2
        // in x and y) = 0.028 kg m^2, against 0.012 of the motor: k = (2 pi 1500)^2 / (1/0.012 + 1/0.028). The
        // rotation then resonates at 1.69 kHz, and 5 kg of payload take the lowest to 1.37 kHz.
        transmission_stiffness_n_m_rad: 7.46e5,
        // Chosen: 2 % of critical damping, usual for steel gears with preload: c = 2 * 0.02 * sqrt(k * 0.0084).
        transmission_damping_n_m_s_rad: 3.2,
        // Chosen: 30 nm on the track, what a preloaded transmission keeps. The reference stage does not name a value. With more
        // an unloaded pivot hunts in the gap, by about 4 encoder LSB for each urad: nothing but the ring has friction.
        backlash_rad: 0.3e-6,
        gear: GearParameters {
            // Reference stage: 50 to 300 urad.
            cyclic_error_rad: 100e-6,
            cyclic_phase_rad: [0.3, 2.2, 4.9],
            // Reference stage: 9 N m, 16 with hard stops.
            preload_n_m: 9.0,
            // Reference stage: a gear with its gap open runs free by this.
            preload_way_rad: 290e-6,
            // Chosen: 0.04 a stage, in two stages. Makers of precise planetary gears state 0.9 to 0.95 for two stages at full load, with
            // what rubs without a load in it: with the motor's 0.2 N m it is 0.9 at the 9 N m that the preload bears.
            efficiency: 0.92,
            // Chosen: a case-hardened tooth of module 1, 12 mm wide, bears some 5 kN at its foot once, and the ring's are at 0.1 m.
            tooth_torque_n_m: 500.0,
        },
        // Reference stage.
        ring_friction: FrictionParameters {
            coulomb: 0.1,
            stiction_ratio: 1.2,
            presliding: 100e-6,
            viscous: 0.05,
            // Chosen: 0.5 mm/s on the track, the order reported for greased rolling bearings.
            stribeck_rate: 5e-3,
            // Chosen: a tenth of critical for the ring on its bristles, 2 * 0.1 * sqrt(1000 * 0.02).
            bristle_damping: 0.9,
        },
        motor_friction: FrictionParameters {
            // Reference stage: 0.15 to 0.3 N m, brushes and bearings times the gear ratio.
            coulomb: 0.2,
            // Chosen: bearings that turn fifty times as far have no more stiction than rings.
            stiction_ratio: 1.2,
            // Chosen: as the ring's, which is 1 deg of the motor's shaft in presliding and 2.4 rpm of it in rate.
            presliding: 100e-6,
            stribeck_rate: 5e-3,
            // Chosen: a tenth of critical for the motor on its bristles, 2 * 0.1 * sqrt(2000 * 0.012).
            bristle_damping: 0.98,
            // What grows with the rate is in the ring's.
            viscous: 0.0,
        },
        // Reference stage.
        ripple_n_m: 0.03,
        // Chosen: a commutator of 13 bars, each brush passing each bar.
        ripple_periods_per_motor_turn: 26.0,
        // Reference stage: 1 to 3 %.
        commutation_ripple: 0.02,
        // Reference stage: the guides reach their ends with the centre at 84 mm, so rho ends at 100 -+ 84 mm.
        guide_range_m: [0.016, 0.184],
        // Chosen: a hard rubber buffer. At full speed (0.2 m/s, 8 kg) it is pressed in by 0.6 mm ...
        stop_stiffness_n_m: 1e6,
        // ... and loses most of the energy in one stroke.
        stop_damping_n_s_m: 2e3,
        // Reference stage: 10 to 50 N/um is what carriages on rails of this size give; the stiff end.
        guide_stiffness_n_m: 50e6,
        // Reference stage: 1 to 3 % of critical. 2 %, for a ring's 0.8 kg against the platform's 2 kg: 2 * 0.02 * sqrt(5e7 * 0.57).
        guide_damping_n_s_m: 214.0,
        guide_friction: FrictionParameters {
            // Reference stage: 1 N, with lubricated seals 0.5 to 3 N.
            coulomb: 1.0,
            stiction_ratio: 1.2,
            // Chosen: 20 um, the order that is reported for balls on rails.
            presliding: 20e-6,
            // Chosen: as the rings' 0.5 mm/s.
            stribeck_rate: 0.5e-3,
            // Chosen: a tenth of critical for the platform's 3 kg on its bristles, 2 * 0.1 * sqrt(5e4 * 3).
            bristle_damping: 77.0,
            // Chosen: as much again as the Coulomb friction at 0.2 m/s.
            viscous: 5.0,
        },
        // Reference stage: what a stage at rest may be asked to bear. A workshop's floor shakes ten times as much.
        floor_acceleration_m_s2: 0.1e-3,
        // Reference stage: 0.1 to 1 N. 0.5 N at the rim.
        cable_stiffness_n_m: 6.0,
        // Reference stage: 20 to 100 nm.
        ball_runout_m: 40e-9,
        ball_phase_rad: [1.1, 3.4, 5.6],
        pivots: BUILT,
        imperfections: Imperfections::CALIBRATED,
    };

    /// Inertia of one drive with its ring, seen at the ring, kg m^2.
    #[must_use]
    pub const fn drive_inertia_kg_m2(&self) -> f64 {
        self.ring_inertia_kg_m2 + self.motor_inertia_kg_m2
    }

    /// Torque at the ring for each ampere, N m/A; at the same time the back EMF for each rad/s of the ring, V s/rad.
    #[must_use]
    pub const fn ring_torque_constant_n_m_a(&self) -> f64 {
        self.gear_ratio * self.torque_constant_n_m_a
    }
}

impl Default for PlantParameters {
    fn default() -> Self {
        Self::REFERENCE
    }
}

//! The whole simulated stage behind the controller's wires, and the timeline of one control period.
//!
//! ```text
//!  tick k                                                    tick k+1
//!  T           T + 0.32 P     T + 0.64 P   T + 0.7 P         T + P
//!  |--- 16 us ---|--- 16 us ---|--- 3 us ---|------ 15 us ------|      P = 50 us
//!  |  drive of tick k-1        |  drive of tick k               |
//!                                           ^ encoders latch, one 60 ns after the other: the frames that tick k+1 reads
//! ```
//!
//! The PWM runs at twice the control rate and takes a new duty over with the second period that begins after the tick
//! that computed it. Direction and sleep pins are taken to change with it. Other control rates scale the grid.

use super::analog::AnalogParameters;
use super::bridge::{BridgeParameters, BridgeState};
use super::bus::{BrakeResistorFault, Bus, BusParameters};
use super::encoder::{Encoder, EncoderParameters};
use super::protection::Protection;
use super::wiring::WiringParameters;
use crate::machine::plant::{AXES, Drive, ENCODER_HARMONICS_RAD, Plant, PlantParameters};
use firmware::drivers::latch::LATCH_OFFSET_S;
use serde::{Deserialize, Serialize};

/// Substeps before the new drive acts, in parts of the period.
const OLD_DRIVE: [f64; 2] = [0.32, 0.32];
/// Part of the period from the new drive to the encoders' latch.
const TO_LATCH: f64 = 0.06;
/// Part of the period from the latch to the next tick.
const AFTER_LATCH: f64 = 0.3;

/// Everything that a simulated stage is made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StageParameters {
    /// Control period, s.
    pub period_s: f64,
    /// The machine, and which imperfections are simulated (also of the devices here).
    pub plant: PlantParameters,
    /// The encoders.
    pub encoders: [EncoderParameters; AXES],
    /// The bridges; their supply is the plant's.
    pub bridge: BridgeParameters,
    /// The bus from the supply to the bridges.
    pub bus: BusParameters,
    /// The analog inputs.
    pub analog: AnalogParameters,
    /// The wires between machine and controller.
    pub wiring: WiringParameters,
    /// How much later than the encoder at the first port that of each port latches, s. It is the board's, and no part of a machine's
    /// file.
    #[serde(skip, default = "reference_latch_offsets_s")]
    pub latch_offsets_s: [f64; AXES],
    /// Seed of every random number. It is a run's, and no part of a machine's file.
    #[serde(skip, default = "reference_seed")]
    pub seed: u64,
}

impl StageParameters {
    /// The reference stage. Its encoders are mounted as they came: each with a zero and a direction of its own.
    pub const REFERENCE: Self = Self {
        period_s: 50e-6,
        plant: PlantParameters::REFERENCE,
        encoders: [
            EncoderParameters {
                zero_counts: 12_345_678,
                reversed: false,
                eccentricity_phase_rad: 0.4,
                harmonics_rad: ENCODER_HARMONICS_RAD[0],
                ..EncoderParameters::REFERENCE
            },
            EncoderParameters {
                zero_counts: 50_331_649,
                reversed: true,
                eccentricity_phase_rad: 2.9,
                harmonics_rad: ENCODER_HARMONICS_RAD[1],
                ..EncoderParameters::REFERENCE
            },
            EncoderParameters {
                zero_counts: 67_000_000,
                reversed: false,
                eccentricity_phase_rad: 5.1,
                harmonics_rad: ENCODER_HARMONICS_RAD[2],
                ..EncoderParameters::REFERENCE
            },
        ],
        bridge: BridgeParameters::REFERENCE,
        bus: BusParameters::REFERENCE,
        analog: AnalogParameters::REFERENCE,
        wiring: WiringParameters::REFERENCE,
        latch_offsets_s: LATCH_OFFSET_S,
        seed: REFERENCE_SEED,
    };
}

const REFERENCE_SEED: u64 = 1;

const fn reference_seed() -> u64 {
    REFERENCE_SEED
}

const fn reference_latch_offsets_s() -> [f64; AXES] {
    LATCH_OFFSET_S
}

impl Default for StageParameters {
    fn default() -> Self {
        Self::REFERENCE
    }
}

/// Plant, encoders and bridges at one tick.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The machine.
    pub plant: Plant,
    /// The encoders; they hold the frames for the tick that is due.
    pub encoders: [Encoder; AXES],
    period_s: f64,
    bridge: BridgeParameters,
    /// Where the supply is not ideal; `source_v` feeds it.
    bus: Option<Bus>,
    bus_parameters: BusParameters,
    /// The supply, and what it gives in this period, with its ripple.
    supply_v: f64,
    source_v: f64,
    /// Its pin, and what is wrong with it.
    brake_resistor_is_on: bool,
    brake_resistor_fault: Option<BrakeResistorFault>,
    /// Where bridges have limits.
    protection: Option<[Protection; AXES]>,
    analog: AnalogParameters,
    /// Converters that repeat a sample: of currents, and of the supply.
    stuck_currents: [Option<u16>; AXES],
    stuck_supply: Option<u16>,
    /// Inductance of the windings, H, where the currents ripple with the PWM.
    rippling_h: Option<f64>,
    wiring: WiringParameters,
    latch_offsets_s: [f64; AXES],
    seed: u64,
    periods: u64,
    acting: [BridgeState; AXES],
    /// What the bridges made of that, by rings.
    driving: [BridgeState; AXES],
    latched_pose: [f64; 3],
}

impl Stage {
    /// A stage at rest in the centre with the bridges asleep and the encoders latched: the first tick is due.
    #[must_use]
    pub fn new(parameters: &StageParameters) -> Self {
        let flags = parameters.plant.imperfections;
        let mut axis = 0;
        let encoders = parameters.encoders.map(|encoder| {
            axis += 1;
            // Any mixing will do: the generator spreads neighbouring seeds over its whole range.
            let seed = parameters.seed.wrapping_mul(8).wrapping_add(axis);
            Encoder::new(encoder, seed, &flags)
        });
        let mut bridge = parameters.bridge;
        bridge.supply_v = parameters.plant.supply_v;
        if !flags.dead_time {
            bridge.dead_time_s = 0.0;
        }
        let mut stage = Self {
            plant: Plant::new(parameters.plant),
            encoders,
            period_s: parameters.period_s,
            bridge,
            bus: (flags.bus).then(|| Bus::new(parameters.bus, parameters.plant.supply_v)),
            bus_parameters: BusParameters {
                ripple_v: if flags.supply_ripple {
                    parameters.bus.ripple_v
                } else {
                    0.0
                },
                ..parameters.bus
            },
            supply_v: parameters.plant.supply_v,
            source_v: parameters.plant.supply_v,
            brake_resistor_is_on: false,
            brake_resistor_fault: None,
            protection: flags.bridge_limits.then(Default::default),
            analog: if flags.analog_errors {
                parameters.analog
            } else {
                AnalogParameters {
                    current_sampled_s: parameters.analog.current_sampled_s,
                    ..AnalogParameters::EXACT
                }
            },
            stuck_currents: [None; AXES],
            stuck_supply: None,
            rippling_h: (flags.current_ripple).then_some(parameters.plant.inductance_h),
            wiring: parameters.wiring,
            latch_offsets_s: parameters.latch_offsets_s,
            seed: parameters.seed,
            periods: 0,
            acting: [BridgeState::RESET; AXES],
            driving: [BridgeState::RESET; AXES],
            latched_pose: [0.0; 3],
        };
        stage.latch();
        stage
    }

    /// Puts the machine at rest at a pose (m, m, rad) with freshly latched encoders, as if switched on there.
    pub fn set_pose_at_rest(&mut self, pose: [f64; 3]) {
        self.plant.set_pose_at_rest(pose);
        self.latch();
    }

    /// Runs one control period: the pins as the last call left them until the tick's duty acts, `pins` from there on.
    pub fn advance_period(&mut self, pins: [BridgeState; AXES]) {
        self.periods += 1;
        let now_s = self.periods as f64 * self.period_s;
        self.source_v = self.bus_parameters.source_v(self.supply_v, now_s);
        for part in OLD_DRIVE {
            self.substep(part);
        }
        self.advance_to_latch(pins);
        self.substep(AFTER_LATCH);
    }

    /// The frames that the next tick reads at the three ports, as an SPI master stores them.
    #[must_use]
    pub fn frames(&self) -> [[u8; 8]; AXES] {
        [0, 1, 2].map(|port| self.encoders[self.wiring.ring_at_port(port)].frame_bytes())
    }

    /// The encoder at a port.
    pub fn encoder_at(&mut self, port: usize) -> &mut Encoder {
        &mut self.encoders[self.wiring.ring_at_port(port)]
    }

    /// ADC counts of the motor currents and of the supply.
    #[must_use]
    pub fn analog(&self) -> ([u16; AXES], u16) {
        // Any mixing will do, as for the encoders.
        let number = self
            .seed
            .wrapping_mul(0x9e37_79b9)
            .wrapping_add(self.periods);
        let (currents, supply) = (self.analog).sample(
            self.wiring.at_bridges(self.sampled_currents_a()),
            self.bridge.supply_v,
            number,
        );
        let currents = [0, 1, 2].map(|i| self.stuck_currents[i].unwrap_or(currents[i]));
        (currents, self.stuck_supply.unwrap_or(supply))
    }

    /// From now on the converter of a bridge's current repeats its sample.
    pub fn stick_current_sensor(&mut self, bridge: usize) {
        self.stuck_currents[bridge] = Some(self.analog().0[bridge]);
    }

    /// From now on the converter of the supply repeats its sample.
    pub fn stick_supply_sensor(&mut self) {
        self.stuck_supply = Some(self.analog().1);
    }

    /// Currents of the windings as they are when their bridges' inputs are sampled, A.
    fn sampled_currents_a(&self) -> [f64; AXES] {
        let mut currents_a = self.plant.currents_a();
        if let Some(inductance_h) = self.rippling_h {
            for (ring, current_a) in currents_a.iter_mut().enumerate() {
                let at_s = self.analog.current_sampled_s[self.wiring.bridge_of(ring)];
                *current_a += self.driving[ring].ripple_a(&self.bridge, inductance_h, at_s);
            }
        }
        currents_a
    }

    /// Changes the supply, V, from now on.
    pub fn set_supply_v(&mut self, supply_v: f64) {
        self.supply_v = supply_v;
        self.source_v = supply_v;
        if self.bus.is_none() {
            self.set_bus_v(supply_v);
        }
    }

    /// Changes the supply's ripple, V to each side and Hz, from the next period on.
    pub const fn set_supply_ripple(&mut self, ripple_v: f64, ripple_hz: f64) {
        self.bus_parameters.ripple_v = ripple_v;
        self.bus_parameters.ripple_hz = ripple_hz;
    }

    /// The analog inputs, to be changed from now on.
    pub const fn analog_inputs(&mut self) -> &mut AnalogParameters {
        &mut self.analog
    }

    /// Exchanges the plugs of two encoders.
    pub fn exchange_encoders(&mut self, one: usize, other: usize) {
        self.wiring.port_of_ring.swap(one, other);
    }

    fn set_bus_v(&mut self, volts: f64) {
        self.bridge.supply_v = volts;
        self.plant.set_supply_v(volts);
    }

    /// The pin of the brake resistor, from the next period on.
    pub fn set_brake_resistor(&mut self, is_on: bool) {
        self.brake_resistor_is_on = is_on;
    }

    /// Whether that pin is on.
    #[must_use]
    pub const fn brake_resistor_is_on(&self) -> bool {
        self.brake_resistor_is_on
    }

    /// Breaks the brake resistor or its switch, or mends it.
    pub fn set_brake_resistor_fault(&mut self, fault: Option<BrakeResistorFault>) {
        self.brake_resistor_fault = fault;
    }

    fn brake_resistor_conducts(&self) -> bool {
        match self.brake_resistor_fault {
            None => self.brake_resistor_is_on,
            Some(BrakeResistorFault::Open) => false,
            Some(BrakeResistorFault::StuckOn) => true,
        }
    }

    /// The bus, where the supply is not ideal.
    #[must_use]
    pub const fn bus(&self) -> Option<&Bus> {
        self.bus.as_ref()
    }

    /// Which bridges pull their fault pins: those that have switched themselves off, or wake up.
    #[must_use]
    pub fn pulled_fault_pins(&self) -> [bool; AXES] {
        let Some(protection) = &self.protection else {
            return [false; AXES];
        };
        [0, 1, 2].map(|bridge| protection[self.wiring.ring_of_bridge(bridge)].pulls_fault_pin())
    }

    /// Temperatures of the bridges' junctions, deg C, where bridges have limits.
    #[must_use]
    pub fn junctions_c(&self) -> Option<[f64; AXES]> {
        let protection = self.protection.as_ref()?;
        let of = |bridge| &protection[self.wiring.ring_of_bridge(bridge)];
        Some([0, 1, 2].map(|bridge| of(bridge).junction_c(&self.bridge)))
    }

    /// True pose of the platform (m, m, rad) at the instant the encoders latched.
    #[must_use]
    pub const fn latched_pose(&self) -> [f64; 3] {
        self.latched_pose
    }

    /// Control period, s.
    #[must_use]
    pub const fn period_s(&self) -> f64 {
        self.period_s
    }

    fn advance_to_latch(&mut self, pins: [BridgeState; AXES]) {
        self.acting = pins;
        self.substep(TO_LATCH);
        self.latch();
    }

    fn substep(&mut self, part_of_period: f64) {
        let step_s = part_of_period * self.period_s;
        let currents_a = self.plant.currents_a();
        let mut pins = self.wiring.at_rings(self.acting);
        if let Some(bridges) = &mut self.protection {
            for (axis, bridge) in bridges.iter_mut().enumerate() {
                pins[axis] = bridge.pass(pins[axis], &self.bridge, currents_a[axis], step_s);
            }
        }
        self.driving = pins;
        let drives: [Drive; AXES] =
            [0, 1, 2].map(|axis| pins[axis].drive(&self.bridge, currents_a[axis]));
        self.plant.step(step_s, &drives);
        let (source_v, is_on) = (self.source_v, self.brake_resistor_conducts());
        let volts = if let Some(bus) = &mut self.bus {
            let drawn_a: f64 = (0..AXES).map(|i| pins[i].drawn_a(currents_a[i])).sum();
            bus.step(step_s, source_v, drawn_a, is_on);
            bus.volts()
        } else {
            self.bus_parameters.ideal_v(source_v, is_on)
        };
        self.set_bus_v(volts);
    }

    fn latch(&mut self) {
        self.latched_pose = self.plant.pose();
        let angles_rad = self.plant.pivots_rad();
        let rates_rad_s = self.plant.pivot_rates_rad_s();
        let mut offsets_s = [0.0; AXES];
        for (port, offset_s) in self.latch_offsets_s.into_iter().enumerate() {
            offsets_s[self.wiring.ring_at_port(port)] = offset_s;
        }
        for (axis, encoder) in self.encoders.iter_mut().enumerate() {
            let rate_rad_s = rates_rad_s[axis];
            // A tenth of a microsecond: over that a rate is what it is.
            encoder.latch(angles_rad[axis] + rate_rad_s * offsets_s[axis], rate_rad_s);
        }
    }
}

//! The power stage of the reference board: bridge, current sensor, bus and brake resistor in one table, from which the controller's
//! scales and thresholds, the simulator and the wiring page are made.

/// An H-bridge, by its data sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgePart {
    /// Name.
    pub name: &'static str,
    /// Supply that it works with, V.
    pub supply_v: [f64; 2],
    /// Supply that destroys it, V.
    pub absolute_supply_v: f64,
    /// Current at which it opens all switches, A. It stays so, fault pin low, until it has slept.
    pub trip_a: f64,
    /// Resistance of the two switches that carry the current, hot, ohm.
    pub resistance_ohm: f64,
    /// Time of an edge of its outputs, s.
    pub edge_s: f64,
    /// How much warmer than the air its junction settles for each watt, on the board, K/W.
    pub thermal_resistance_k_w: f64,
    /// Time in which it has gone two thirds of the way there, s.
    pub thermal_time_constant_s: f64,
    /// Temperature of its junction at which it opens all switches, deg C. It stays so, fault pin low, until it has cooled and slept.
    pub shutdown_c: f64,
    /// By how much it has to cool for that, K.
    pub shutdown_hysteresis_k: f64,
    /// Time from its sleep pin to its first pulse, s. Until then it may pull its fault pin.
    pub wake_s: f64,
    /// How long the controller waits for that: it gives no duty, and does not look at the fault pin, s.
    pub wake_grace_s: f64,
}

/// One DRV8262 (DDV package) for each motor, as a single bridge: both of its bridges in parallel, phase and enable.
///
/// Supply, absolute maximum, trip (32 A as a single bridge, 16 A as each of two) and resistance (104 mohm of one bridge at 150 deg C, two in
/// parallel) are those of data sheet SLVSFV5C as a library of parts quotes it with its pages; its own text was not at hand. The time
/// to wake is assumed. The grace is twice as long: data sheets give the time to wake without a tolerance over temperature and supply,
/// or as a typical value, and its charge pump starts from nothing. Nobody feels 2 ms at servo on.
///
/// Of its heat nothing is from that data sheet. The edge is that of its sister DRV8952 (data sheet SLOSE83, 140 ns, whose formula for what
/// edges lose is used). Shutdown and hysteresis are assumed as such parts have them, typically. Resistance and time constant are assumed
/// too: package and a few square centimetres of copper or a small heat sink, some 1 J/K.
pub const BRIDGE: BridgePart = BridgePart {
    name: "DRV8262",
    supply_v: [4.5, 60.0],
    absolute_supply_v: 70.0,
    trip_a: 32.0,
    resistance_ohm: 0.052,
    edge_s: 140e-9,
    thermal_resistance_k_w: 20.0,
    thermal_time_constant_s: 20.0,
    shutdown_c: 165.0,
    shutdown_hysteresis_k: 20.0,
    wake_s: 1e-3,
    wake_grace_s: 2e-3,
};

/// A shunt in series with a motor and its amplifier: it sees the current in every state of the bridge, with its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurrentSensor {
    /// Name of the amplifier.
    pub name: &'static str,
    /// Shunt, ohm.
    pub shunt_ohm: f64,
    /// Output over the voltage at the shunt.
    pub gain: f64,
    /// Output at no current, V.
    pub zero_v: f64,
}

/// INA240A1 (data sheet SBOS662C: 20 V/V within 0.2 %, offset 25 uV at most, common mode -4 to 80 V, 400 kHz), its output in the middle
/// of 3.3 V at no current, and a shunt of 10 mohm.
///
/// Not the mirror of the bridge: that one shows nothing while the low sides short the motor or while the motor drives the current, and
/// never a sign.
pub const CURRENT_SENSOR: CurrentSensor = CurrentSensor {
    name: "INA240A1",
    shunt_ohm: 0.01,
    gain: 20.0,
    zero_v: 1.65,
};

/// Bus between supply and bridges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bus {
    /// Nominal supply, V, and how far it is off at most, over itself.
    pub supply_v: f64,
    /// See above.
    pub supply_tolerance: f64,
    /// Capacitor, F.
    pub capacitor_f: f64,
    /// The supply's voltage over the counts' one at the converter.
    pub divider: f64,
    /// Brake resistor, ohm.
    pub resistor_ohm: f64,
    /// Power that it bears for long, W, and energy beyond that, J.
    pub resistor_w: f64,
    /// See above.
    pub resistor_j: f64,
    /// Voltages at which it is switched on and off again, V.
    pub resistor_on_v: f64,
    /// See above.
    pub resistor_off_v: f64,
    /// Voltage that is a fault, V.
    pub too_high_v: f64,
}

/// 4.7 mF behind a diode: what three motors give back in a stop goes into the resistor, and the bus stays in what the bridges bear.
pub const BUS: Bus = Bus {
    supply_v: 48.0,
    supply_tolerance: 0.05,
    capacitor_f: 4.7e-3,
    divider: 20.0,
    resistor_ohm: 8.2,
    resistor_w: 50.0,
    resistor_j: 500.0,
    resistor_on_v: 54.0,
    resistor_off_v: 52.0,
    too_high_v: 58.0,
};

/// Reference of the converter, V, and its counts.
const ADC_REFERENCE_V: f64 = 3.3;
const ADC_COUNTS: f64 = 4096.0;

/// Supply voltage of one count of the 12-bit ADC.
pub const SUPPLY_V_PER_COUNT: f64 = ADC_REFERENCE_V * BUS.divider / ADC_COUNTS;
/// Motor current of one count.
pub const CURRENT_A_PER_COUNT: f64 =
    ADC_REFERENCE_V / ADC_COUNTS / (CURRENT_SENSOR.shunt_ohm * CURRENT_SENSOR.gain);
/// Count of no current.
pub const CURRENT_ZERO_COUNTS: i16 = (CURRENT_SENSOR.zero_v / ADC_REFERENCE_V * ADC_COUNTS) as i16;
/// Most current that can be measured, A: the amplifier's output stays 0.2 V away from its supply.
pub const MOST_MEASURED_A: f64 = (ADC_REFERENCE_V - 0.2 - CURRENT_SENSOR.zero_v)
    / (CURRENT_SENSOR.shunt_ohm * CURRENT_SENSOR.gain);

/// Counts of a motor current with their sign, from what the converter says.
#[inline(always)]
pub const fn signed_current_counts(raw: u16) -> i16 {
    // Twelve bits: nothing wraps.
    raw as i16 - CURRENT_ZERO_COUNTS
}

/// The largest back-EMF of the reference motor: 0.06 V s/rad behind a gear of 50, a quarter faster than it may be.
const LARGEST_BACK_EMF_V: f64 = 0.06 * 50.0 * 12.5;
const WINDING_OHM: f64 = 2.1;
/// The PWM's frequency, and the warmest air that a board is made for.
const PWM_HZ: f64 = 40e3;
const WARMEST_AIR_C: f64 = 50.0;

// The supply fits the part with what comes back on top of it, and everything in between has its place.
const _: () = {
    let highest_supply_v = BUS.supply_v * (1.0 + BUS.supply_tolerance);
    assert!(BRIDGE.supply_v[0] < BUS.supply_v * (1.0 - BUS.supply_tolerance));
    assert!(highest_supply_v < BUS.resistor_off_v && BUS.resistor_off_v < BUS.resistor_on_v);
    assert!(BUS.resistor_on_v < BUS.too_high_v && BUS.too_high_v < BRIDGE.supply_v[1]);
    assert!(BRIDGE.supply_v[1] < BRIDGE.absolute_supply_v);
    // It drives, and its fault pin means a fault, before the controller counts on either.
    assert!(BRIDGE.wake_grace_s >= 1.5 * BRIDGE.wake_s);
    // The converter still sees what is too high.
    assert!(BUS.too_high_v < 0.95 * ADC_REFERENCE_V * BUS.divider);
    // The bridge bears a motor that is shorted at its largest speed, and one that is held under full voltage.
    assert!(LARGEST_BACK_EMF_V / WINDING_OHM < BRIDGE.trip_a);
    assert!(highest_supply_v / WINDING_OHM < BRIDGE.trip_a);
    // It bears for long all that can be measured of a current.
    let lost_w = BRIDGE.resistance_ohm * MOST_MEASURED_A * MOST_MEASURED_A
        + highest_supply_v * MOST_MEASURED_A * BRIDGE.edge_s * PWM_HZ;
    assert!(WARMEST_AIR_C + lost_w * BRIDGE.thermal_resistance_k_w < BRIDGE.shutdown_c);
    // The resistor takes more than three motors can give, 107 W each.
    assert!(BUS.resistor_on_v * BUS.resistor_on_v / BUS.resistor_ohm > 3.0 * 107.0);
};

//! How a bridge becomes warm.

use firmware::drivers::power_stage::BRIDGE;
use serde::{Deserialize, Serialize};

/// How a bridge becomes warm, and at which temperature it switches itself off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BridgeHeat {
    /// Resistance of the two switches that carry the current, ohm.
    pub resistance_ohm: f64,
    /// Time of an edge of its outputs, s.
    pub edge_s: f64,
    /// How much warmer than the air its junction settles for each watt that is lost in it, K/W.
    pub thermal_resistance_k_w: f64,
    /// Time in which it has gone two thirds of the way there, s.
    pub time_constant_s: f64,
    /// Air around it, deg C.
    pub air_c: f64,
    /// Temperature of the junction at which it opens all switches and pulls its fault pin, deg C.
    pub shutdown_c: f64,
    /// By how much it must have cooled before sleeping resets that, K.
    pub hysteresis_k: f64,
}

impl BridgeHeat {
    /// The part's, in a case beside motors that are warm.
    pub const REFERENCE: Self = Self {
        resistance_ohm: BRIDGE.resistance_ohm,
        edge_s: BRIDGE.edge_s,
        thermal_resistance_k_w: BRIDGE.thermal_resistance_k_w,
        time_constant_s: BRIDGE.thermal_time_constant_s,
        air_c: 35.0,
        shutdown_c: BRIDGE.shutdown_c,
        hysteresis_k: BRIDGE.shutdown_hysteresis_k,
    };
}

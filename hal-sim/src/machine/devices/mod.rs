//! The devices between plant and controller, as embedded-hal buses and pins, and as plain bits and levels.
//!
//! | file | idea |
//! |---|---|
//! | `stage` | the whole stage behind the wires, and the timeline of a period |
//! | `encoder`, `biss` | an absolute encoder, and the bits of its frame |
//! | `bridge` | an H-bridge: pins in, voltage out |
//! | `protection`, `bridge_heat` | what a bridge does by itself: trips, heat, waking up; how it becomes warm |
//! | `bus` | what lies between supply and bridges |
//! | `analog` | what the ADC reads |
//! | `watchdog` | what starts the controller again |
//! | `wiring` | which plug is in which socket |
//! | `flash` | where settings are kept |

pub mod analog;
pub mod biss;
mod bridge;
mod bridge_heat;
mod bus;
mod encoder;
mod flash;
mod protection;
mod stage;
mod watchdog;
mod wiring;

pub use analog::AnalogParameters;
pub use biss::COUNTS_PER_TURN;
pub use bridge::{
    Bridge, BridgeParameters, BridgePins, BridgeState, DirectionPin, FINE_PWM, FaultPin, MAX_DUTY,
    PwmPin, SleepPin,
};
pub use bridge_heat::BridgeHeat;
pub use bus::{BrakeResistorFault, Bus, BusParameters};
pub use encoder::{Encoder, EncoderFault, EncoderParameters};
pub use flash::{FlashError, SettingsFileError, SettingsFlash};
pub use protection::Protection;
pub use stage::{Stage, StageParameters};
pub use watchdog::{EARLY_WARNING_S, Reset, Watchdog};
pub use wiring::WiringParameters;

//! The devices between plant and controller, as embedded-hal buses and pins, and as plain bits and levels.

pub mod analog;
pub mod biss;
mod bridge;
mod encoder;
mod flash;
mod stage;

pub use bridge::{
    Bridge, BridgeParameters, BridgePins, BridgeState, DirectionPin, FINE_PWM, FaultPin, MAX_DUTY,
    PwmPin, SleepPin,
};
pub use encoder::{Encoder, EncoderFault, EncoderParameters};
pub use flash::{FlashError, SettingsFileError, SettingsFlash};
pub use stage::{Stage, StageParameters};

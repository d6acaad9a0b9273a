//! The control period in instructions.

/// Instructions a control period has at 168 MHz.
pub(super) const PERIOD_INSTRUCTIONS: f64 = 8_400.0;

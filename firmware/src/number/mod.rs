//! The tick's numbers: [`Fixed`] for positions, [`kinematics::Angle`] for angles, `f32` for rates and what follows them.
//!
//! An `f32` of a few radians is coarser than a quarter of an encoder LSB (DESIGN section 4), so nothing that ends in a
//! pivot setpoint may pass through one. A Cortex-M4 multiplies 32 by 32 bits into 64 in one instruction, as fast as its
//! FPU multiplies floats, so fixed point costs nothing here and has 29 fraction bits where a float has at most 24.
//! Rates, accelerations and torques are differences and corrections: there a float's range is worth more than its last bits.
//!
//! Everything here is integer arithmetic or a single correctly rounded IEEE operation: the chip and a desktop get the same
//! bits. No fused multiply-add, nothing from the platform's libm.

mod arcsine;
mod fixed;
mod multiply;
mod polar;
mod root;
mod trigonometric;

pub use fixed::Fixed;
pub(crate) use root::round;
pub use root::{cbrt_f32, sqrt_f32};

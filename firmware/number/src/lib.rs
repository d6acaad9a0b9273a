//! The tick's numbers: [`Fixed`] for positions, [`kinematics::Angle`] for angles, `f32` for rates and what follows
//! them.
//!
//! An `f32` of a few radians is coarser than a quarter of an encoder LSB, so nothing that ends in a
//! pivot setpoint may pass through one. A Cortex-M4 multiplies 32 by 32 bits into 64 in one instruction, as fast as its
//! FPU multiplies floats, so fixed point costs nothing here and has 29 fraction bits where a float has at most 24.
//! Rates, accelerations and torques are differences and corrections: there a float's range is worth more than its last
//! bits.
//!
//! | file | idea |
//! |---|---|
//! | `fixed`, `scalar` | the fixed-point number, and what the kinematics ask of it |
//! | `multiply`, `root` | products, square and cube roots: one instruction each where the chip has one |
//! | `trigonometric`, `arcsine`, `polar` | sine and cosine, and back |
//! | `float` | conversions and comparisons of floats that are cheap on the chip; the float that profiles are computed in |
//! | `wide_integer` | products and quotients of 128 bits |
//!
//! # The same bits on chip and desktop
//!
//! Tick and planning compute with nothing that may come out differently from machine to machine:
//!
//! | what could differ | why it does not |
//! |---|---|
//! | integers | wrapping or checked, of a stated width; `usize`, which is narrower on the chip, counts and indexes and enters no result |
//! | `+ - * /` and square root of `f32` | correctly rounded on both, to the nearest (the FPU starts so, and nothing changes its mode), subnormal numbers kept |
//! | `f64`, in planning | the same operations, correctly rounded by the compiler's own library on the chip and by the FPU of a desktop |
//! | fused multiply-add | Rust never makes one of `a * b + c`; `mul_add` is nowhere |
//! | elementary functions | those of this module, or of the crate `libm`, which is Rust and the same source everywhere; never those of the platform's C library |
//! | float to integer | `as` saturates, and makes 0 of what is no number, on both |
//! | order of evaluation | as written: Rust does not reorder sums of floats; no loop's order depends on the target, and nothing hashes or sorts by address |
//! | bits of what is no number | they do differ; a number gone wrong is tested for and goes no further |
//! | the four instructions in assembly | `multiply` and `root` have each beside its equal in Rust |
//!
//! `cargo chip` compares the chip's run with the host's at every tick by a hash of state, setpoints and duties
//! (the recorder's `RunningHash`); `cargo chip --ticks` does for as many ticks of motion from a seed, and with
//! `--flip` it shows that a single bit is found. How far all of it is from exact: tests `exactness`, `fifty_digits` and
//! `all_inputs`.
#![cfg_attr(not(test), no_std)]

pub mod float;
pub mod random;
pub mod wide_integer;

mod arcsine;
mod fixed;
mod multiply;
mod polar;
mod root;
mod scalar;
mod trigonometric;

pub use fixed::Fixed;
pub use root::round_ties_even;
pub use root::{cbrt_f32, sqrt_f32};
pub use trigonometric::{sin_cos_f32, sin_cos_short};

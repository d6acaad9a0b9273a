//! Elementary functions of one argument, over all the inputs that they can be given.
//!
//! `cargo test` takes each 1,009th; all of them, on all cores:
//!
//! ```sh
//! INPUTS=all cargo test --release -p firmware --test all_inputs -- --nocapture --test-threads 1
//! ```
//!
//! The reference is the host's functions for doubles, good to 1e-15: what is measured is a million times as much. A square root
//! has one right answer, and so has a conversion.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use firmware::number::{Fixed, cbrt_f32, sqrt_f32};
use kinematics::{Angle, Scalar};

const INPUTS: u64 = 1 << 32;
/// A prime: no bit of the input is left out.
const STRIDE: u64 = 1009;
/// Inputs that a core takes at a time.
const BLOCK: u64 = 1 << 26;

/// The largest error of a part of the inputs, and the input it came at.
#[derive(Clone, Copy, Default)]
struct Worst {
    error: f64,
    at: u32,
}

impl Worst {
    /// An error that is no number is as bad as can be.
    fn see(&mut self, error: f64, at: u32) {
        if !(error <= self.error) {
            *self = Self {
                error: if error.is_nan() { f64::INFINITY } else { error },
                at,
            };
        }
    }
}

/// The largest error over all inputs, or over the sample; `None` from `error` where the function has no answer to give.
fn worst(name: &str, error: impl Fn(u32) -> Option<f64> + Sync) -> Worst {
    let all = std::env::var("INPUTS").is_ok_and(|text| text == "all");
    let stride = if all { 1 } else { STRIDE };
    let next = AtomicU64::new(0);
    let work = || {
        let mut worst = Worst::default();
        let mut count = 0u64;
        loop {
            let block = next.fetch_add(BLOCK, Ordering::Relaxed);
            if block >= INPUTS {
                return (worst, count);
            }
            if all && block.is_multiple_of(INPUTS / 8) {
                println!("{name}: {} %", 100 * block / INPUTS);
            }
            let mut input = block.next_multiple_of(stride);
            while input < block + BLOCK {
                let at = input as u32;
                if let Some(error) = error(at) {
                    worst.see(error, at);
                    count += 1;
                }
                input += stride;
            }
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let parts: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        (threads.into_iter())
            .map(|thread| thread.join().expect("a worker"))
            .collect()
    });
    let count: u64 = parts.iter().map(|(_, count)| count).sum();
    let worst = (parts.into_iter().map(|(worst, _)| worst))
        .max_by(|a, b| a.error.total_cmp(&b.error))
        .unwrap_or_default();
    println!(
        "{name}: {count} inputs, worst error {:.3e} at {:#010x}",
        worst.error, worst.at
    );
    worst
}

#[test]
fn sine_and_cosine() {
    let worst = worst("sine and cosine", |fraction| {
        let (sine, cosine) = Fixed::sin_cos(Angle::from_units(fraction.into()));
        let exact = f64::from(fraction as i32) * (TAU / INPUTS as f64);
        let (exact_sine, exact_cosine) = exact.sin_cos();
        let errors = [sine.to_f64() - exact_sine, cosine.to_f64() - exact_cosine];
        Some(errors[0].abs().max(errors[1].abs()))
    });
    assert!(worst.error < 1.7e-9);
}

/// Near one the angle is as unsure as its sine's last bit makes it, 1 / cosine of it: so far it is measured across the radius.
#[test]
fn arcsine_and_its_cosine() {
    let worst_angle = worst("arcsine, up to 0.96", |bits| {
        let d = Fixed::from_bits(bits as i32);
        (d.to_f64().abs() <= 0.96).then(|| arcsine_error(d))
    });
    assert!(worst_angle.error < 2.8e-9);
    let worst_beyond = worst("arcsine beyond, times its cosine", |bits| {
        let d = Fixed::from_bits(bits as i32);
        let exact = d.to_f64();
        let inside = 0.96 < exact.abs() && exact.abs() < 1.0;
        inside.then(|| arcsine_error(d) * (1.0 - exact * exact).sqrt())
    });
    assert!(worst_beyond.error < 5.3e-10);
    let worst_cosine = worst("cosine of an arcsine, up to 0.96", |bits| {
        let d = Fixed::from_bits(bits as i32);
        (d.to_f64().abs() <= 0.96).then(|| cosine_error(d))
    });
    assert!(worst_cosine.error < 1.03e-9);
    let none_beyond = worst("arcsine of one and more", |bits| {
        let d = Fixed::from_bits(bits as i32);
        let beyond = d.to_f64().abs() >= 1.0;
        beyond.then(|| f64::from(u8::from(Fixed::asin_cos([d; 3]).is_some())))
    });
    assert_eq!(none_beyond.error, 0.0);
}

fn arcsine_error(d: Fixed) -> f64 {
    Fixed::asin_cos([d; 3]).map_or(f64::INFINITY, |[(angle, _), ..]| {
        let exact = d.to_f64().asin();
        assert!(exact.abs() <= FRAC_PI_2);
        (angle.radians() - exact).abs()
    })
}

fn cosine_error(d: Fixed) -> f64 {
    Fixed::asin_cos([d; 3]).map_or(f64::INFINITY, |[(_, cosine), ..]| {
        let exact = d.to_f64();
        (cosine.to_f64() - (1.0 - exact * exact).sqrt()).abs()
    })
}

/// On the chip it is one instruction, which IEEE 754 leaves no choice; here it has to be what the processor's own gives.
#[test]
fn square_root() {
    let worst = worst("square root, bits that differ", |bits| {
        let value = f32::from_bits(bits);
        let (ours, right) = (sqrt_f32(value), value.sqrt());
        let same = ours.to_bits() == right.to_bits() || ours.is_nan() && right.is_nan();
        Some(f64::from(u8::from(!same)))
    });
    assert_eq!(worst.error, 0.0);
}

#[test]
fn cube_root() {
    let worst = worst("cube root of positive normal numbers, relative", |bits| {
        let value = f32::from_bits(bits);
        let in_range = value.is_normal() && value > 0.0;
        in_range.then(|| (f64::from(cbrt_f32(value)) / f64::from(value).cbrt() - 1.0).abs())
    });
    assert!(worst.error < 1.73e-7);
}

#[test]
fn conversions() {
    let worst_float = worst("fixed to float, beyond half a last place", |bits| {
        let fixed = Fixed::from_bits(bits as i32);
        let nearest = fixed.to_f64() as f32;
        Some(f64::from(u8::from(
            fixed.to_f32().to_bits() != nearest.to_bits(),
        )))
    });
    assert_eq!(worst_float.error, 0.0);
    let worst_position = worst("fixed to position and back", |bits| {
        let fixed = Fixed::from_bits(bits as i32);
        let back = Fixed::from_position(fixed.to_position());
        Some(f64::from(u8::from(back != Some(fixed))))
    });
    assert_eq!(worst_position.error, 0.0);
}

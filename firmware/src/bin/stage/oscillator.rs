//! The rate of the watchdog's oscillator, which no two chips have in common, against the crystal: TIM5 captures its edges
//! (RM0090, 6.2.11).

use crate::clocks::TIM3_HZ;
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// Counts of TIM5 in a second: it has the bus of TIM3.
const TIM5_HZ: u32 = TIM3_HZ;
/// Code of its input 4: the oscillator.
const OSCILLATOR: u8 = 0b01;
/// One capture in so many edges, and the code of that.
const EDGES: u32 = 8;
const EDGES_CODE: u8 = 0b11;
/// How often to look for a capture: eight edges at 17 kHz are 0.5 ms, 80,000 cycles, and a look takes several.
const MAX_LOOKS: u32 = 80_000;

/// Lets the timer capture.
pub fn watch(tim: &pac::TIM5, rcc: &mut Rcc) {
    pac::TIM5::enable(rcc);
    // SAFETY: every code is an input.
    tim.or().write(|w| unsafe { w.it4_rmp().bits(OSCILLATOR) });
    (tim.ccmr2_input()).write(|w| w.cc4s().ti4().ic4psc().set(EDGES_CODE));
    tim.ccer().write(|w| w.cc4e().set_bit());
    tim.cr1().write(|w| w.cen().enabled());
}

/// Its rate, Hz: from one capture to the next, a millisecond at most. `None` when no edges come, after some.
pub fn rate_hz() -> Option<f64> {
    let first = next_capture()?;
    let counts = next_capture()?.wrapping_sub(first);
    (counts > 0).then(|| f64::from(EDGES) * f64::from(TIM5_HZ) / f64::from(counts))
}

/// The first capture from here on.
fn next_capture() -> Option<u32> {
    // SAFETY: nothing else reads this timer's captures: reading one clears its flag.
    let tim = unsafe { &*pac::TIM5::ptr() };
    tim.ccr4().read();
    let comes = (0..MAX_LOOKS).any(|_| tim.sr().read().cc4if().bit_is_set());
    comes.then(|| tim.ccr4().read().bits())
}

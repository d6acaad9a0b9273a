//! What the bench asks for, written into [`ORDER`] before the program looks: how many states, from which seed, which
//! parts.

use core::mem::MaybeUninit;

/// Longest name of a part that can be asked for.
const NAME: usize = 64;
/// Says that somebody has written an order: memory nobody wrote holds anything.
const WRITTEN: u32 = 0x434F_5354;

/// See the module. Words and bytes as they lie in memory.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Order {
    written: u32,
    /// Calls of every part; parts whose calls are short take a multiple of it.
    pub states: u32,
    /// Of all random arguments.
    pub seed: u32,
    named: u32,
    name: [u8; NAME],
}

/// The start-up code leaves this section as it is.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".uninit.ORDER")]
static mut ORDER: MaybeUninit<Order> = MaybeUninit::uninit();

impl Order {
    /// Without an order: enough states to see something, all parts.
    const DEFAULT: Self = Self {
        written: WRITTEN,
        states: 200,
        seed: 1,
        named: 0,
        name: [0; NAME],
    };

    /// The order, if there is one.
    pub fn read() -> Self {
        // SAFETY: words and bytes, of which any value is valid; nobody writes while the program runs.
        let order = unsafe { (&raw const ORDER).cast::<Self>().read_volatile() };
        if order.written == WRITTEN {
            order
        } else {
            Self::DEFAULT
        }
    }

    /// Whether a part is asked for: the order names none, or a piece of this one's name. What the counts are checked by
    /// always is.
    pub fn asks_for(&self, part: &str) -> bool {
        let asked = &self.name[..(self.named as usize).min(NAME)];
        asked.is_empty()
            || part.starts_with("known")
            || part
                .as_bytes()
                .windows(asked.len())
                .any(|piece| piece == asked)
    }
}

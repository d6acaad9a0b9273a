//! A part that panics, or runs out of stack, ends the run, and the table tells in which part.

use crate::table::COST;
use cortex_m_rt::{ExceptionFrame, exception};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    give_up()
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    give_up()
}

fn give_up() -> ! {
    COST.fail();
    loop {
        cortex_m::asm::wfi();
    }
}

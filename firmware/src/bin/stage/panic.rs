//! What happens when the program fails: the motors brake and the chip starts again, which the next reset cause tells.

use crate::pwm;
use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    pwm::cut();
    SCB::sys_reset()
}

/// Also where bus, usage and memory faults end up, a stack overflow among them.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    pwm::cut();
    SCB::sys_reset()
}

//! A panic: the motors coast, its place is kept, and the chip starts again.

use crate::{board, crash, pwm};
use cortex_m::peripheral::SCB;

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    pwm::cut();
    board::let_motors_coast();
    crash::keep_panic(info.location());
    SCB::sys_reset()
}

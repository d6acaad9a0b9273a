//! What a debugger does to a running machine.

use stm32f4xx_hal::pac;

/// Has the timers of the loop stand still while a debugger halts the core: the tick does not run then either, and a duty
/// that nobody corrects would stay. The window watchdog stands still with them, or no breakpoint could be looked at; the
/// independent one goes on and resets the chip, unless the debugger stops it. **Halt with the motors' supply off.**
///
/// The clock of the core goes on in sleep, so that a debugger can attach, and the counter that ticks are timed by counts
/// through the idle task's `wfi`.
pub fn halt_stops_the_motors(dbgmcu: &pac::DBGMCU) {
    dbgmcu.cr().modify(|_, w| w.dbg_sleep().set_bit());
    dbgmcu
        .apb1_fz()
        .modify(|_, w| w.dbg_tim3_stop().set_bit().dbg_wwdg_stop().set_bit());
    dbgmcu.apb2_fz().modify(|_, w| w.dbg_tim1_stop().set_bit());
}

//! Where the image may touch what the emulator does not model. Everything else fails the run.

use super::board::ChipBoard;
use rigless::session::Session;

/// One access that is known and harmless.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowed {
    /// The gap as the emulator names it: `instance.register` for one that no model implements, `0x...` for an address
    /// that no register covers.
    pub what: &'static str,
    /// Why it does no harm.
    pub reason: &'static str,
}

/// All of them.
pub const GAPS: &[Allowed] = &[
    Allowed {
        what: "WWDG.CR",
        reason: "the window watchdog never bites here; that it is started and fed is read back from its registers",
    },
    Allowed {
        what: "WWDG.CFR",
        reason: "as above",
    },
    Allowed {
        what: "SYSCFG.MEMRM",
        reason: "SRAM is at address 0 from the start; that the program has put it there is read back before its loop runs",
    },
];

/// Every gap of the run that is not allowed, in words.
pub fn unexpected(session: &Session<ChipBoard>) -> Vec<String> {
    let unmapped = session.unmapped().into_iter().map(|gap| {
        (
            format!("{:#010x}", gap.address),
            format!("{gap}: no register there"),
        )
    });
    let refused = session
        .refused()
        .iter()
        .map(|(address, fault)| (format!("{address:#010x}"), format!("refused: {fault}")));
    let unimplemented = session.unimplemented().values().map(|gap| {
        let what = format!("{}.{}", gap.instance, gap.register);
        let said = format!(
            "{what} has no model ({} reads, {} writes, first at {:#010x})",
            gap.reads, gap.writes, gap.program_counter
        );
        (what, said)
    });
    let undefined = session.undefined().iter().map(|(address, gap)| {
        let said = format!("{address:#010x}, in {}, is no register", gap.instance);
        (format!("{address:#010x}"), said)
    });
    let unrouted = session.unrouted().iter().map(|(instance, number)| {
        (
            format!("{instance}.{number}"),
            format!("interrupt {number} of {instance} goes nowhere"),
        )
    });
    let told = session.told().map(|told| {
        let what = format!("{}.{}", told.instance, told.register);
        (what.clone(), format!("{what}: {}", told.reason))
    });
    unmapped
        .chain(refused)
        .chain(unimplemented)
        .chain(undefined)
        .chain(unrouted)
        .chain(told)
        .filter(|(what, _)| !GAPS.iter().any(|allowed| allowed.what == what))
        .map(|(_, said)| said)
        .collect()
}

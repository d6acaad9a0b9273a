//! Where the retained memory lies: RAM that the start-up code leaves alone, as long as there is power.

use firmware::fault_record::RetainedMemory;

/// What it holds after a power-up is found out by its checks.
#[unsafe(link_section = ".uninit.RETAINED_MEMORY")]
pub static RETAINED_MEMORY: RetainedMemory = RetainedMemory::new();

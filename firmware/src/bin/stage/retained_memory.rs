//! Where the retained memory lies: in core-coupled memory, which the start-up code leaves alone, as long as there is power.

use firmware::fault_record::RetainedMemory;

/// What it holds after a power-up is found out by its checks.
#[unsafe(link_section = ".ccm.RETAINED_MEMORY")]
pub static RETAINED_MEMORY: RetainedMemory = RetainedMemory::new();

//! Where the black box lies: in memory that the start-up code leaves alone, as long as there is power.

use firmware::fault_record::BlackBox;

/// What it holds after a power-up is found out by its checks.
#[unsafe(link_section = ".uninit.BLACK_BOX")]
pub static BLACK_BOX: BlackBox = BlackBox::new();

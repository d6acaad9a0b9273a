//! What is not known of the chip without a board: three guesses at it.

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// Cycles that a read of the flash takes on top of the one that a read of RAM takes.
    pub wait_states: u64,
    /// Cycles in which the core's fetch starts anew after a jump to an aligned instruction, of ARM's `P` of 1 to 3; ARM's table does
    /// not say when it is which.
    pub refill: u64,
    /// Cycles that a load or store of the block of RAM in which the code lies waits for a fetch, or a fetch for it: they come over
    /// two buses, and the matrix lets one of them through at a time (RM0090, 2.1).
    pub shared_block: u64,
    /// Cycles of the entry in which the vector, which is in flash, is waited for: the registers are put on the stack meanwhile.
    pub vector: u64,
    /// Whether a jump drops the flash read that is under way for nothing.
    pub drops_reads: bool,
    /// Whether the accelerator's caches hold what the last tick left, or what came between has filled them.
    pub keeps_caches: bool,
    /// Whether the data cache is on: off while settings are written.
    pub data_cache: bool,
    /// What a read over the slow bus, APB1, takes more than one of RAM.
    pub apb1: u64,
    /// The same of the faster one, APB2.
    pub apb2: u64,
    /// What putting the registers of the floating-point unit on the stack takes, with the first instruction that uses it.
    pub lazy_stacking: u64,
    /// What a division of integers takes, 2 to 12 cycles.
    pub divide: u32,
    /// Whether the integer core runs on beside a division of the floating-point unit. Its erratum 776924 says that it does, far
    /// enough for an interrupt's first instructions.
    pub divides_beside: bool,
}

/// Wait states of the flash at 168 MHz and 3.3 V (RM0090, table 11).
const WAIT_STATES: u64 = 5;
/// 17 registers.
const LAZY_STACKING: u64 = 18;

impl Setting {
    /// What is most likely.
    pub const NOMINAL: Self = Self {
        name: "nominal",
        wait_states: WAIT_STATES,
        refill: 2,
        shared_block: 1,
        vector: 0,
        drops_reads: false,
        keeps_caches: false,
        data_cache: true,
        apb1: 9,
        apb2: 5,
        lazy_stacking: LAZY_STACKING,
        divide: 7,
        divides_beside: true,
    };

    /// What is possible at best.
    pub const OPTIMISTIC: Self = Self {
        name: "optimistic",
        refill: 1,
        shared_block: 0,
        drops_reads: true,
        keeps_caches: true,
        apb1: 6,
        apb2: 3,
        lazy_stacking: 0,
        divide: 2,
        ..Self::NOMINAL
    };

    /// What is possible at worst.
    pub const PESSIMISTIC: Self = Self {
        name: "pessimistic",
        refill: 3,
        // What had the block last is let through first the cycle after.
        shared_block: 2,
        vector: WAIT_STATES,
        apb1: 12,
        apb2: 8,
        divide: 12,
        divides_beside: false,
        ..Self::NOMINAL
    };

    /// All three, in the order of the table.
    pub const ALL: [Self; 3] = [Self::OPTIMISTIC, Self::NOMINAL, Self::PESSIMISTIC];

    /// The nominal one with a flash as fast as RAM.
    pub const WITHOUT_WAIT_STATES: Self = Self {
        name: "no wait states",
        wait_states: 0,
        shared_block: 0,
        ..Self::NOMINAL
    };

    /// The same while the flash is written, which has the data cache off.
    #[must_use]
    pub const fn writing(self) -> Self {
        Self {
            data_cache: false,
            ..self
        }
    }
}

//! One row of the table.

/// A part, counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Calls counted.
    pub calls: u32,
    /// Calls that were answered by a refusal.
    pub refused: u32,
    /// Instructions of a call on average.
    pub mean: f64,
    /// Instructions of the worst.
    pub worst: u32,
    /// Number of the worst call.
    pub worst_call: u32,
    /// Ticks of the plan that the worst call made; 0 where no plan is made.
    pub worst_ticks: u32,
    /// Ticks of the longest plan.
    pub most_ticks: u32,
}

/// Words of a row in the image's memory.
pub const ROW_WORDS: usize = 10;
/// The emulated cycle counter goes on by so much with every instruction.
const COUNTS_PER_INSTRUCTION: u32 = 2;

impl Part {
    /// From the words of a row, without its name.
    pub fn from_row(name: String, row: &[u32; ROW_WORDS]) -> Self {
        let [
            _,
            _,
            calls,
            refused,
            low,
            high,
            worst,
            worst_call,
            worst_ticks,
            most_ticks,
        ] = *row;
        let total = u64::from(high) << 32 | u64::from(low);
        let counts = f64::from(COUNTS_PER_INSTRUCTION);
        Self {
            name,
            calls,
            refused,
            mean: total as f64 / counts / f64::from(calls.max(1)),
            worst: worst / COUNTS_PER_INSTRUCTION,
            worst_call,
            worst_ticks,
            most_ticks,
        }
    }
}

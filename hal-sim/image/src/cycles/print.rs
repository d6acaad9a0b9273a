//! The table of uses, and where the cycles go.

use super::core::Cycles;
use super::limits::{Deadlines, GOAL};
use super::tally::{Row, Tally};
use std::fmt::Write;

/// Settings by name in the order of the columns.
pub struct Tallies {
    /// With a flash as fast as RAM.
    pub without: Tally,
    /// Optimistic, nominal, pessimistic.
    pub guesses: [Tally; 3],
}

impl Tallies {
    /// The one that counts.
    #[must_use]
    pub const fn nominal(&self) -> &Tally {
        &self.guesses[1]
    }

    /// Whether every use takes longer, in the mean, from guess to guess, and with the memories as they are than without their waits.
    #[must_use]
    pub fn are_in_order(&self) -> bool {
        let [optimistic, nominal, pessimistic] = &self.guesses;
        [
            (&self.without, nominal),
            (optimistic, nominal),
            (nominal, pessimistic),
        ]
        .iter()
        .all(|(less, more)| {
            (less.rows.iter().zip(&more.rows)).all(|(less, more)| less.mean() < more.mean())
        })
    }
}

/// The table; deadlines and period in cycles.
#[must_use]
pub fn print_cycles(tallies: &Tallies, deadlines: Deadlines, period: u64) -> String {
    let Deadlines { tick, latch } = deadlines;
    let mut text = format!(
        "cycles of a tick, from its interrupt until its duties are written, by a model of core and flash: no board was measured\n\
         deadline {tick} cycles, of the latch {latch}; the goal is {:.0} % of it nominally, and under 100 % pessimistically\n\
         whole: all that the longest tick does, the next setpoint among it; period {period} cycles\n\n",
        100.0 * GOAL,
    );
    let _ = writeln!(
        text,
        "{:<45}{:>6}{:>8}{:>10}{:>12}{:>39}{:>19}{:>28}",
        "",
        "",
        "instr.",
        "no waits",
        "optimistic",
        "nominal",
        "pessimistic",
        "whole, nominal, pessimistic"
    );
    let _ = writeln!(
        text,
        "{:<45}{:>6}{:>8}{:>10}{:>12}{:>8}{:>7}{:>7}{:>7}{:>10}{:>9}{:>10}{:>9}{:>9}{:>10}",
        "use",
        "ticks",
        "mean",
        "mean",
        "worst",
        "mean",
        "90 %",
        "99 %",
        "worst",
        "deadline",
        "worst",
        "deadline",
        "cycles",
        "cycles",
        "period"
    );
    let [optimistic, nominal, pessimistic] = &tallies.guesses;
    for (index, row) in nominal.rows.iter().enumerate() {
        let ticks = row.cycles.len();
        let share = |cycles: u64| 100.0 * cycles as f64 / deadlines.of(row.used) as f64;
        let worst = |tally: &Tally| tally.rows.get(index).map_or(0, Row::worst);
        let whole = pessimistic.rows.get(index).map_or(0, |row| row.whole);
        let _ = writeln!(
            text,
            "{:<45}{:>6}{:>8.0}{:>10.0}{:>12}{:>8.0}{:>7}{:>7}{:>7}{:>8.1} %{:>9}{:>8.1} %{:>9}{:>9}{:>8.1} %",
            row.name(),
            ticks,
            row.instructions as f64 / ticks.max(1) as f64,
            tallies.without.rows.get(index).map_or(0.0, Row::mean),
            worst(optimistic),
            row.mean(),
            row.quantile(0.90),
            row.quantile(0.99),
            row.worst(),
            share(row.worst()),
            worst(pessimistic),
            share(worst(pessimistic)),
            row.whole,
            whole,
            100.0 * whole as f64 / period as f64,
        );
    }
    text
}

/// A kind of cycles by name.
type Kind = (&'static str, fn(&Cycles) -> u64);

const KINDS: [Kind; 7] = [
    ("ARM's table", |it| it.table),
    ("floating-point results waited for", |it| it.float),
    ("refills after jumps", |it| it.refill),
    ("instructions waited for", |it| it.fetch),
    ("data waited for, flash or RAM that is fetched from", |it| {
        it.data
    }),
    ("peripherals", |it| it.peripherals),
    ("entry", |it| it.entry),
];

/// What a tick of one use spends its cycles on, in the mean.
#[must_use]
pub fn print_kinds(row: &Row) -> String {
    let mut text = format!(
        "{}: what a tick's cycles are spent on, nominally\n",
        row.name()
    );
    let ticks = row.cycles.len().max(1) as f64;
    for (name, of) in KINDS {
        let _ = writeln!(text, "{:>7.0}  {name}", of(&row.sum) as f64 / ticks);
    }
    let _ = writeln!(text, "{:>7.0}  all", row.mean());
    text
}

/// Places that wait most, cycles a tick: of so many ticks.
#[must_use]
pub fn print_places(title: &str, places: &[(String, Cycles)], ticks: usize) -> String {
    let mut text = format!(
        "{title}\n{:>7}{:>7}{:>7}{:>7}{:>7}  cycles a tick: all, of them waiting for instructions, data, jumps, results\n",
        "all", "instr.", "data", "jumps", "float"
    );
    let mean = |cycles: u64| cycles as f64 / ticks.max(1) as f64;
    for (name, cycles) in places {
        let _ = writeln!(
            text,
            "{:>7.1}{:>7.1}{:>7.1}{:>7.1}{:>7.1}  {name}",
            mean(cycles.all()),
            mean(cycles.fetch),
            mean(cycles.data),
            mean(cycles.refill),
            mean(cycles.float),
        );
    }
    text
}

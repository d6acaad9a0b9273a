//! A run of the image `cost`.

use super::driver::{CostDriver, End, LONGEST_NAME, Order};
use super::part::Part;
use crate::chip::board::{BoardKind, ChipBoard};
use crate::chip::{elf_file, gaps};
use drawing::Progress;
use rigless::emulator::{self, Start};
use rigless::image::Image;
use rigless::session::Session;
use rigless::symbols::Symbols;
use rigless::time::VirtualNanos;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

/// The image does not touch the clocks, so the core's runs at 16 MHz. At this rate of instructions one takes 125 ns, a whole
/// number of the emulator's units of time, and two counts of the cycle counter.
const INSTRUCTIONS_PER_SECOND: NonZeroU64 = NonZeroU64::new(8_000_000).unwrap();

/// Counts what no optimisation can change: these instructions a call.
const KNOWN: &str = "known: 2,001 instructions";
const KNOWN_INSTRUCTIONS: u32 = 2_001;
/// What a count may be off.
const EXACT_TO: u32 = 2;

/// A run that came to its end.
#[derive(Debug)]
pub struct Counted {
    /// The parts, in the image's order.
    pub parts: Vec<Part>,
    /// How long it took, s.
    pub wall_s: f64,
}

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// There is no image.
    #[error("no image: build it with `cargo cost-image` first")]
    NoImage,
    /// It can not be read or run.
    #[error("{}: {reason}", path.display())]
    Image {
        /// The image.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The name is longer than the image can take.
    #[error("--only: a name of more than {LONGEST_NAME} bytes")]
    Name,
    /// No part has that name.
    #[error("no part with `{0}` in its name")]
    NoPart(String),
    /// A part panicked or faulted.
    #[error("`{0}` panicked or faulted")]
    Failed(String),
    /// A call does not come back.
    #[error("a call does not come back after 240 million instructions")]
    Stuck,
    /// Image and program do not belong together.
    #[error(
        "the image's table has another form; is it older than the sources (`cargo cost-image` builds it)?"
    )]
    Strange,
    /// The counter is not what it is taken for.
    #[error("{KNOWN_INSTRUCTIONS} instructions are counted as {0}: no count can be believed")]
    Counter(u32),
    /// The image touched what the emulator does not model.
    #[error("the image touched what the emulator does not model: {0}")]
    Gaps(String),
}

/// Runs the image `cost` in the target folder by `order`.
///
/// # Errors
/// [`CostError`].
pub fn count(order: &Order, quiet: bool) -> Result<Counted, CostError> {
    if order.only.len() > LONGEST_NAME {
        return Err(CostError::Name);
    }
    let path = elf_file::built("cost").ok_or(CostError::NoImage)?;
    let progress = Progress::new(1, quiet);
    let begun = std::time::Instant::now();
    let parts = counted(&path, order, progress)?;
    Ok(Counted {
        parts,
        wall_s: begun.elapsed().as_secs_f64(),
    })
}

fn counted(path: &Path, order: &Order, progress: Progress) -> Result<Vec<Part>, CostError> {
    let bad = |reason: String| CostError::Image {
        path: path.to_owned(),
        reason,
    };
    let image = Image::read(path, None).map_err(|error| bad(error.to_string()))?;
    let symbols =
        Symbols::read(image.bytes(), |address| address).map_err(|error| bad(error.to_string()))?;
    let symbol = |name| symbols.get(name).map_err(|error| bad(error.to_string()));
    let driver = CostDriver {
        order: order.clone(),
        order_at: symbol("ORDER")?,
        table_at: symbol("COST")?,
        progress,
        ordered: false,
        parts: Vec::new(),
        end: End::default(),
        calls: 0,
        still: 0,
    };
    let board = ChipBoard::new(BoardKind::REFERENCE).map_err(|error| bad(error.to_string()))?;
    let session = Session::new(
        Box::new(board.at_rate(INSTRUCTIONS_PER_SECOND)),
        0,
        VirtualNanos(1),
    )
    .map_err(|error| bad(error.to_string()))?;
    let images = [image];
    let finished = emulator::run(session, &Start::new(&images), driver)
        .map_err(|error| bad(error.to_string()))?;
    let gaps = gaps::unexpected(&finished.session);
    let driver = finished.driver;
    driver.progress.finish();
    let last = driver.parts.last().map(|part| part.name.clone());
    match driver.end {
        End::Failed => Err(CostError::Failed(last.unwrap_or_default())),
        End::Stuck => Err(CostError::Stuck),
        End::Strange => Err(CostError::Strange),
        End::Done if !gaps.is_empty() => Err(CostError::Gaps(gaps.join("; "))),
        End::Done => believed(driver.parts, &order.only),
    }
}

/// The parts asked for, if the known one is what it should be.
fn believed(parts: Vec<Part>, only: &str) -> Result<Vec<Part>, CostError> {
    let known = parts.iter().find(|part| part.name == KNOWN);
    let counted = known.map_or(0, |part| part.worst);
    if counted.abs_diff(KNOWN_INSTRUCTIONS) > EXACT_TO {
        return Err(CostError::Counter(counted));
    }
    if parts.iter().all(|part| !part.name.contains(only)) {
        return Err(CostError::NoPart(only.to_owned()));
    }
    Ok(parts)
}

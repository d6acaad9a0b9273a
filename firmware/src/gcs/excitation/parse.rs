//! What lines about excitations mean.

use super::request::{ExcitationRequest, Shape};
use crate::control::excitation::{MAX_LINES, PERIOD_TICKS};
use crate::gcs::arguments::{ParseError, number, whole};
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::Scanner;

type Parsed = Result<Request, ParseError>;

/// Highest harmonic of a multisine: under half of the ticks of its period.
const MAX_HARMONIC: f64 = PERIOD_TICKS as f64 / 2.0 - 1.0;

/// `EXC STEP`: pivot, V, ms, and what ends it.
pub(in crate::gcs) fn step(scanner: &mut Scanner<'_>) -> Parsed {
    let pivot = pivot(scanner)?;
    let volts = number(scanner.next())?;
    until(pivot, Shape::Step { volts }, scanner)
}

/// `EXC RAMP`: pivot, V, ms, and what ends it.
pub(in crate::gcs) fn ramp(scanner: &mut Scanner<'_>) -> Parsed {
    let pivot = pivot(scanner)?;
    let volts = number(scanner.next())?;
    until(pivot, Shape::Ramp { volts }, scanner)
}

/// `EXC SINES`: pivot, V, ms, lowest and highest harmonic, how many.
pub(in crate::gcs) fn sines(scanner: &mut Scanner<'_>) -> Parsed {
    let pivot = pivot(scanner)?;
    let volts = number(scanner.next())?;
    let ms = number(scanner.next())?;
    let first = whole(scanner.next(), 1.0, MAX_HARMONIC)?;
    let last = whole(scanner.next(), first, MAX_HARMONIC)?;
    let lines = whole(scanner.next(), 1.0, MAX_LINES as f64)?;
    Ok(excite(ExcitationRequest {
        pivot,
        shape: Shape::Sines {
            volts,
            harmonics: [first, last].map(|harmonic| harmonic as u32),
            lines: lines as usize,
        },
        ms,
        until_mrad: None,
        until_a: None,
    }))
}

/// `EXC RING`: pivot, mrad, mrad/s, ms, and the current that ends it.
pub(in crate::gcs) fn ring(scanner: &mut Scanner<'_>) -> Parsed {
    let pivot = pivot(scanner)?;
    let mrad = number(scanner.next())?;
    let mrad_s = number(scanner.next())?;
    let ms = number(scanner.next())?;
    Ok(excite(ExcitationRequest {
        pivot,
        shape: Shape::Ring { mrad, mrad_s },
        ms,
        until_mrad: None,
        until_a: optional(scanner)?,
    }))
}

fn until(pivot: usize, shape: Shape, scanner: &mut Scanner<'_>) -> Parsed {
    Ok(excite(ExcitationRequest {
        pivot,
        shape,
        ms: number(scanner.next())?,
        until_mrad: optional(scanner)?,
        until_a: optional(scanner)?,
    }))
}

const fn excite(request: ExcitationRequest) -> Request {
    Request::Act(Action::Excite(request))
}

fn pivot(scanner: &mut Scanner<'_>) -> Result<usize, ParseError> {
    Ok(whole(scanner.next(), 1.0, 3.0)? as usize - 1)
}

fn optional(scanner: &mut Scanner<'_>) -> Result<Option<f64>, ParseError> {
    if scanner.is_at_end() {
        return Ok(None);
    }
    number(scanner.next()).map(Some)
}

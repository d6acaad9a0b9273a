//! How a stage comes to the end of a guide, and where that is: from what was recorded while a ring was moved on against it.
//!
//! Before, the ring's motor carries what friction takes. From the contact on the pivot hardly goes on along its guide, and the current rises with the force at the end,
//! which gives way under it: a straight line of place over current, whose place at the current of friction alone is that of the end without any force.

use crate::DRAWN;
use crate::accuracy::DISK;
use crate::kit::GUIDE_ENDS;
use crate::plan::CLEAR_OF_ENDS;
use crate::position::{Position, position, readings_rad};

/// How a ring is moved against an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Where the stage goes first: x, y (track radii), theta (rad).
    pub from: [f64; 3],
    /// The ring that is moved from there alone, from 0.
    pub ring: usize,
    /// By how much, until it is at the end as drawn, rad.
    pub by_rad: f64,
}

/// So far within the disk's rim, track radii: guides and zeros are not quite as drawn.
const ENTERED: f64 = 0.01;
/// Steps in which a ring is turned back from an end, rad, and how many at most.
const BACK_RAD: f64 = 0.02;
const MOST_BACK: u32 = 40;

/// How a stage comes to a pose (track radii, rad) at the end of a guide, which is out of its disk: by the smallest turn of one ring alone from
/// a pose within. `None` where there is none.
#[must_use]
pub fn approach(pose: &[f64; 3]) -> Option<Approach> {
    let touching = readings_rad(&DRAWN, pose).ok()?;
    let ways = (1..=MOST_BACK).flat_map(|steps| {
        let by_rad = f64::from(steps) * BACK_RAD;
        (0..3).flat_map(move |ring| [(ring, by_rad), (ring, -by_rad)])
    });
    ways.into_iter().find_map(|(ring, by_rad)| {
        let mut back = touching;
        back[ring] -= by_rad;
        let Position {
            pose: from,
            contacts,
            ..
        } = position(&DRAWN, &back).ok()?;
        let is_clear = contacts
            .iter()
            .all(|contact| CLEAR_OF_ENDS.contains(&contact.rho));
        let is_within = from[0].hypot(from[1]) < DISK - ENTERED;
        (is_clear && is_within).then_some(Approach { from, ring, by_rad })
    })
}

/// A row of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Readings of the encoders, rad.
    pub readings_rad: [f64; 3],
    /// Current of the ring's motor, A, positive where it presses.
    pub current_a: f64,
}

/// Why a record holds no contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ContactError {
    /// Nothing stopped the ring, or too late in the record.
    #[error("the ring came to no end")]
    None,
    /// Something did where this guide has no end.
    #[error("the ring was stopped where the guide has no end")]
    Elsewhere,
}

/// So far before the contact the ring moved freely, track radii along the guide.
const FREE: core::ops::Range<f64> = 2e-3..30e-3;
/// Current over that of friction from which it presses for certain, A.
const PRESSES_A: f64 = 0.1;
/// Fewest rows of either.
const FEWEST: usize = 10;
/// How far an end may be off the drawing, track radii.
const MOST_OFF: f64 = 30e-3;
/// Step of a reading for derivatives, rad.
const STEP_RAD: f64 = 1e-6;

/// Readings of the encoders, rad, at which the pivot of `guide` (from 0) just touches an end, the inner (0) or the outer (1), as the ring of
/// number `ring` comes there. Which end it is, and how ends give way, is seen well enough with the machine as drawn.
///
/// # Errors
/// [`ContactError`].
pub fn contact(
    rows: &[Pressed],
    (guide, end): (usize, usize),
    ring: usize,
) -> Result<[f64; 3], ContactError> {
    let largest =
        (rows.iter().enumerate()).max_by(|(_, a), (_, b)| a.current_a.total_cmp(&b.current_a));
    let last = largest.ok_or(ContactError::None)?.0;
    let places = (rows[..=last].iter())
        .map(|row| place(&row.readings_rad, guide))
        .collect::<Option<Vec<f64>>>()
        .ok_or(ContactError::Elsewhere)?;
    let free = rows
        .iter()
        .zip(&places)
        .filter(|(_, place)| FREE.contains(&(*place - places[last]).abs()));
    let (count, sum) = free.fold((0, 0.0), |(count, sum), (row, _)| {
        (count + 1, sum + row.current_a)
    });
    if count < FEWEST {
        return Err(ContactError::None);
    }
    let friction_a = sum / count as f64;
    let presses = |row: &Pressed| row.current_a - friction_a > PRESSES_A;
    let first = rows[..=last]
        .iter()
        .rposition(|row| !presses(row))
        .map_or(0, |before| before + 1);
    if last < first + FEWEST {
        return Err(ContactError::None);
    }
    let over = |row: usize| rows[row].current_a - friction_a;
    let unpressed = at_nothing((first..=last).map(|row| (over(row), places[row])));
    if (unpressed - GUIDE_ENDS[end]).abs() > MOST_OFF {
        return Err(ContactError::Elsewhere);
    }
    let mut readings_rad = rows[first].readings_rad;
    let slope = slope(&readings_rad, guide, ring).ok_or(ContactError::Elsewhere)?;
    readings_rad[ring] += (unpressed - places[first]) / slope;
    Ok(readings_rad)
}

/// Where a pivot is on its guide, track radii.
fn place(readings_rad: &[f64; 3], guide: usize) -> Option<f64> {
    Some(position(&DRAWN, readings_rad).ok()?.contacts[guide].rho)
}

/// What it changes by for each rad of a ring.
fn slope(readings_rad: &[f64; 3], guide: usize, ring: usize) -> Option<f64> {
    let moved = |by_rad: f64| {
        let mut readings_rad = *readings_rad;
        readings_rad[ring] += by_rad;
        place(&readings_rad, guide)
    };
    Some((moved(STEP_RAD)? - moved(-STEP_RAD)?) / (2.0 * STEP_RAD))
}

/// The value at 0 of the line through some points.
fn at_nothing(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let count = points.clone().count() as f64;
    let mean = |of: fn((f64, f64)) -> f64| points.clone().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|(x, _)| x), mean(|(_, y)| y));
    let (mut up, mut along) = (0.0, 0.0);
    for (at, value) in points {
        up += (at - x) * (value - y);
        along += (at - x).powi(2);
    }
    y - up / along * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit::{Instrument, Kit, Noise};
    use crate::plan::stops;

    /// A ring that comes along at a steady rate to an end that gives way, by the place on the guide and not by readings.
    fn record(guide: usize, end_at: f64, ring: usize) -> (Vec<Pressed>, [f64; 3]) {
        // At the end as it is.
        let theta: f64 = 0.4;
        let direction = theta + crate::model::GUIDES_RAD[guide];
        let pivot = direction + 0.1;
        let pose = [
            pivot.cos() - end_at * direction.cos(),
            pivot.sin() - end_at * direction.sin(),
            theta,
        ];
        let touching = readings_rad(&DRAWN, &pose).expect("in reach");
        let slope = slope(&touching, guide, ring).expect("in reach");
        let inwards = if end_at < 1.0 { -1.0 } else { 1.0 };
        let rows = (0..600).map(|row| {
            let t = f64::from(row - 400);
            // 10 um a row, then 0.15 um a row, and 2 mA for it.
            let (along, current_a) = if t < 0.0 {
                (1e-4 * t, 0.2)
            } else {
                (1.5e-6 * t, 0.2 + 2e-3 * t)
            };
            let mut readings_rad = touching;
            readings_rad[ring] += inwards * along / slope;
            // What is not quite steady.
            let wobble = if row % 2 == 0 { 4e-3 } else { -4e-3 };
            Pressed {
                readings_rad,
                current_a: current_a + wobble,
            }
        });
        // It lets go.
        let brakes = Pressed {
            readings_rad: touching,
            current_a: 0.0,
        };
        (rows.chain([brakes; 30]).collect(), touching)
    }

    #[test]
    fn the_end_is_where_it_is_without_force() {
        for (guide, end, end_at, ring) in [(0, 0, 0.163, 0), (1, 0, 0.158, 2), (2, 1, 1.838, 1)] {
            let (rows, touching) = record(guide, end_at, ring);
            let found = contact(&rows, (guide, end), ring).expect("a contact");
            let off = place(&found, guide).expect("in reach") - end_at;
            println!("{guide} {end}: off by {:.3} um", off * 1e5);
            assert!(off.abs() < 2e-6, "{off:e}");
            // Rings that were held are where they were.
            assert!((0..3).all(|k| k == ring || found[k] == touching[k]));
        }
    }

    #[test]
    fn a_record_without_a_contact_there_has_none() {
        let (rows, _) = record(0, 0.163, 0);
        assert_eq!(contact(&rows[..390], (0, 0), 0), Err(ContactError::None));
        assert_eq!(contact(&[], (0, 0), 0), Err(ContactError::None));
        assert_eq!(contact(&rows, (0, 1), 0), Err(ContactError::Elsewhere));
        let (rows, _) = record(0, 0.3, 0);
        assert_eq!(contact(&rows, (0, 0), 0), Err(ContactError::Elsewhere));
    }

    #[test]
    fn a_stage_comes_to_all_ends_from_within_its_disk() {
        let noise = Noise {
            length: 1e-5,
            angle_rad: 1e-5,
            encoder_rad: 1e-7,
        };
        let stops = stops(&Instrument::new(Kit::Ends, noise), 0, 200);
        let ways: Vec<_> = stops.iter().map(|stop| approach(&stop.pose)).collect();
        let furthest = ways
            .iter()
            .flatten()
            .map(|way| way.by_rad.abs())
            .fold(0.0, f64::max);
        println!(
            "{} of {}, by {furthest:.2} rad at most",
            ways.iter().flatten().count(),
            stops.len()
        );
        assert_eq!(ways.iter().flatten().count(), stops.len());
        for (stop, way) in stops.iter().zip(ways.into_iter().flatten()) {
            let mut there = readings_rad(&DRAWN, &way.from).expect("in reach");
            there[way.ring] += way.by_rad;
            let reached = crate::position::pose(&DRAWN, &there).expect("in reach");
            assert!((0..3).all(|k| (reached[k] - stop.pose[k]).abs() < 1e-9));
        }
    }
}

//! Zeros of the encoders from where the guides end, with no jig and no instrument.
//!
//! A ring that is moved alone comes to where one of the guides has reached an end: `rho_k(phi_1, phi_2, phi_3)` is what the drawing says of
//! that end, or nearly. Which guide it was nobody tells; the angles do, once the zeros are about right. So zeros are sought everywhere first, and each contact is taken
//! for that of the end which is nearest; from the best of what was found all is fitted: zeros, and the six ends within what they may be off.
//!
//! Zeros that are all turned alike are the same machine, turned: the first pivot's is taken to be right.

use crate::least_squares::minimise;
use kinematics::{Pose, direct, inverse};
use nalgebra::DVector;
use std::f64::consts::TAU;

/// What contacts say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideEnds {
    /// What each angle is told too large by, rad; 0 for the first.
    pub too_large_rad: [f64; 3],
    /// Standard deviation of the one that is known worst, as far as what is left over says, rad.
    pub deviation_rad: f64,
    /// What contacts and ends are off, over what they usually are: 0.1 mm and 0.5 mm where the track's radius is 100.
    pub left: f64,
    /// How many times as much the best other zeros leave.
    pub next_best: f64,
}

/// Why contacts say nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GuideEndsError {
    /// Two zeros cannot be found from so few.
    #[error("{0} contacts are too few for two zeros")]
    TooFew(usize),
    /// Not with any zeros do all contacts lie near the ends of guides.
    #[error("no zeros bring the contacts to the ends of the guides")]
    None,
}

/// How many angles of a turn are tried for each zero.
const TRIED: i32 = 90;
/// How many of the best of them are followed.
const FOLLOWED: usize = 12;
/// What is no more than wrong, however far off: track radii.
const FAR: f64 = 0.15;
/// How far ends may be off the drawing, and contacts off their ends, one standard deviation, track radii.
const END: f64 = 5e-3;
const CONTACT: f64 = 1e-3;
/// Zeros that are so near to each other are the same, rad.
const SAME_RAD: f64 = 0.05;
const STEPS: usize = 30;
const FEWEST: usize = 4;
const ENDS: usize = 6;

/// The zeros from told angles of the pivots at some contacts, rad, with `drawn` the inner and the outer end of a guide, track radii.
///
/// # Errors
/// [`GuideEndsError`].
pub fn guide_ends(contacts: &[[f64; 3]], drawn: [f64; 2]) -> Result<GuideEnds, GuideEndsError> {
    if contacts.len() < FEWEST {
        return Err(GuideEndsError::TooFew(contacts.len()));
    }
    let mut fits: Vec<Fit> = Vec::new();
    for zeros in tried(contacts, drawn) {
        if let Some(fit) = fit(contacts, drawn, zeros) {
            let same = |other: &&mut Fit| {
                (0..2).all(|k| turned(other.zeros[k] - fit.zeros[k]).abs() < SAME_RAD)
            };
            match fits.iter_mut().find(same) {
                Some(other) if fit.cost < other.cost => *other = fit,
                Some(_) => {}
                None => fits.push(fit),
            }
        }
    }
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let best = fits.first().ok_or(GuideEndsError::None)?;
    let next = fits.get(1).map_or(f64::INFINITY, |next| next.cost);
    Ok(GuideEnds {
        too_large_rad: [0.0, turned(best.zeros[0]), turned(best.zeros[1])],
        deviation_rad: best.deviation_rad,
        left: best.left,
        next_best: (next / best.cost).sqrt(),
    })
}

/// To within half a turn.
fn turned(angle_rad: f64) -> f64 {
    angle_rad - TAU * (angle_rad / TAU).round()
}

/// The zeros of a grid with which contacts lie best, the best first.
fn tried(contacts: &[[f64; 3]], drawn: [f64; 2]) -> Vec<[f64; 2]> {
    let at = |k: i32| TAU * f64::from(k) / f64::from(TRIED);
    let cost = |zeros: [f64; 2]| -> f64 {
        let off = |angles| off_nearest(angles, zeros, drawn);
        contacts.iter().map(|angles| off(angles).powi(2)).sum()
    };
    let grid = (0..TRIED).flat_map(|i| (0..TRIED).map(move |k| [at(i), at(k)]));
    let mut all: Vec<_> = grid.map(|zeros| (cost(zeros), zeros)).collect();
    all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    // Neighbours of what is followed already lead to the same.
    let mut followed: Vec<[f64; 2]> = Vec::new();
    for (_, zeros) in all {
        let near =
            |other: &[f64; 2]| (0..2).all(|k| turned(other[k] - zeros[k]).abs() < 1.5 * at(1));
        if !followed.iter().any(near) {
            followed.push(zeros);
        }
        if followed.len() == FOLLOWED {
            break;
        }
    }
    followed
}

/// Where the pivots are on their guides, track radii; `None` where no platform can be.
fn places(angles: &[f64; 3], zeros: [f64; 2]) -> Option<[f64; 3]> {
    let pivots = [angles[0], angles[1] - zeros[0], angles[2] - zeros[1]];
    let pose: Pose<f64> = direct(&pivots).ok()?;
    let guides = inverse(&pose).ok()?.guides;
    Some(guides.map(|guide| guide.rho()))
}

/// How far a contact is off the end that is nearest, and which that is: twice the guide, and one more for the outer.
fn nearest(places: &[f64; 3], drawn: [f64; 2]) -> (f64, usize) {
    let all = (0..ENDS).map(|end| (places[end / 2] - drawn[end % 2], end));
    all.min_by(|(a, _), (b, _)| a.abs().total_cmp(&b.abs()))
        .unwrap_or((FAR, 0))
}

/// The same for zeros that may be anything, up to [`FAR`]; no guide may be beyond its ends.
fn off_nearest(angles: &[f64; 3], zeros: [f64; 2], drawn: [f64; 2]) -> f64 {
    let Some(places) = places(angles, zeros) else {
        return FAR;
    };
    let beyond = places.map(|place| f64::max(drawn[0] - place, place - drawn[1]));
    let beyond = beyond.into_iter().fold(0.0, f64::max);
    let (off, _) = nearest(&places, drawn);
    f64::max(off.abs(), beyond).min(FAR)
}

struct Fit {
    zeros: [f64; 2],
    cost: f64,
    left: f64,
    deviation_rad: f64,
}

/// Zeros and ends from these zeros on: each contact is that of the end that is nearest now.
fn fit(contacts: &[[f64; 3]], drawn: [f64; 2], zeros: [f64; 2]) -> Option<Fit> {
    let mut at = DVector::zeros(2 + ENDS);
    (at[0], at[1]) = (zeros[0], zeros[1]);
    let mut best = None;
    // From far off some contacts are taken for another end's at first.
    for _ in 0..4 {
        let zeros = [at[0], at[1]];
        let touched: Vec<usize> = (contacts.iter())
            .map(|angles| Some(nearest(&places(angles, zeros)?, drawn).1))
            .collect::<Option<_>>()?;
        let off = |at: &DVector<f64>| {
            let offs = contacts.iter().zip(&touched).map(|(angles, &end)| {
                places(angles, [at[0], at[1]]).map_or(f64::INFINITY, |places| {
                    places[end / 2] - drawn[end % 2] - at[2 + end]
                })
            });
            offs.collect::<Vec<f64>>()
        };
        let residuals = |at: &DVector<f64>| {
            let contacts = off(at).into_iter().map(|off| off / CONTACT);
            let ends = (0..ENDS).map(|end| at[2 + end] / END);
            DVector::from_iterator(touched.len() + ENDS, contacts.chain(ends))
        };
        let minimum = minimise(&at, STEPS, residuals)?;
        let worst = [0, 1]
            .map(|k| minimum.covariance[(k, k)])
            .into_iter()
            .fold(0.0, f64::max);
        let freedoms = (contacts.len() + ENDS - at.len()) as f64;
        let left = (minimum.cost / freedoms).sqrt();
        best = Some(Fit {
            zeros: [minimum.at[0], minimum.at[1]],
            cost: minimum.cost,
            left,
            deviation_rad: worst.sqrt() * left.max(1.0),
        });
        at = minimum.at;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRAWN: [f64; 2] = [0.16, 1.84];
    const ZEROS: [f64; 3] = [0.4, 2.9, -1.7];
    /// Directions of the guides in the platform: -30, 90, 210 deg.
    const GUIDES_RAD: [f64; 3] = [-TAU / 12.0, TAU / 4.0, TAU * 7.0 / 12.0];

    /// Told angles where a ring, moved alone from a pose, comes to the first end, found by halving on `R sin(phi - theta) = n . c` and the
    /// lengths that follow, not by the product's inverse.
    fn contacts(centre: [f64; 2], ends: [[f64; 2]; 3]) -> Vec<[f64; 3]> {
        let [x, y] = centre;
        let start = GUIDES_RAD.map(|guide| {
            let guide = 0.3 + guide;
            guide + (y * guide.cos() - x * guide.sin()).asin()
        });
        let is_inside = |pivots: &[f64; 3]| {
            let Ok(pose) = direct::<f64>(pivots) else {
                return false;
            };
            (0..3).all(|i| {
                let guide = pose.theta + GUIDES_RAD[i];
                let along = (pivots[i].cos() - pose.x) * guide.cos()
                    + (pivots[i].sin() - pose.y) * guide.sin();
                (ends[i][0]..ends[i][1]).contains(&along)
            })
        };
        let mut all = Vec::new();
        for ring in 0..3 {
            for sign in [1.0, -1.0] {
                let moved = |by: f64| {
                    let mut pivots = start;
                    pivots[ring] += sign * by;
                    pivots
                };
                let mut by = 0.0;
                while is_inside(&moved(by + 0.01)) {
                    by += 0.01;
                }
                let mut step = 0.01;
                for _ in 0..40 {
                    step /= 2.0;
                    if is_inside(&moved(by + step)) {
                        by += step;
                    }
                }
                let pivots = moved(by);
                all.push([0, 1, 2].map(|i| pivots[i] + ZEROS[i]));
            }
        }
        all
    }

    /// What was told too large, beside the first.
    fn truth() -> [f64; 2] {
        [1, 2].map(|i| turned(ZEROS[i] - ZEROS[0]))
    }

    #[test]
    fn zeros_are_found_from_where_guides_end() -> Result<(), GuideEndsError> {
        for centre in [[0.0, 0.0], [0.25, 0.15], [-0.4, 0.0], [-0.2, 0.3]] {
            let found = guide_ends(&contacts(centre, [DRAWN; 3]), DRAWN)?;
            println!("{centre:?}: {found:?}");
            for k in 0..2 {
                assert!(turned(found.too_large_rad[k + 1] - truth()[k]).abs() < 1e-6);
            }
            assert!(found.left < 1e-4 && found.next_best > 5.0);
        }
        Ok(())
    }

    #[test]
    fn ends_that_are_off_the_drawing_are_found_beside_them() -> Result<(), GuideEndsError> {
        let ends = [[0.163, 1.836], [0.155, 1.844], [0.161, 1.842]];
        let mut all = contacts([0.25, 0.15], ends);
        all.extend(contacts([0.0, 0.0], ends));
        let found = guide_ends(&all, DRAWN)?;
        println!("{found:?}");
        for k in 0..2 {
            assert!(turned(found.too_large_rad[k + 1] - truth()[k]).abs() < 3e-3);
        }
        assert!(found.deviation_rad < 3e-3 && found.left < 1.0);
        Ok(())
    }

    #[test]
    fn contacts_that_are_none_leave_more_than_any_end_may_be_off() {
        let mut all = contacts([0.25, 0.15], [DRAWN; 3]);
        // A ring that was stopped by something else, half way.
        all[0][0] -= 0.5;
        let found = guide_ends(&all, DRAWN);
        println!("{found:?}");
        assert!(found.is_ok_and(|found| found.left > 3.0 && found.next_best < 3.0));
        assert_eq!(guide_ends(&all[..3], DRAWN), Err(GuideEndsError::TooFew(3)));
    }
}

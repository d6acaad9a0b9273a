//! The platform is turned by hand, out of the middle, with the motors off: the only thing that no voltage can find out.
//!
//! Each encoder counts up or down, which tells whether it is reversed. And since the platform is out of the middle, the pivots do not
//! turn by the same angle: `R sin(phi_i - theta_i) = n_i . v` (DESIGN, the guides' lines), so that what pivot i departs from the mean of
//! all is a sine of `gamma - theta_i`, a third of a period from pivot to pivot. As the platform turns left these three turn as a vector
//! to the right when pivots 1, 2, 3 follow each other to the left, and to the left when they follow each other to the right.

use crate::commission::Task;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id::AXES;
use crate::commission::known::Known;

type Complex = nalgebra::Complex<f64>;

/// Time that the person has, and how often is looked, s.
const PATIENCE_S: f64 = 60.0;
const LOOK_S: f64 = 0.1;
/// A quarter of a turn, give or take a third of it, rad.
const TURN_RAD: [f64; 2] = [1.05, 2.1];
/// Looks without motion that end it, and what is none, rad.
const QUIET_LOOKS: usize = 8;
const QUIET_RAD: f64 = 2e-3;
/// Share of the next one's turn under which an encoder does not follow: by geometry it is two thirds at least.
const BEHIND: f64 = 0.6;
/// Turn after which it is one, rad.
const BEGUN_RAD: f64 = 0.1;
/// Least that the pivots have to depart from their mean, rad, and by how much the one order has to fit better than the other.
const LEAST_DEPARTURE_RAD: f64 = 0.08;
const LEAST_CONTRAST: f64 = 2.5;
const ADVICE: &str = "try it again: out of the middle first, then left by a quarter of a turn, slowly, and the middle stays where it is";

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    bench.request(Task::Turn)?;
    let path = follow(bench)?;
    let (first, last) = (path[0], path[path.len() - 1]);
    let ways = [0, 1, 2].map(|i| last[i] - first[i]);
    for (port, way) in (1..).zip(ways) {
        found.push(Finding::new(
            format!("encoder at port {port}"),
            format!("{:+.0} deg", way.to_degrees()),
            format!("{:.0} to {:.0}, up or down", TURN_RAD[0].to_degrees(), TURN_RAD[1].to_degrees()),
            (TURN_RAD[0]..TURN_RAD[1]).contains(&way.abs()),
            "if one does not follow the others, its coupling or its gear wheel slips; else try it again, a quarter of a turn",
        ));
    }
    known.reversed_at_port = ways.map(|way| way < 0.0);
    let order = order(&path, &known.reversed_at_port);
    known.ports_follow_left = order.follows_left;
    found.push(Finding::new(
        "how far out of the middle",
        format!("{:.0} % of the track's radius", order.departure_rad * 100.0),
        format!("over {:.0} %", LEAST_DEPARTURE_RAD * 100.0),
        order.departure_rad > LEAST_DEPARTURE_RAD,
        ADVICE,
    ));
    let numbers = if order.follows_left {
        "1, 2, 3"
    } else {
        "1, 3, 2"
    };
    found.push(Finding::new(
        format!("to the left the ports follow each other as {numbers}, against the other order"),
        format!("{:.1} times as near", order.contrast),
        format!("over {LEAST_CONTRAST}"),
        order.contrast > LEAST_CONTRAST,
        ADVICE,
    ));
    Ok(())
}

/// Angles while the person turns the platform, from where it has been pushed out of the middle.
fn follow(bench: &mut Bench<'_>) -> Result<Vec<[f64; AXES]>, CommissionError> {
    let mut path = vec![bench.pivots_rad()?];
    let (mut quiet, mut passed_s) = (0, 0.0);
    while passed_s < PATIENCE_S {
        bench.delay(LOOK_S)?;
        passed_s += LOOK_S;
        let (now, before) = (bench.pivots_rad()?, path[path.len() - 1]);
        let moved = (0..AXES)
            .map(|i| (now[i] - before[i]).abs())
            .fold(0.0, f64::max);
        quiet = if moved < QUIET_RAD { quiet + 1 } else { 0 };
        path.push(now);
        let way = (0..AXES)
            .map(|i| (now[i] - path[0][i]).abs())
            .fold(f64::INFINITY, f64::min);
        if way > TURN_RAD[0] && quiet >= QUIET_LOOKS {
            return Ok(path);
        }
    }
    let ways = [0, 1, 2].map(|i| (path[path.len() - 1][i] - path[0][i]).to_degrees());
    let mut ports = [0, 1, 2];
    ports.sort_by(|a, b| ways[*a].abs().total_cmp(&ways[*b].abs()));
    let [least, next, most] = ports;
    if ways[least].abs() < BEHIND * ways[next].abs() {
        return fail(
            format!(
                "the encoder at port {} has turned by {:.0} deg, the others by {:.0} and {:.0}",
                least + 1,
                ways[least],
                ways[next],
                ways[most]
            ),
            "its coupling or its gear wheel slips, or it is not coupled to its ring, or another machine's",
        );
    }
    fail(
        format!(
            "the encoders have turned by {:.0}, {:.0} and {:.0} deg in {PATIENCE_S} s: no quarter of a turn",
            ways[0], ways[1], ways[2]
        ),
        "turn the platform; if it cannot be turned, its ring, carriage or guide is jammed",
    )
}

/// How the departures from the mean turn.
struct Order {
    /// Whether against the platform: pivots 1, 2, 3 follow each other to the left.
    follows_left: bool,
    /// What the wrong order leaves over what the right one does.
    contrast: f64,
    /// How far the pivots depart from their mean, rad.
    departure_rad: f64,
}

/// Fits `c + A e^(s i theta)` to the departures, for s of both signs: c is what the zeros make of them, and the sign that fits better is
/// the order.
fn order(path: &[[f64; AXES]], reversed: &[bool; AXES]) -> Order {
    let angles = path
        .iter()
        .map(|angles| [0, 1, 2].map(|i| if reversed[i] { -angles[i] } else { angles[i] }));
    let start = angles.clone().next().map_or(0.0, mean);
    // What comes before it turns is the push out of the middle.
    let turning: Vec<(f64, Complex)> = angles
        .map(|angles| {
            let [one, two, three] = angles;
            let departure = Complex::new(
                (2.0 * one - two - three) / 3.0,
                (two - three) / 3.0_f64.sqrt(),
            );
            (mean(angles) - start, departure)
        })
        .filter(|(theta, _)| *theta > BEGUN_RAD)
        .collect();
    let [(left, amplitude_left), (right, amplitude_right)] =
        [-1.0, 1.0].map(|sign| fit(&turning, sign));
    let follows_left = left < right;
    let (good, bad, amplitude) = if follows_left {
        (left, right, amplitude_left)
    } else {
        (right, left, amplitude_right)
    };
    Order {
        follows_left,
        contrast: (bad / good.max(f64::MIN_POSITIVE)).sqrt(),
        departure_rad: amplitude,
    }
}

fn mean(angles: [f64; AXES]) -> f64 {
    angles.iter().sum::<f64>() / AXES as f64
}

/// What is left of the squares, and the size of A.
fn fit(points: &[(f64, Complex)], sign: f64) -> (f64, f64) {
    let count = points.len().max(1) as f64;
    let turned = |theta: f64| Complex::from_polar(1.0, sign * theta);
    let middle = points.iter().map(|(_, z)| z).sum::<Complex>() / count;
    let of_turns = points
        .iter()
        .map(|(theta, _)| turned(*theta))
        .sum::<Complex>()
        / count;
    let product: Complex = points
        .iter()
        .map(|(theta, z)| (z - middle) * (turned(*theta) - of_turns).conj())
        .sum();
    let square: f64 = points
        .iter()
        .map(|(theta, _)| (turned(*theta) - of_turns).norm_sqr())
        .sum();
    let amplitude = product / square.max(f64::MIN_POSITIVE);
    let left = points
        .iter()
        .map(|(theta, z)| (z - middle - amplitude * (turned(*theta) - of_turns)).norm_sqr())
        .sum();
    (left, amplitude.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pivots of a platform held out of the middle, by the mechanism's equation and not by the product's kinematics.
    fn path(left: bool, out: f64) -> Vec<[f64; AXES]> {
        (0..=30)
            .map(|k| {
                let theta = f64::from(k) * 0.05;
                [0, 1, 2].map(|i| {
                    let at = if left { i } else { (3 - i) % 3 };
                    let guide = theta + f64::from(at) * std::f64::consts::TAU / 3.0;
                    // Unknown zeros.
                    guide + (out * (0.7 - guide).sin()).asin() + f64::from(i)
                })
            })
            .collect()
    }

    #[test]
    fn the_order_of_the_pivots_shows_while_the_platform_turns() {
        for out in [0.1, 0.2, 0.4] {
            for left in [true, false] {
                let found = order(&path(left, out), &[false; AXES]);
                println!(
                    "{out}: {left} {:.1} times, {:.3}",
                    found.contrast, found.departure_rad
                );
                assert!(found.follows_left == left && found.contrast > 5.0);
                assert!((found.departure_rad / out - 1.0).abs() < 0.2);
            }
        }
    }
}

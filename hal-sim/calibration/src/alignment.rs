//! Where an instrument stands and where its target is, roughly, from what it has measured of the machine as drawn: so the fit may
//! start with an instrument that somebody has turned by any angle.

use kinematics::direct;

use crate::kit::Instrument;
use crate::least_squares::Problem;
use crate::position::within_half_turn;
use crate::visit::{Seen, Visit};

/// The instrument with its alignment guessed; as it was, where the visits do not tell.
///
/// With the instrument's angle b and origin o and the target at t, places are linear in `cos b`, `sin b`, `h = R(-b) t` and
/// `g = -R(-b) o`: `R(-b) C + R(theta) h + g`.
#[must_use]
pub fn aligned(instrument: &Instrument, visits: &[Visit]) -> Instrument {
    let mut instrument = instrument.clone();
    let mut places = Problem::without_priors(6);
    let (mut turn_sin, mut turn_cos) = (0.0, 0.0);
    let mut put = |row: [f64; 6], measured: f64| {
        for (unknown, value) in row.into_iter().enumerate() {
            places.set(unknown, value);
        }
        places.end_row(measured);
    };
    for Visit { readings_rad, seen } in visits {
        let Ok(drawn) = direct::<f64>(readings_rad) else {
            continue;
        };
        let (place, turn) = match *seen {
            Seen::Pose([x, y, theta]) => (Some([x, y]), Some(theta)),
            Seen::Place(place) => (Some(place), None),
            Seen::Turn(theta) => (None, Some(theta)),
            Seen::Mark { .. } | Seen::End { .. } => (None, None),
        };
        if let Some([x, y]) = place {
            let (sin, cos) = drawn.theta.sin_cos();
            put([drawn.x, drawn.y, cos, -sin, 1.0, 0.0], x);
            put([drawn.y, -drawn.x, sin, cos, 0.0, 1.0], y);
        }
        if let Some(theta) = turn {
            let (sin, cos) = (theta - drawn.theta).sin_cos();
            turn_sin += sin;
            turn_cos += cos;
        }
    }
    if let Some(solved) = places.factor().step()
        && let [b_cos, b_sin, h_x, h_y, g_x, g_y] = solved.as_slice()
        && solved.iter().all(|number| number.is_finite())
    {
        let angle_rad = b_sin.atan2(*b_cos);
        let (sin, cos) = angle_rad.sin_cos();
        let turned = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
        let ([o_x, o_y], [t_x, t_y]) = (turned(-g_x, -g_y), turned(*h_x, *h_y));
        instrument.alignment = [o_x, o_y, angle_rad, t_x, t_y, 0.0];
    }
    if turn_sin != 0.0 || turn_cos != 0.0 {
        let [_, _, angle_rad, _, _, target_rad] = &mut instrument.alignment;
        *target_rad = within_half_turn(turn_sin.atan2(turn_cos) + *angle_rad);
    }
    instrument
}

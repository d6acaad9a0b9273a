//! Numbers to and from whoever reads an instrument, be it a program or a person.

use calibration::plan::At;
use calibration::{Instrument, Kit, Seen};
use kinematics::Geometry;

use super::measure::Wanted;

const UM_PER_MM: f64 = 1e3;

/// The numbers that whoever reads an instrument gets, in one line: x_mm y_mm theta_deg of where the stage was sent; for cameras mark_x_mm mark_y_mm
/// camera_x_mm camera_y_mm besides, for balls the ball's place and the gauges'.
#[must_use]
pub fn question(instrument: &Instrument, wanted: &Wanted) -> String {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    let [x, y, theta_rad] = wanted.pose;
    let mut values = vec![x * radius_mm, y * radius_mm, theta_rad.to_degrees()];
    if let At::Mark { mark, camera } = wanted.at {
        let drawn = [instrument.marks.get(mark), instrument.cameras.get(camera)];
        let drawn = drawn.into_iter().flatten().flatten();
        values.extend(drawn.map(|value| value * radius_mm));
    }
    let words: Vec<String> = values.iter().map(|value| format!("{value:.9}")).collect();
    words.join(" ") + "\n"
}

/// What such a text says: x_mm y_mm theta_deg, or x_mm y_mm, or theta_deg, or of a mark or ball off_x_um off_y_um, by the instrument. None where it
/// is no reading of this one.
#[must_use]
pub fn reading(instrument: &Instrument, at: At, text: &str) -> Option<Seen> {
    let values: Option<Vec<f64>> = (text.split([' ', ',', '\t']))
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().ok().filter(|value: &f64| value.is_finite()))
        .collect();
    seen(instrument, at, &values?)
}

/// What a reading of this instrument consists of.
#[must_use]
pub const fn fields(kit: Kit) -> &'static str {
    match kit {
        Kit::Xyt => "x_mm y_mm theta_deg",
        Kit::Xy => "x_mm y_mm",
        Kit::Theta => "theta_deg",
        Kit::Camera | Kit::Camera2 | Kit::Balls => "off_x_um off_y_um",
        Kit::Ends => "",
    }
}

fn seen(instrument: &Instrument, at: At, values: &[f64]) -> Option<Seen> {
    let radii = |mm: f64| mm / Geometry::REFERENCE.radius_mm;
    match (instrument.kit, at, values) {
        (Kit::Xyt, _, &[x, y, theta]) => Some(Seen::Pose([radii(x), radii(y), theta.to_radians()])),
        (Kit::Xy, _, &[x, y]) => Some(Seen::Place([radii(x), radii(y)])),
        (Kit::Theta, _, &[theta]) => Some(Seen::Turn(theta.to_radians())),
        (Kit::Camera | Kit::Camera2 | Kit::Balls, At::Mark { mark, camera }, &[x_um, y_um]) => {
            let off = [radii(x_um / UM_PER_MM), radii(y_um / UM_PER_MM)];
            Some(Seen::Mark { mark, camera, off })
        }
        _ => None,
    }
}

//! `tripivot map`: a quantity over the disk.

use std::path::Path;
use std::process::ExitCode;

use kinematics::{Geometry, Guide, Pose, dexterity, inverse, margins};

use super::arguments::{Map, Quantity};
use super::error::CliError;
use drawing::{write_file, write_png};
use hal_sim::report::{ContourMap, contour_map};

pub(super) fn run(arguments: &Map) -> Result<ExitCode, CliError> {
    let ending = Ending::of(&arguments.out)?;
    if !arguments.theta.is_finite() {
        return Err(CliError::Value(format!(
            "--theta {}: not an angle",
            arguments.theta
        )));
    }
    let svg = draw(arguments.quantity, arguments.theta);
    match ending {
        Ending::Svg => write_file(&arguments.out, svg.as_bytes())?,
        Ending::Png => write_png(&arguments.out, &svg)?,
    }
    Ok(ExitCode::SUCCESS)
}

enum Ending {
    Svg,
    Png,
}

impl Ending {
    fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(CliError::Ending(path.to_owned())),
        }
    }
}

fn draw(quantity: Quantity, theta_deg: f64) -> String {
    let value = |x: f64, y: f64| {
        let theta = theta_deg.to_radians();
        value_at(quantity, &Pose { x, y, theta }).unwrap_or(f64::NAN)
    };
    let (name, unit, levels, decimals): (_, _, &[f64], _) = match quantity {
        Quantity::Dexterity => (
            "Dexterity",
            "dexterity",
            &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.94],
            2,
        ),
        Quantity::Rate => (
            "Fastest pivot per platform speed",
            "rad/s per track radius a second",
            &[1.02, 1.05, 1.1, 1.15, 1.2, 1.3, 1.4, 1.6, 2.0, 3.0],
            2,
        ),
        Quantity::Separation => (
            "Smallest separation of the pivots",
            "deg",
            &[
                10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0, 110.0,
            ],
            0,
        ),
    };
    contour_map(&ContourMap {
        title: format!("{name} at \u{3b8} = {theta_deg}\u{b0}"),
        quantity: unit,
        levels,
        decimals,
        value: &value,
        geometry: Geometry::REFERENCE,
    })
}

/// `None` on and outside the track.
fn value_at(quantity: Quantity, pose: &Pose<f64>) -> Option<f64> {
    let guides = inverse(pose).ok()?.guides;
    match quantity {
        Quantity::Dexterity => Some(dexterity(&guides)),
        Quantity::Rate => Some(fastest_pivot(&guides)),
        Quantity::Separation => {
            let geometry = Geometry::REFERENCE;
            let margin_rad = margins(&geometry, pose).ok()?.separation_rad;
            Some((margin_rad + geometry.separation_rad).to_degrees())
        }
    }
}

/// Motion straight across guide i turns its pivot by 1 / c_i; no direction turns one faster.
fn fastest_pivot(guides: &[Guide<f64>; 3]) -> f64 {
    (guides.iter()).fold(0.0, |fastest: f64, guide| fastest.max(1.0 / guide.cosine))
}

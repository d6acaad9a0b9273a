//! Sizes of the drawn mechanism, for pictures and for the page: of its parts that have no size in the model, in track radii.

use serde::Serialize;

/// See the module. The page has them under the same names in its own spelling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Sizes {
    /// Directions of the guides from the platform's own x axis, deg.
    pub guides_deg: [f64; 3],
    /// Width of the track.
    pub track_width: f64,
    /// Its least width, px.
    pub track_least_px: f64,
    /// Width of a guide.
    pub guide_width: f64,
    /// Its least width, px.
    pub guide_least_px: f64,
    /// Width of its open part less than the whole, px.
    pub guide_walls_px: f64,
    /// How far a corner of the platform lies beyond the start of its guide.
    pub corner_beyond_start: f64,
    /// End of the arrow's shaft, from the centre.
    pub arrow_shaft: f64,
    /// Tip of the arrow.
    pub arrow_tip: f64,
    /// Back of the arrow's head.
    pub arrow_back: f64,
    /// Half the width of its head.
    pub arrow_half_width: f64,
    /// Place of its name.
    pub arrow_name: f64,
    /// Radius of the dot at the centre.
    pub centre_radius: f64,
    /// Its least radius, px.
    pub centre_least_px: f64,
    /// Half the length of a carriage.
    pub carriage_half_length: f64,
    /// Half its width.
    pub carriage_half_width: f64,
    /// Height of its number.
    pub number_height: f64,
    /// The number's least height, px.
    pub number_least_px: f64,
}

/// The sizes.
pub const SIZES: Sizes = Sizes {
    guides_deg: [-30.0, 90.0, 210.0],
    track_width: 0.06,
    track_least_px: 4.0,
    guide_width: 0.09,
    guide_least_px: 6.0,
    guide_walls_px: 4.0,
    corner_beyond_start: 0.05,
    arrow_shaft: 0.36,
    arrow_tip: 0.5,
    arrow_back: 0.34,
    arrow_half_width: 0.06,
    arrow_name: 0.6,
    centre_radius: 0.04,
    centre_least_px: 5.0,
    carriage_half_length: 0.14,
    carriage_half_width: 0.11,
    number_height: 0.13,
    number_least_px: 11.0,
};

/// The sizes as a script of the page.
#[must_use]
pub fn script() -> String {
    // Numbers alone: that does not fail.
    let sizes = serde_json::to_string_pretty(&SIZES).unwrap_or_default();
    format!(
        "// Sizes of the mechanism's parts, made from the program's table.\n\nexport const SIZES = {sizes};\n"
    )
}

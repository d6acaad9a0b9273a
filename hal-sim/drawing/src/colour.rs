//! One set of colours for every picture. They differ in lightness as well as hue, so that colour-blind readers and grey
//! print keep them apart (after Paul Tol's "vibrant" scheme).

/// Text.
pub const INK: &str = "#1d2733";
/// Text of less weight, axes.
pub const FAINT: &str = "#5d6b7a";
/// Grid lines.
pub const GRID: &str = "#e2e7ec";
/// Behind everything.
pub const PAPER: &str = "#fcfdfe";
/// Behind a chart.
pub const PANEL: &str = "#ffffff";
/// Behind the moving stretches of a chart, and the usable disk.
pub const TINT: &str = "#eef3f8";
/// The track and other steel.
pub const STEEL: &str = "#b9c4cf";

/// Pivots 1 to 3, their guides, motors and duties.
pub const PIVOTS: [&str; 3] = ["#0067a8", "#ee8434", "#0a9d7f"];
/// The centre's x.
pub const X: &str = "#b3261e";
/// The centre's y.
pub const Y: &str = "#3fa9e0";
/// The centre as a whole.
pub const CENTRE: &str = "#9b2c7a";
/// The orientation.
pub const THETA: &str = "#3d3f8f";

/// Dark to light in equal steps of lightness (samples of Matplotlib's "viridis", public domain).
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// The colour of `share`, 0 (dark) to 1 (light), of a filled contour.
pub fn viridis(share: f64) -> String {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - below as f64;
    let mix = |channel: usize| {
        let (low, high) = (VIRIDIS[below][channel], VIRIDIS[below + 1][channel]);
        (f64::from(low) + part * (f64::from(high) - f64::from(low))).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

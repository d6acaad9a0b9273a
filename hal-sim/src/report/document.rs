//! A run as one HTML document that stands alone: summary, plots to zoom into, and the run played back. It has the drawing
//! scripts of the live page in it, and the data decimated to bins of lowest and highest values.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kinematics::Geometry;
use serde::Serialize;

use super::Run;
use drawing::assets::{bundle, text};
use drawing::envelope::Bin;

/// What the live page and the document have in common, in the order of their dependence.
const SHARED: &[&str] = &[
    "/js/dom.js",
    "/js/gcs.js",
    "/js/theme.js",
    "/js/view.js",
    "/js/ticks.js",
    "/js/envelope.js",
    "/js/sizes.js",
    "/js/mechanism.js",
    "/js/zoom.js",
    "/js/plot.js",
];

const TEMPLATE: &str = include_str!("document/report.html");
const SCRIPT: &str = include_str!("document/report.js");
const STYLE: &str = include_str!("document/report.css");

/// What the document's script gets besides the channels.
#[derive(Serialize)]
struct Facts<'a> {
    name: &'a str,
    summary: String,
    /// In one line.
    conditions: String,
    ticks: u64,
    geometry: Lengths,
    moves: Vec<Leg>,
    /// End of each bin, s: a plot on the live page has them so, too.
    times: String,
    /// Lowest and highest of each channel, bin by bin.
    channels: Vec<[String; 2]>,
}

/// Mm.
#[derive(Serialize)]
struct Lengths {
    radius: f64,
    start: f64,
    end: f64,
    disk: f64,
}

/// A move.
#[derive(Serialize)]
struct Leg {
    start_s: f64,
    end_s: f64,
    /// Ms; none when it had not settled before the next move or the end of the run.
    settle_ms: Option<f64>,
    /// It had the time to.
    never: bool,
    target: [f64; 3],
}

/// The document.
pub(super) fn write(run: &Run) -> String {
    let shared = ["/css/colours.css", "/css/theme.css", "/css/controls.css"];
    let style = [&shared.map(text).concat(), STYLE].concat();
    let script = [&bundle(SHARED), SCRIPT].concat();
    let title = run.name.replace('&', "&amp;").replace('<', "&lt;");
    let data = serde_json::to_string(&facts(run)).unwrap_or_default();
    let parts = [
        ("@TITLE@", title.replace('>', "&gt;")),
        ("@STYLE@", style),
        // Nothing in the data may end its element.
        ("@DATA@", data.replace('<', "\\u003c")),
        ("@SCRIPT@", script),
    ];
    fill(TEMPLATE, &parts)
}

/// The template with its parts in place; what is in a part is not looked at again.
fn fill(template: &str, parts: &[(&str, String)]) -> String {
    let mut document = String::new();
    let mut rest = template;
    for (mark, part) in parts {
        if let Some((before, after)) = rest.split_once(mark) {
            document += before;
            document += part;
            rest = after;
        }
    }
    document + rest
}

fn facts(run: &Run) -> Facts<'_> {
    let plots = run.trace.plots();
    let times: Vec<f64> = plots.pose.bins().iter().map(|bin| bin.end_s).collect();
    let mut channels = Vec::new();
    add(&mut channels, plots.pose.bins(), &[0, 1, 2]);
    add(&mut channels, plots.error.bins(), &[0, 1, 3, 4]);
    add(&mut channels, plots.motion.bins(), &[0, 3]);
    add(&mut channels, plots.pivots.bins(), &[0, 1, 2]);
    add(&mut channels, plots.pivot_rates.bins(), &[0, 1, 2]);
    add(&mut channels, plots.duty.bins(), &[0, 1, 2]);
    Facts {
        name: &run.name,
        summary: run.summary().to_string(),
        conditions: run.conditions.to_string(),
        ticks: run.trace.statistics().ticks,
        geometry: lengths(&run.geometry),
        moves: (0..run.moves.len()).map(|index| leg(run, index)).collect(),
        times: packed(times.into_iter()),
        channels,
    }
}

fn lengths(geometry: &Geometry) -> Lengths {
    let radius = geometry.radius_mm;
    Lengths {
        radius,
        start: geometry.guide_start * radius,
        end: (geometry.guide_start + geometry.guide_length) * radius,
        disk: geometry.usable_radius() * radius,
    }
}

fn leg(run: &Run, index: usize) -> Leg {
    let one = &run.moves[index];
    Leg {
        start_s: one.start_s,
        end_s: one.profile_end_s,
        settle_ms: one.settle_s().map(|s| 1e3 * s),
        never: run.never_settles(index),
        target: one.target,
    }
}

fn add<const N: usize>(channels: &mut Vec<[String; 2]>, bins: &[Bin<N>], taken: &[usize]) {
    for &channel in taken {
        channels.push([
            packed(bins.iter().map(|bin| bin.min[channel])),
            packed(bins.iter().map(|bin| bin.max[channel])),
        ]);
    }
}

/// Single-precision floats, little end first, in base 64: enough for what a screen shows.
fn packed(values: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = values
        .flat_map(|value| (value as f32).to_le_bytes())
        .collect();
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_not_searched_for_marks() {
        let parts = [("@A@", "@B@".to_owned()), ("@B@", "b".to_owned())];
        assert_eq!(fill("<@A@|@B@>", &parts), "<@B@|b>");
    }

    #[test]
    fn floats_come_back() {
        let bytes = STANDARD.decode(packed([1.5, -2.0].into_iter())).unwrap();
        assert_eq!(bytes, [0, 0, 0xC0, 0x3F, 0, 0, 0, 0xC0]);
    }
}

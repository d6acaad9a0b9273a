//! One set of colours for every picture and for the page. They differ in lightness as well as hue, so that colour-blind readers
//! and grey print keep them apart (after Paul Tol's "vibrant" scheme).

/// A colour with its name in style sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour {
    /// Its name there.
    pub name: &'static str,
    /// On a light page, and in pictures.
    pub light: &'static str,
    /// On a dark page.
    pub dark: &'static str,
}

macro_rules! colours {
    ($($(#[$doc:meta])* $constant:ident: $name:literal, $light:literal, $dark:literal;)*) => {
        $($(#[$doc])* pub const $constant: &str = $light;)*

        /// All of them.
        pub const COLOURS: &[Colour] = &[
            $(Colour { name: $name, light: $light, dark: $dark },)*
        ];
    };
}

colours! {
    /// Text.
    INK: "ink", "#1d2733", "#e4eaf0";
    /// Text of less weight, axes.
    FAINT: "faint", "#5a6775", "#9aa8b6";
    /// Grid lines.
    GRID: "grid", "#e2e7ec", "#2b3540";
    /// Behind everything.
    PAPER: "paper", "#f3f5f8", "#10151a";
    /// Behind a chart.
    PANEL: "panel", "#ffffff", "#1a2129";
    /// Behind the moving stretches of a chart, and the usable disk.
    TINT: "tint", "#eaf1f8", "#1d2a36";
    /// The track and other steel.
    STEEL: "steel", "#b3bfca", "#53616e";
    /// Edges of cards, and lines between rows.
    LINE: "line", "#d3dae1", "#323d48";
    /// Edges of what can be pressed or filled in.
    EDGE: "edge", "#76838f", "#7b8997";
    /// Pivot 1, its guide, motor and duty.
    PIVOT_1: "pivot-1", "#0067a8", "#56a8e8";
    /// Pivot 2.
    PIVOT_2: "pivot-2", "#d9701c", "#ffb074";
    /// Pivot 3.
    PIVOT_3: "pivot-3", "#078066", "#3fd0ae";
    /// Numbers on the pivots.
    ON_PIVOT: "on-pivot", "#ffffff", "#10151a";
    /// The centre's x.
    X: "x", "#b3261e", "#ff8a80";
    /// The centre's y.
    Y: "y", "#1f86bd", "#7cc8f2";
    /// The centre as a whole.
    CENTRE: "centre", "#9b2c7a", "#f08fd0";
    /// The orientation.
    THETA: "theta", "#3d3f8f", "#b3b6ff";
    /// The platform.
    PLATFORM: "platform", "#cfd9e4", "#3a4855";
    /// What can be pressed, and where is pointed at.
    ACT: "act", "#0b5cad", "#7cbcff";
    /// Text on that.
    ON_ACT: "on-act", "#ffffff", "#0b1a2b";
    /// As it should be.
    GOOD: "good", "#0b6b53", "#5fd6b4";
    /// To be looked at; the frame in force.
    WARN: "warn", "#8a5300", "#ffc46b";
    /// Not as it should be.
    BAD: "bad", "#b3261e", "#ff8a80";
    /// Behind that.
    BAD_TINT: "bad-tint", "#fdeceb", "#3a1b1a";
}

/// Pivots 1 to 3.
pub const PIVOTS: [&str; 3] = [PIVOT_1, PIVOT_2, PIVOT_3];

/// All of them as a style sheet.
#[must_use]
pub fn style_sheet() -> String {
    let rule = |colour: &Colour| {
        let Colour { name, light, dark } = colour;
        format!("  --{name}: light-dark({light}, {dark});\n")
    };
    let rules: String = COLOURS.iter().map(rule).collect();
    format!(":root {{\n{rules}}}\n")
}

/// How much lighter the lighter of two colours `#rrggbb` is than the other, 1 to 21 (WCAG 2.2, contrast ratio).
#[cfg(test)]
fn contrast(one: &str, other: &str) -> f64 {
    let luminance = |colour: &str| {
        let channel = |at: usize| {
            let share = u8::from_str_radix(&colour[at..at + 2], 16).map_or(0.0, f64::from) / 255.0;
            if share <= 0.04045 {
                share / 12.92
            } else {
                ((share + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    };
    let (a, b) = (luminance(one), luminance(other));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// Blue by nothing to red (ends and middle of ColorBrewer's "RdBu", Apache-2.0).
const BLUE_TO_RED: [[u8; 3]; 3] = [[33, 102, 172], [247, 247, 247], [178, 24, 43]];

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
    mixed(&VIRIDIS, share)
}

/// The colour of a signed `share`, -1 (blue) to 1 (red).
pub fn diverging(share: f64) -> String {
    mixed(&BLUE_TO_RED, share.midpoint(1.0))
}

/// Between the colours of a table, by a share of its length.
fn mixed(table: &[[u8; 3]], share: f64) -> String {
    let place = share.clamp(0.0, 1.0) * (table.len() - 1) as f64;
    let below = (place as usize).min(table.len() - 2);
    let part = place - below as f64;
    let mix = |channel: usize| {
        let (low, high) = (table[below][channel], table[below + 1][channel]);
        (f64::from(low) + part * (f64::from(high) - f64::from(low))).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> &'static Colour {
        (COLOURS.iter().find(|colour| colour.name == name)).expect("a colour of the table")
    }

    fn least(name: &str, behind: &str) -> f64 {
        let (colour, behind) = (named(name), named(behind));
        contrast(colour.light, behind.light).min(contrast(colour.dark, behind.dark))
    }

    #[test]
    fn colours_are_mixed_between_those_of_a_table() {
        assert_eq!(viridis(0.0), "#440154");
        assert_eq!(viridis(2.0), "#fde725");
        assert_eq!(
            [-1.0, 0.0, 1.0].map(diverging),
            ["#2166ac", "#f7f7f7", "#b2182b"]
        );
        assert_eq!(diverging(0.5), "#d58891");
    }

    #[test]
    fn black_on_white_is_the_most() {
        assert!((contrast("#000000", "#ffffff") - 21.0).abs() < 1e-9);
    }

    #[test]
    fn what_can_be_pressed_is_seen_and_text_can_be_read() {
        for behind in ["panel", "paper", "tint"] {
            for edge in ["edge", "act", "good", "warn", "bad"] {
                assert!(least(edge, behind) >= 3.0, "{edge} on {behind}");
            }
            for text in ["ink", "faint", "act", "good", "warn", "bad"] {
                assert!(least(text, behind) >= 4.5, "{text} on {behind}");
            }
        }
        for behind in ["act", "theta", "warn"] {
            assert!(least("on-act", behind) >= 4.5, "on {behind}");
        }
        assert!(least("bad", "bad-tint") >= 4.5);
    }
}

//! Which plug belongs to which pivot, drawn: encoder ports to the left, bridges to the right, the pivots from above between them.

use crate::commission::found::Plot;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use drawing::colour;
use drawing::svg::{Anchor, Font, Point, Rect, Stroke, Svg};
use std::f64::consts::TAU;

const SHEET: [f64; 2] = [1_000.0, 420.0];
const MIDDLE: Point = [500.0, 215.0];
const TRACK: f64 = 110.0;
const PIVOT: f64 = 20.0;
/// Plugs: their size, where those of the encoders begin, where those of the bridges do, and from one to the next.
const PLUG: [f64; 2] = [170.0, 64.0];
const ENCODERS_LEFT: f64 = 40.0;
const BRIDGES_LEFT: f64 = 790.0;
const FIRST_TOP: f64 = 70.0;
const PITCH: f64 = 110.0;
/// Width of a cable, and of what lies around it, so that crossings are seen.
const CABLE: f64 = 4.0;
const AROUND: f64 = 9.0;

/// See the module.
pub(super) fn picture(known: &Known) -> Plot {
    let mut svg = Svg::new(SHEET[0], SHEET[1]);
    let steel = Stroke::new(colour::STEEL, 8.0);
    svg.circle(MIDDLE, TRACK, "none", Some(&steel));
    let heading = Font::new(15.0, colour::INK, Anchor::Start).bold();
    svg.text([ENCODERS_LEFT, 40.0], "encoder ports", &heading);
    svg.text([BRIDGES_LEFT, 40.0], "bridges", &heading);
    let faint = Font::new(14.0, colour::FAINT, Anchor::Middle);
    svg.text(
        [MIDDLE[0], 40.0],
        "from above; left is against the clock",
        &faint,
    );
    for pivot in 0..AXES {
        let [port, bridge] = [known.ports[pivot], known.bridges[pivot]];
        let at = place(pivot);
        cable(
            &mut svg,
            [ENCODERS_LEFT + PLUG[0], centre_of(port)],
            at,
            pivot,
        );
        cable(&mut svg, [BRIDGES_LEFT, centre_of(bridge)], at, pivot);
        let counts = turned("counts up to the", known.reversed_at_port[port]);
        plug(&mut svg, ENCODERS_LEFT, port, &counts, pivot);
        let pushes = turned("+V turns it", known.reversed_at_bridge[bridge]);
        plug(&mut svg, BRIDGES_LEFT, bridge, &pushes, pivot);
    }
    for pivot in 0..AXES {
        let [x, y] = place(pivot);
        svg.circle([x, y], PIVOT, colour::PIVOTS[pivot], None);
        let number = Font::new(18.0, colour::PANEL, Anchor::Middle).bold();
        svg.text([x, y + 6.5], &(pivot + 1).to_string(), &number);
    }
    Plot {
        caption: "Plugs as they were found: which encoder port and which bridge each pivot has, and which way they count and turn. Any wiring is right; this is what the controller is told of it.".to_owned(),
        svg: svg.finish(),
    }
}

fn turned(words: &str, is_reversed: bool) -> String {
    format!("{words} {}", if is_reversed { "right" } else { "left" })
}

/// Pivot 1 to the right, the others to the left of each other.
fn place(pivot: usize) -> Point {
    let (sin, cos) = (TAU * pivot as f64 / AXES as f64).sin_cos();
    [MIDDLE[0] + TRACK * cos, MIDDLE[1] - TRACK * sin]
}

fn centre_of(plug: usize) -> f64 {
    FIRST_TOP + PITCH * plug as f64 + PLUG[1] / 2.0
}

fn cable(svg: &mut Svg, from: Point, to: Point, pivot: usize) {
    svg.line(from, to, &Stroke::new(colour::PANEL, AROUND));
    svg.line(from, to, &Stroke::new(colour::PIVOTS[pivot], CABLE));
}

fn plug(svg: &mut Svg, left: f64, number: usize, words: &str, pivot: usize) {
    let rect = Rect {
        left,
        top: FIRST_TOP + PITCH * number as f64,
        width: PLUG[0],
        height: PLUG[1],
    };
    let edge = Stroke::new(colour::PIVOTS[pivot], 2.0);
    svg.rect(&rect, colour::PANEL, Some(&edge));
    let middle = left + PLUG[0] / 2.0;
    let name = Font::new(16.0, colour::INK, Anchor::Middle).bold();
    svg.text([middle, rect.top + 27.0], &(number + 1).to_string(), &name);
    let small = Font::new(13.0, colour::FAINT, Anchor::Middle);
    svg.text([middle, rect.top + 49.0], words, &small);
}

//! Just enough SVG for our pictures. Lengths are user units, one pixel of the PNG each, y downwards.

use std::fmt::Write as _;

use crate::colour;

/// A place on the sheet.
pub type Point = [f64; 2];

/// Further off the sheet than anything shows, and near enough for a renderer's single precision.
const FAR_PX: f64 = 1e5;

/// An upright rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    /// Left edge, px.
    pub left: f64,
    /// Upper edge, px.
    pub top: f64,
    /// Px.
    pub width: f64,
    /// Px.
    pub height: f64,
}

impl Rect {
    /// Right edge, px.
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Lower edge, px.
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// How a line or an outline is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Stroke<'a> {
    /// As CSS has it.
    pub colour: &'a str,
    /// Px.
    pub width: f64,
    /// Dashes instead of a whole line.
    pub dashed: bool,
}

impl<'a> Stroke<'a> {
    /// A whole line of this width, px.
    pub fn new(colour: &'a str, width: f64) -> Self {
        Self {
            colour,
            width,
            dashed: false,
        }
    }

    /// The same in dashes.
    pub fn dashed(self) -> Self {
        Self {
            dashed: true,
            ..self
        }
    }
}

/// Which end of a text its place is.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    /// The text begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub struct Font<'a> {
    /// Height of the letters, px.
    pub size: f64,
    /// As CSS has it.
    pub colour: &'a str,
    /// What of the text is at its point.
    pub anchor: Anchor,
    /// Bold.
    pub bold: bool,
    /// Turned about its place, deg, clockwise.
    pub turned_deg: f64,
    /// A rim of this colour keeps it legible on top of lines.
    pub halo: Option<&'a str>,
}

impl<'a> Font<'a> {
    /// Upright and regular, without a halo.
    pub fn new(size: f64, colour: &'a str, anchor: Anchor) -> Self {
        Self {
            size,
            colour,
            anchor,
            bold: false,
            turned_deg: 0.0,
            halo: None,
        }
    }

    /// The same in bold.
    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }
}

/// A document under construction.
pub struct Svg {
    text: String,
    clips: u32,
}

impl Svg {
    /// An empty picture of this size, px.
    pub fn new(width: f64, height: f64) -> Self {
        let mut svg = Self {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
                 viewBox=\"0 0 {width} {height}\" font-family=\"Noto Sans, Open Sans, Segoe UI, sans-serif\" \
                 stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
            ),
            clips: 0,
        };
        let sheet = Rect {
            left: 0.0,
            top: 0.0,
            width,
            height,
        };
        svg.rect(&sheet, colour::PAPER, None);
        svg
    }

    /// The document.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    fn put(&mut self, arguments: std::fmt::Arguments<'_>) {
        // Writing to a `String` does not fail.
        let _ = self.text.write_fmt(arguments);
    }

    fn paint(&mut self, fill: &str, stroke: Option<&Stroke<'_>>) {
        self.put(format_args!(" fill=\"{fill}\""));
        if let Some(stroke) = stroke {
            let Stroke { colour, width, .. } = stroke;
            self.put(format_args!(
                " stroke=\"{colour}\" stroke-width=\"{width}\""
            ));
            if stroke.dashed {
                self.put(format_args!(" stroke-dasharray=\"7 6\""));
            }
        }
        self.put(format_args!("/>\n"));
    }

    /// A rectangle.
    pub fn rect(&mut self, rect: &Rect, fill: &str, stroke: Option<&Stroke<'_>>) {
        let Rect {
            left,
            top,
            width,
            height,
        } = rect;
        self.put(format_args!(
            "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{height:.2}\""
        ));
        self.paint(fill, stroke);
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: Point, radius: f64, fill: &str, stroke: Option<&Stroke<'_>>) {
        self.put(format_args!(
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\""
        ));
        self.paint(fill, stroke);
    }

    /// A line.
    pub fn line(&mut self, from: Point, to: Point, stroke: &Stroke<'_>) {
        self.path([from, to], false, "none", Some(stroke));
    }

    /// A line through all points, closed or not. Points that are not finite are left out.
    pub fn path(
        &mut self,
        points: impl IntoIterator<Item = Point>,
        closed: bool,
        fill: &str,
        stroke: Option<&Stroke<'_>>,
    ) {
        self.text.push_str("<path d=\"");
        self.trail(points);
        if closed {
            self.text.push('Z');
        }
        self.text.push('"');
        self.paint(fill, stroke);
    }

    /// Several closed rings as one area: rings within rings are holes.
    pub fn rings(&mut self, rings: &[Vec<Point>], fill: &str, stroke: Option<&Stroke<'_>>) {
        self.text.push_str("<path fill-rule=\"evenodd\" d=\"");
        for ring in rings {
            self.trail(ring.iter().copied());
            self.text.push('Z');
        }
        self.text.push('"');
        self.paint(fill, stroke);
    }

    /// Path data in tenths of a pixel, relative, without points that fall on the one before.
    fn trail(&mut self, points: impl IntoIterator<Item = Point>) {
        let mut last: Option<[i64; 2]> = None;
        for point in points {
            if !point.iter().all(|coordinate| coordinate.is_finite()) {
                continue;
            }
            let here = point.map(|pixel| (10.0 * pixel.clamp(-FAR_PX, FAR_PX)).round() as i64);
            let (letter, [dx, dy]) = match last {
                None => ('M', here),
                Some([x, y]) => ('l', [here[0] - x, here[1] - y]),
            };
            if letter == 'l' && dx == 0 && dy == 0 {
                continue;
            }
            let (x, y) = (dx as f64 / 10.0, dy as f64 / 10.0);
            self.put(format_args!("{letter}{x} {y}"));
            last = Some(here);
        }
    }

    /// Text.
    pub fn text(&mut self, [x, y]: Point, text: &str, font: &Font<'_>) {
        let Font { size, colour, .. } = font;
        let anchor = match font.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.put(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\" text-anchor=\"{anchor}\""
        ));
        if font.bold {
            self.put(format_args!(" font-weight=\"bold\""));
        }
        if font.turned_deg != 0.0 {
            let turned = font.turned_deg;
            self.put(format_args!(
                " transform=\"rotate({turned:.1} {x:.1} {y:.1})\""
            ));
        }
        if let Some(halo) = font.halo {
            self.put(format_args!(
                " stroke=\"{halo}\" stroke-width=\"4\" paint-order=\"stroke\""
            ));
        }
        self.put(format_args!(">{}</text>\n", escaped(text)));
    }

    /// What `draw` draws is cut off at the rectangle.
    pub fn clipped_to_rect(&mut self, rect: &Rect, draw: impl FnOnce(&mut Self)) {
        let Rect {
            left,
            top,
            width,
            height,
        } = rect;
        let shape =
            format!("<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/>");
        self.clipped(&shape, draw);
    }

    /// What `draw` draws is cut off at the circle.
    pub fn clipped_to_circle(&mut self, [x, y]: Point, radius: f64, draw: impl FnOnce(&mut Self)) {
        let shape = format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>");
        self.clipped(&shape, draw);
    }

    fn clipped(&mut self, shape: &str, draw: impl FnOnce(&mut Self)) {
        self.clips += 1;
        let id = self.clips;
        self.put(format_args!(
            "<clipPath id=\"clip{id}\">{shape}</clipPath>\n<g clip-path=\"url(#clip{id})\">\n"
        ));
        draw(self);
        self.text.push_str("</g>\n");
    }
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            // XML has no place for them, not even as references; a script's name may.
            control if control.is_control() => out.push('\u{fffd}'),
            other => out.push(other),
        }
    }
    out
}

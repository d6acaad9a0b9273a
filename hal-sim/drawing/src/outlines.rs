//! The texts of an SVG document of ours as outlines of their letters, with the fonts built in: a fresh machine may have none.

use std::fmt::Write as _;

use roxmltree::{Document, Node};
use ttf_parser::{Face, OutlineBuilder};

/// Noto Sans, cut to what pictures need by the script `cut` beside it.
const REGULAR: &[u8] = include_bytes!("../fonts/NotoSans-Regular.ttf");
/// The same in bold.
const BOLD: &[u8] = include_bytes!("../fonts/NotoSans-Bold.ttf");

/// What a text and its outline have in common.
const KEPT: [&str; 5] = ["fill", "transform", "stroke", "stroke-width", "paint-order"];

/// The document with a path for each of its texts.
///
/// # Errors
/// What is wrong with the document, or with a font.
pub(crate) fn of_texts(svg: &str) -> Result<String, String> {
    let document = Document::parse(svg).map_err(|error| error.to_string())?;
    let mut out = String::with_capacity(2 * svg.len());
    let mut copied = 0;
    let is_text = |node: &Node<'_, '_>| node.tag_name().name() == "text";
    for node in document.descendants().filter(is_text) {
        out.push_str(&svg[copied..node.range().start]);
        out.push_str("<path");
        for attribute in node.attributes().filter(|a| KEPT.contains(&a.name())) {
            let source = &svg[attribute.range()];
            let _ = write!(out, " {source}");
        }
        let _ = write!(out, " d=\"{}\"/>", outline(&node)?);
        copied = node.range().end;
    }
    out.push_str(&svg[copied..]);
    Ok(out)
}

/// The path data of a text.
fn outline(node: &Node<'_, '_>) -> Result<String, String> {
    let is_bold = node.attribute("font-weight") == Some("bold");
    let font = if is_bold { BOLD } else { REGULAR };
    let face = Face::parse(font, 0).map_err(|error| error.to_string())?;
    let number = |name| {
        let value = node
            .attribute(name)
            .and_then(|text| text.parse::<f32>().ok());
        value.ok_or_else(|| format!("a text without {name}"))
    };
    let scale = number("font-size")? / f32::from(face.units_per_em());
    let text = node.text().unwrap_or_default();
    // Glyph 0 stands for what the font does not have.
    let glyphs = || {
        text.chars()
            .map(|letter| face.glyph_index(letter).unwrap_or_default())
    };
    let advance = |glyph| scale * f32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    let width: f32 = glyphs().map(advance).sum();
    let before = match node.attribute("text-anchor") {
        Some("middle") => width / 2.0,
        Some("end") => width,
        _ => 0.0,
    };
    let mut path = Path {
        data: String::new(),
        x: number("x")? - before,
        y: number("y")?,
        scale,
    };
    for glyph in glyphs() {
        // A space has none.
        let _ = face.outline_glyph(glyph, &mut path);
        path.x += advance(glyph);
    }
    Ok(path.data)
}

/// Path data of letters, the next one at `x` on the line at `y`, px.
struct Path {
    data: String,
    x: f32,
    y: f32,
    /// Px a unit of the font.
    scale: f32,
}

impl Path {
    fn put(&mut self, letter: char, points: &[[f32; 2]]) {
        self.data.push(letter);
        for [x, y] in points {
            let (x, y) = (self.x + self.scale * x, self.y - self.scale * y);
            let _ = write!(self.data, "{x:.3} {y:.3} ");
        }
    }
}

impl OutlineBuilder for Path {
    fn move_to(&mut self, x: f32, y: f32) {
        self.put('M', &[[x, y]]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.put('L', &[[x, y]]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.put('Q', &[[x1, y1], [x, y]]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.put('C', &[[x1, y1], [x2, y2], [x, y]]);
    }

    fn close(&mut self) {
        self.data.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    /// Where texts of pictures are written, seen from this package.
    const SOURCES: [&str; 3] = ["src", "../src/report", "../desk/src/record"];

    /// The characters past ASCII of a file, as they stand or as `\u{...}`.
    fn characters(text: &str) -> impl Iterator<Item = char> {
        let escaped = text.split("\\u{").skip(1).filter_map(|rest| {
            let (digits, _) = rest.split_once('}')?;
            char::from_u32(u32::from_str_radix(digits, 16).ok()?)
        });
        text.chars().chain(escaped).filter(|c| !c.is_ascii())
    }

    fn add_characters(path: &Path, to: &mut BTreeSet<char>) {
        if path.is_dir() {
            for entry in fs::read_dir(path).unwrap() {
                add_characters(&entry.unwrap().path(), to);
            }
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            to.extend(characters(&fs::read_to_string(path).unwrap()));
        }
    }

    #[test]
    fn a_text_becomes_letters_where_it_stands() {
        let text = r#"<svg xmlns="http://www.w3.org/2000/svg"><text x="10" y="20" font-size="10" fill="red" text-anchor="end">A &lt;</text><g/></svg>"#;
        let outlined = of_texts(text).unwrap();
        let (before, path) = outlined.split_once("<path fill=\"red\" d=\"M").unwrap();
        assert_eq!(before, r#"<svg xmlns="http://www.w3.org/2000/svg">"#);
        let (data, after) = path.split_once("\"/>").unwrap();
        assert_eq!(after, "<g/></svg>");
        // Left of its end, on its line, no higher than its letters.
        let numbers = data.split(|c: char| !"-.0123456789".contains(c));
        let numbers: Vec<f32> = (numbers.filter(|word| !word.is_empty()))
            .map(|word| word.parse().unwrap())
            .collect();
        for point in numbers.chunks(2) {
            assert!((-8.0..10.0).contains(&point[0]), "{point:?}");
            assert!((12.0..=20.0).contains(&point[1]), "{point:?}");
        }
        assert!(of_texts("<svg><text/></svg>").is_err());
    }

    #[test]
    fn both_fonts_have_every_character_that_pictures_use() {
        let mut used: BTreeSet<char> = (' '..='~').collect();
        for source in SOURCES {
            let before = used.len();
            add_characters(
                &Path::new(env!("CARGO_MANIFEST_DIR")).join(source),
                &mut used,
            );
            assert!(source != "../src/report" || used.len() > before);
        }
        for (name, font) in [("regular", REGULAR), ("bold", BOLD)] {
            let face = Face::parse(font, 0).unwrap();
            let missing: Vec<_> = (used.iter().copied())
                .filter(|&character| face.glyph_index(character).is_none())
                .collect();
            assert!(missing.is_empty(), "{name}: {missing:?}");
        }
    }
}

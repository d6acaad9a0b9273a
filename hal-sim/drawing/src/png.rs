//! An SVG document to a PNG file, with the fonts built in: a fresh machine may have none.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

/// Noto Sans, cut to what pictures need by the script `cut` beside it.
const REGULAR: &[u8] = include_bytes!("../fonts/NotoSans-Regular.ttf");
/// The same in bold.
const BOLD: &[u8] = include_bytes!("../fonts/NotoSans-Bold.ttf");

/// The PNG file of an SVG document, one pixel a user unit.
///
/// # Errors
/// What the renderer says.
pub fn render(svg: &str) -> Result<Vec<u8>, String> {
    let tree = usvg::Tree::from_str(svg, &options()).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size();
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height())
        .ok_or_else(|| format!("no picture of {} x {}", size.width(), size.height()))?;
    resvg::render(&tree, tiny_skia::Transform::default(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| error.to_string())
}

fn options() -> usvg::Options<'static> {
    let mut fonts = usvg::fontdb::Database::new();
    for font in [REGULAR, BOLD] {
        fonts.load_font_source(usvg::fontdb::Source::Binary(Arc::new(font)));
    }
    usvg::Options {
        font_family: "Noto Sans".to_owned(),
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use skrifa::{FontRef, MetadataProvider};
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
            let font = FontRef::new(font).unwrap();
            let letters = font.charmap();
            let missing: Vec<_> = (used.iter().copied())
                .filter(|&character| letters.map(character).is_none())
                .collect();
            assert!(missing.is_empty(), "{name}: {missing:?}");
        }
    }
}

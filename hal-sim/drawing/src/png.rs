//! An SVG document to a PNG file, with the fonts built in: a fresh machine may have none.

use std::sync::Arc;

use resvg::{tiny_skia, usvg};

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
    fonts.load_font_source(usvg::fontdb::Source::Binary(Arc::new(
        notosans::REGULAR_TTF,
    )));
    fonts.load_font_source(usvg::fontdb::Source::Binary(Arc::new(notosans::BOLD_TTF)));
    usvg::Options {
        font_family: "Noto Sans".to_owned(),
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    }
}

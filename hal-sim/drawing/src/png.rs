//! An SVG document to a PNG file.

use resvg::{tiny_skia, usvg};

use crate::outlines;

/// The PNG file of an SVG document, one pixel a user unit.
///
/// # Errors
/// What the renderer says.
pub fn render(svg: &str) -> Result<Vec<u8>, String> {
    let svg = outlines::of_texts(svg)?;
    let options = usvg::Options::default();
    let tree = usvg::Tree::from_str(&svg, &options).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size();
    let mut pixels = tiny_skia::Pixmap::new(size.width(), size.height())
        .ok_or_else(|| format!("no picture of {} x {}", size.width(), size.height()))?;
    resvg::render(&tree, tiny_skia::Transform::default(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| error.to_string())
}

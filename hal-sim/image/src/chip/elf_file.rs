//! Where the images lie.

use object::{Object, ObjectSymbol};
use std::env;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Names a built image `stage`, instead of the one in this build's target folder.
pub const IMAGE_VARIABLE: &str = "TRIPIVOT_IMAGE";

const IN_TARGET_FOLDER: &str = "thumbv7em-none-eabihf/stage";

/// The image `stage` named by [`IMAGE_VARIABLE`], or else the one that `cargo stage` left in the target folder in which this
/// program lies; `None` when there is none.
#[must_use]
pub fn find() -> Option<PathBuf> {
    match env::var_os(IMAGE_VARIABLE) {
        Some(path) => Some(PathBuf::from(path)),
        None => built("stage"),
    }
}

/// The image of this name in the target folder in which this program lies.
#[must_use]
pub fn built(name: &str) -> Option<PathBuf> {
    let program = env::current_exe().ok()?;
    program
        .ancestors()
        .map(|folder| folder.join(IN_TARGET_FOLDER).join(name))
        .find(|path| path.is_file())
}

/// Where the first of an image's variables lies whose symbol has this in it.
#[must_use]
pub fn place(path: &Path, part: &str) -> Option<Range<u64>> {
    let bytes = std::fs::read(path).ok()?;
    let file = object::File::parse(&*bytes).ok()?;
    let symbol = (file.symbols())
        .find(|symbol| symbol.size() > 0 && symbol.name().is_ok_and(|name| name.contains(part)))?;
    Some(symbol.address()..symbol.address() + symbol.size())
}

/// The value of one of an image's symbols.
#[must_use]
pub fn symbol(path: &Path, name: &str) -> Option<u64> {
    let bytes = std::fs::read(path).ok()?;
    let file = object::File::parse(&*bytes).ok()?;
    Some(file.symbol_by_name(name)?.address())
}

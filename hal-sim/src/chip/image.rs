//! Where the image lies.

use std::env;
use std::path::PathBuf;

/// Names a built image, instead of the one in this build's target folder.
pub const IMAGE_VARIABLE: &str = "TRIPIVOT_IMAGE";

const IN_TARGET_FOLDER: &str = "thumbv7em-none-eabihf/stage/stage";

/// The image named by [`IMAGE_VARIABLE`], or else the one that `cargo stage` left in the target folder in which this
/// program lies; `None` when there is none.
#[must_use]
pub fn find() -> Option<PathBuf> {
    if let Some(path) = env::var_os(IMAGE_VARIABLE) {
        return Some(PathBuf::from(path));
    }
    let program = env::current_exe().ok()?;
    program
        .ancestors()
        .map(|folder| folder.join(IN_TARGET_FOLDER))
        .find(|path| path.is_file())
}

//! Where of ours an instruction is written.

use addr2line::Loader;
use std::path::Path;

use super::arguments::Place;
use super::error::CliError;

/// Parts of the path of a file of ours: what stands before them is of the machine it was built on.
const CRATES: [&str; 5] = [
    "firmware/src/",
    "firmware/number/src/",
    "firmware/motion/src/",
    "firmware/planners/src/",
    "kinematics/src/",
];
/// What is none of ours: the compiler's library, and what it is called for is not known.
const OTHER: &str = "libraries";

/// The lines of an image.
pub(super) fn lines(image: &Path) -> Result<Loader, CliError> {
    Loader::new(image).map_err(|error| CliError::Value(error.to_string()))
}

/// Where of ours an instruction comes from, the innermost place.
pub(super) fn place(lines: &Loader, at: u64, by: Place) -> String {
    let Ok(mut frames) = lines.find_frames(at) else {
        return OTHER.to_owned();
    };
    while let Ok(Some(frame)) = frames.next() {
        let Some((file, line)) = frame.location.and_then(|it| Some((it.file?, it.line))) else {
            continue;
        };
        let Some(start) = CRATES.iter().find_map(|name| file.find(name)) else {
            continue;
        };
        let file = &file[start..];
        let function = frame.function.as_ref().and_then(|it| it.demangle().ok());
        return match (by, function, line) {
            // Without what it is generic over, which may be many lines.
            (Place::Function, Some(function), _) => {
                let name = function
                    .split_once('<')
                    .map_or(&*function, |(name, _)| name);
                format!("{file} {name}")
            }
            (Place::Line, _, Some(line)) => format!("{file}:{line}"),
            _ => file.to_owned(),
        };
    }
    OTHER.to_owned()
}

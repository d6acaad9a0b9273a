//! Scripts and styles that the live page and the document of a run share, embedded in the program.

use std::sync::LazyLock;

use crate::{colour, mechanism};

/// A file of a page.
pub struct Asset {
    /// Where browsers ask for it.
    pub path: &'static str,
    /// Its MIME type.
    pub kind: &'static str,
    /// What is in it.
    pub text: &'static str,
}

/// MIME type of style sheets.
pub const STYLE: &str = "text/css; charset=utf-8";
/// MIME type of scripts.
pub const SCRIPT: &str = "text/javascript; charset=utf-8";

macro_rules! asset {
    ($path:literal, $kind:expr, $file:literal) => {
        Asset {
            path: $path,
            kind: $kind,
            text: include_str!(concat!("../page/", $file)),
        }
    };
}

/// Those that are files.
const FILES: &[Asset] = &[
    asset!("/css/theme.css", STYLE, "css/theme.css"),
    asset!("/css/controls.css", STYLE, "css/controls.css"),
    asset!("/js/gcs.js", SCRIPT, "js/gcs.js"),
    asset!("/js/dom.js", SCRIPT, "js/dom.js"),
    asset!("/js/theme.js", SCRIPT, "js/theme.js"),
    asset!("/js/view.js", SCRIPT, "js/view.js"),
    asset!("/js/mechanism.js", SCRIPT, "js/mechanism.js"),
    asset!("/js/plot.js", SCRIPT, "js/plot.js"),
    asset!("/js/zoom.js", SCRIPT, "js/zoom.js"),
    asset!("/js/ticks.js", SCRIPT, "js/ticks.js"),
    asset!("/js/envelope.js", SCRIPT, "js/envelope.js"),
];

/// All of them: the files, and what is made from the program's tables.
pub fn all() -> impl Iterator<Item = &'static Asset> {
    static MADE: LazyLock<[Asset; 2]> = LazyLock::new(|| {
        [
            Asset {
                path: "/css/colours.css",
                kind: STYLE,
                text: colour::style_sheet().leak(),
            },
            Asset {
                path: "/js/sizes.js",
                kind: SCRIPT,
                text: mechanism::script().leak(),
            },
        ]
    });
    FILES.iter().chain(&*MADE)
}

/// One of them.
#[must_use]
pub fn text(path: &str) -> &'static str {
    all()
        .find(|asset| asset.path == path)
        .map_or("", |asset| asset.text)
}

/// Scripts in one, in this order, for a document that stands alone: without the lines that import and the words that export.
#[must_use]
pub fn bundle(paths: &[&str]) -> String {
    (paths.iter().flat_map(|path| text(path).lines()))
        .filter(|line| !line.starts_with("import "))
        .flat_map(|line| [line.strip_prefix("export ").unwrap_or(line), "\n"])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_script_and_style_is_there() {
        for kind in ["js", "css"] {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
                .join("page")
                .join(kind);
            for entry in std::fs::read_dir(folder).unwrap() {
                let name = entry.unwrap().file_name().into_string().unwrap();
                assert!(!text(&format!("/{kind}/{name}")).is_empty(), "{name}");
            }
        }
    }
}

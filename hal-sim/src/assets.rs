//! The page's files, embedded in the binary, and the scripts that a report takes along.

/// A file of the page.
pub(crate) struct Asset {
    /// Where browsers ask for it.
    pub path: &'static str,
    /// Its MIME type.
    pub kind: &'static str,
    /// What is in it.
    pub text: &'static str,
}

const HTML: &str = "text/html; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

macro_rules! asset {
    ($path:literal, $kind:expr, $file:literal) => {
        Asset {
            path: $path,
            kind: $kind,
            text: include_str!(concat!("../page/", $file)),
        }
    };
}

/// All of them.
pub(crate) const ASSETS: &[Asset] = &[
    asset!("/", HTML, "index.html"),
    asset!("/favicon.svg", "image/svg+xml", "favicon.svg"),
    asset!("/css/theme.css", STYLE, "css/theme.css"),
    asset!("/css/controls.css", STYLE, "css/controls.css"),
    asset!("/css/page.css", STYLE, "css/page.css"),
    asset!("/js/main.js", SCRIPT, "js/main.js"),
    asset!("/js/gcs.js", SCRIPT, "js/gcs.js"),
    asset!("/js/errors.js", SCRIPT, "js/errors.js"),
    asset!("/js/link.js", SCRIPT, "js/link.js"),
    asset!("/js/stage.js", SCRIPT, "js/stage.js"),
    asset!("/js/dom.js", SCRIPT, "js/dom.js"),
    asset!("/js/theme.js", SCRIPT, "js/theme.js"),
    asset!("/js/view.js", SCRIPT, "js/view.js"),
    asset!("/js/mechanism.js", SCRIPT, "js/mechanism.js"),
    asset!("/js/scene.js", SCRIPT, "js/scene.js"),
    asset!("/js/aim.js", SCRIPT, "js/aim.js"),
    asset!("/js/reach.js", SCRIPT, "js/reach.js"),
    asset!("/js/plot.js", SCRIPT, "js/plot.js"),
    asset!("/js/zoom.js", SCRIPT, "js/zoom.js"),
    asset!("/js/ticks.js", SCRIPT, "js/ticks.js"),
    asset!("/js/envelope.js", SCRIPT, "js/envelope.js"),
    asset!("/js/scope.js", SCRIPT, "js/scope.js"),
    asset!("/js/state.js", SCRIPT, "js/state.js"),
    asset!("/js/drive.js", SCRIPT, "js/drive.js"),
    asset!("/js/jog.js", SCRIPT, "js/jog.js"),
    asset!("/js/lesson.js", SCRIPT, "js/lesson.js"),
    asset!("/js/parameters.js", SCRIPT, "js/parameters.js"),
    asset!("/js/recorder.js", SCRIPT, "js/recorder.js"),
    asset!("/js/frames.js", SCRIPT, "js/frames.js"),
    asset!("/js/record.js", SCRIPT, "js/record.js"),
    asset!("/js/statistics.js", SCRIPT, "js/statistics.js"),
    asset!("/js/table.js", SCRIPT, "js/table.js"),
    asset!("/js/console.js", SCRIPT, "js/console.js"),
];

/// A file of the page.
pub(crate) fn text(path: &str) -> &'static str {
    (ASSETS.iter().find(|asset| asset.path == path)).map_or("", |asset| asset.text)
}

/// Scripts of the page in one, in this order, for a document that stands alone: without the lines that import and the words
/// that export.
pub(crate) fn bundle(paths: &[&str]) -> String {
    (paths.iter().flat_map(|path| text(path).lines()))
        .filter(|line| !line.starts_with("import "))
        .flat_map(|line| [line.strip_prefix("export ").unwrap_or(line), "\n"])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_stand_on_one_line_and_name_files_that_are_there() {
        for asset in ASSETS.iter().filter(|asset| asset.kind == SCRIPT) {
            for line in asset
                .text
                .lines()
                .filter(|line| line.starts_with("import "))
            {
                let file = line.split_once("from \"./").map(|(_, rest)| rest);
                let file = file
                    .and_then(|rest| rest.strip_suffix("\";"))
                    .unwrap_or(line);
                let path = format!("/js/{file}");
                assert!(!text(&path).is_empty(), "{}: {line}", asset.path);
            }
        }
    }

    #[test]
    fn every_script_of_the_page_is_served() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("page/js");
        for entry in std::fs::read_dir(folder).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let path = format!("/js/{name}");
            assert!(
                name.starts_with("report") || !text(&path).is_empty(),
                "{name}"
            );
        }
    }
}

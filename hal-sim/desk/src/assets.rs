//! The page's files, embedded in the program.

use std::sync::LazyLock;

use drawing::assets::{Asset, SCRIPT, STYLE};

use crate::{error_words, reference};

const TEXT: &str = "text/plain; charset=utf-8";
const HTML: &str = "text/html; charset=utf-8";

macro_rules! asset {
    ($path:literal, $kind:expr, $file:literal) => {
        Asset {
            path: $path,
            kind: $kind,
            text: include_str!(concat!("../page/", $file)),
        }
    };
}

/// The page's own.
const ASSETS: &[Asset] = &[
    asset!("/", HTML, "index.html"),
    asset!("/favicon.svg", "image/svg+xml", "favicon.svg"),
    asset!("/css/page.css", STYLE, "css/page.css"),
    asset!("/js/main.js", SCRIPT, "js/main.js"),
    asset!("/js/errors.js", SCRIPT, "js/errors.js"),
    asset!("/js/link.js", SCRIPT, "js/link.js"),
    asset!("/js/operator.js", SCRIPT, "js/operator.js"),
    asset!("/js/sequence.js", SCRIPT, "js/sequence.js"),
    asset!("/js/commissioning.js", SCRIPT, "js/commissioning.js"),
    asset!("/js/calibration.js", SCRIPT, "js/calibration.js"),
    asset!("/js/orders.js", SCRIPT, "js/orders.js"),
    asset!("/js/steps.js", SCRIPT, "js/steps.js"),
    asset!("/js/task-picture.js", SCRIPT, "js/task-picture.js"),
    asset!("/js/tuning.js", SCRIPT, "js/tuning.js"),
    asset!("/js/log.js", SCRIPT, "js/log.js"),
    asset!(
        "/examples/demonstration.gcs",
        TEXT,
        "../../scripts/demonstration.gcs"
    ),
    asset!("/examples/motion.gcs", TEXT, "../../scripts/motion.gcs"),
    asset!("/js/macros.js", SCRIPT, "js/macros.js"),
    asset!("/js/places.js", SCRIPT, "js/places.js"),
    asset!("/js/events.js", SCRIPT, "js/events.js"),
    asset!("/js/dial.js", SCRIPT, "js/dial.js"),
    asset!("/js/soft-limits.js", SCRIPT, "js/soft-limits.js"),
    asset!("/js/announce.js", SCRIPT, "js/announce.js"),
    asset!("/js/commands.js", SCRIPT, "js/commands.js"),
    asset!("/js/freshness.js", SCRIPT, "js/freshness.js"),
    asset!("/js/stale.js", SCRIPT, "js/stale.js"),
    asset!("/js/stop.js", SCRIPT, "js/stop.js"),
    asset!("/js/first-move.js", SCRIPT, "js/first-move.js"),
    asset!("/js/remembered.js", SCRIPT, "js/remembered.js"),
    asset!("/js/stage.js", SCRIPT, "js/stage.js"),
    asset!("/js/scene.js", SCRIPT, "js/scene.js"),
    asset!("/js/aim.js", SCRIPT, "js/aim.js"),
    asset!("/js/reach.js", SCRIPT, "js/reach.js"),
    asset!("/js/scope.js", SCRIPT, "js/scope.js"),
    asset!("/js/state.js", SCRIPT, "js/state.js"),
    asset!("/js/drive.js", SCRIPT, "js/drive.js"),
    asset!("/js/held.js", SCRIPT, "js/held.js"),
    asset!("/js/jog.js", SCRIPT, "js/jog.js"),
    asset!("/js/ownership.js", SCRIPT, "js/ownership.js"),
    asset!("/js/recovery.js", SCRIPT, "js/recovery.js"),
    asset!("/js/lesson.js", SCRIPT, "js/lesson.js"),
    asset!("/js/parameters.js", SCRIPT, "js/parameters.js"),
    asset!("/js/recorder.js", SCRIPT, "js/recorder.js"),
    asset!("/js/frames.js", SCRIPT, "js/frames.js"),
    asset!("/js/record.js", SCRIPT, "js/record.js"),
    asset!("/js/statistics.js", SCRIPT, "js/statistics.js"),
    asset!("/js/table.js", SCRIPT, "js/table.js"),
    asset!("/js/console.js", SCRIPT, "js/console.js"),
];

/// All files of the page: its own, what is made from the program's tables, and those that it shares with the document of a run.
pub(crate) fn all() -> impl Iterator<Item = &'static Asset> {
    static MADE: LazyLock<[Asset; 2]> = LazyLock::new(|| {
        [
            Asset {
                path: "/js/error-words.js",
                kind: SCRIPT,
                text: error_words::script().leak(),
            },
            Asset {
                path: "/js/reference.js",
                kind: SCRIPT,
                text: reference::script().leak(),
            },
        ]
    });
    (ASSETS.iter().chain(&*MADE)).chain(drawing::assets::all())
}

#[cfg(test)]
mod tests {
    use super::*;
    use drawing::colour::COLOURS;

    fn text(path: &str) -> &'static str {
        (all().find(|asset| asset.path == path)).map_or("", |asset| asset.text)
    }

    #[test]
    fn imports_stand_on_one_line_and_name_files_that_are_there() {
        for asset in all().filter(|asset| asset.kind == SCRIPT) {
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

    /// What stands between `before` and `after`, wherever it does.
    fn between<'a>(text: &'a str, before: &str, after: char) -> Vec<&'a str> {
        (text.split(before).skip(1))
            .filter_map(|rest| rest.split_once(after).map(|(name, _)| name))
            .collect()
    }

    #[test]
    fn the_page_has_the_colours_of_the_table_and_uses_all_of_them() {
        let known: Vec<&str> = COLOURS.iter().map(|colour| colour.name).collect();
        let others: String = all()
            .filter(|asset| asset.path != "/css/colours.css")
            .map(|asset| asset.text)
            .collect();
        assert!(
            !others.contains("light-dark(#"),
            "a colour beside the table"
        );
        let named = [
            between(&others, "var(--", ')'),
            between(&others, "colour(\"", '"'),
            between(&others, "paint: \"", '"'),
        ];
        for name in named
            .concat()
            .into_iter()
            .filter(|name| !name.contains('$'))
        {
            assert!(known.contains(&name), "{name} is not in the table");
        }
        for name in known {
            // The document of a run paints the centre's x and y.
            let of_a_run = ["x", "y"].contains(&name);
            let is_used = [format!("var(--{name})"), format!("\"{name}\"")]
                .iter()
                .any(|use_of_it| others.contains(use_of_it));
            assert!(is_used || of_a_run, "{name} is not used");
        }
    }

    #[test]
    fn every_script_of_the_page_is_served() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("page/js");
        for entry in std::fs::read_dir(folder).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let path = format!("/js/{name}");
            assert!(!text(&path).is_empty(), "{name}");
        }
    }
}

//! The sections of the page, by chapter.

mod chip;
mod commissioning;
mod demonstration;
mod exactness;
mod faults;
mod host;
mod motion;

use super::Section;

/// Lines of a run that are not figures of the stage: the script's queries and their answers, the folder, the host's speed; and the
/// run's conditions, which the section's command and words say, the program's commit among them.
const BESIDES: &[&str] = &[
    "?",
    "=",
    "trace and report in",
    "times real time",
    "conditions",
    "  program ",
    "  machine ",
    "  seed ",
    "  mismatch ",
    "  payload ",
    "  imperfections ",
    "  settings ",
];

/// All of them, in the page's order.
pub fn all_sections() -> impl Iterator<Item = &'static Section> {
    let chapters = [
        demonstration::SECTIONS,
        motion::SECTIONS,
        faults::SECTIONS,
        commissioning::SECTIONS,
        exactness::SECTIONS,
        chip::SECTIONS,
        host::SECTIONS,
    ];
    chapters.into_iter().flatten()
}

//! `hal-sim/MEASURED.md` is what its command would write, and what it says of quick deterministic runs is so.

use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::Script;
use std::collections::BTreeSet;
use std::path::Path;
use tests::measured::{
    Page, all_sections, cost_differences, differences, figures, path, plant_path, plant_text,
};

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn page() -> Page {
    let text = std::fs::read_to_string(path(root())).expect("the page");
    Page::read(&text).0
}

/// Neither a section too few or too many, nor other words or another command than the table's.
#[test]
fn the_page_is_of_the_table() {
    let text = std::fs::read_to_string(path(root())).expect("the page");
    let (page, errors) = Page::read(&text);
    assert_eq!(errors, [], "write it again: measured --page");
    assert!(
        text == page.text(),
        "words differ from the table's; write it again: measured --page"
    );
}

#[test]
fn the_machines_description_has_the_pages_table() {
    let text = std::fs::read_to_string(plant_path(root())).expect("the description");
    let with_table = plant_text(&text, &page()).expect("a table, and its place");
    assert!(text == with_table, "write it again: measured --page");
}

#[test]
fn sections_have_names_and_titles_of_their_own() {
    let names: BTreeSet<_> = all_sections().map(|section| section.name).collect();
    let titles: BTreeSet<_> = all_sections().map(|section| section.title).collect();
    assert_eq!(
        (names.len(), titles.len()),
        (all_sections().count(), all_sections().count())
    );
    for section in all_sections() {
        assert_ne!(Some(section.command), section.short, "{}", section.name);
    }
}

/// A fresh run beside what the page says of it.
fn is_as_the_page_says(name: &str, options: &RunOptions) {
    let script = Script::demonstration().expect("a good script");
    let outcome = run(&script, options);
    assert_eq!(outcome.fault, None);
    let section = all_sections().find(|section| section.name == name);
    let without = section.expect("a section").without;
    let fresh = figures(&outcome.run.summary().to_string(), without);
    let page = page();
    let measured = page.get(name).expect("a section that has been run");
    let found = differences(&measured.figures, &fresh);
    assert!(
        found.is_empty(),
        "`measured --only {name}`, if that is meant to be:\n{}",
        found.join("\n")
    );
}

#[test]
fn the_demonstration_is_as_the_page_says() {
    is_as_the_page_says("demonstration", &RunOptions::reference());
}

#[test]
fn a_kind_machine_is_as_the_page_says() {
    is_as_the_page_says("kind", &RunOptions::default());
}

#[test]
fn a_plant_as_modelled_is_as_the_page_says() {
    let options = RunOptions {
        mismatch_percent: 0.0,
        ..RunOptions::default()
    };
    is_as_the_page_says("as-modelled", &options);
}

#[test]
fn an_unknown_payload_is_as_the_page_says() {
    let options = RunOptions {
        payload_kg: 5.0,
        ..RunOptions::default()
    };
    is_as_the_page_says("payload", &options);
}

/// The chip's costs are not counted again here: `cargo cost --check` holds them to the figures that the repository keeps.
#[test]
fn costs_in_the_page_are_those_that_are_kept() {
    let kept = std::fs::read_to_string(root().join("firmware/figures.csv")).expect("the figures");
    let page = page();
    let Some(measured) = page.get("cost") else {
        return;
    };
    let found = cost_differences(&measured.figures, &kept);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

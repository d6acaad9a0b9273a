//! Measures what `hal-sim/MEASURED.md` reports, and writes it (and the table in `hal-sim/PLANT.md` that is from it): `cargo run --release -p tests --bin measured`.
//!
//! `--only NAME` (again for several) leaves the other sections as they are; `--missing` runs those that have not been run yet;
//! `--short` takes short forms; `--list` says what there is; `--page` writes the page again from what it holds. Needs bash, and
//! for the sections on the chip what `cargo stage` needs. Exit code 1 when a command fails: its section stays as it was.

use std::path::Path;
use std::process::ExitCode;

use tests::measured::{
    Group, Page, Section, all_sections, path, plant_path, plant_text, prepare, run,
};

const USAGE: &str = "measured [--only NAME]... [--missing] [--short] [--list] [--page]";

/// What is asked for.
#[derive(Default)]
struct Options {
    only: Vec<&'static str>,
    is_missing: bool,
    is_short: bool,
    is_list: bool,
    is_page: bool,
}

impl Options {
    fn wants(&self, section: &Section, page: &Page) -> bool {
        let is_named = self.only.is_empty() || self.only.contains(&section.name);
        let is_due = !self.is_missing || page.get(section.name).is_none();
        is_named && is_due && !self.is_page
    }
}

fn options() -> Result<Options, String> {
    let mut options = Options::default();
    let mut arguments = std::env::args().skip(1);
    while let Some(option) = arguments.next() {
        match &*option {
            "--missing" => options.is_missing = true,
            "--short" => options.is_short = true,
            "--list" => options.is_list = true,
            "--page" => options.is_page = true,
            "--only" => {
                let name = arguments.next().unwrap_or_default();
                let section = all_sections().find(|section| section.name == name);
                let section =
                    section.ok_or(format!("\"{name}\" is no section; --list names them"))?;
                options.only.push(section.name);
            }
            _ => return Err(format!("{option}: {USAGE}")),
        }
    }
    Ok(options)
}

fn main() -> ExitCode {
    let options = match options() {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    match measure(&root, &options) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(failed) => {
            eprintln!("{failed} sections failed and stay as they were");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{}: {error}", path(Path::new("")).display());
            ExitCode::FAILURE
        }
    }
}

/// Runs what is wanted, and writes the page after each section; how many failed.
fn measure(root: &Path, options: &Options) -> std::io::Result<u32> {
    let path = path(root);
    let text = if path.exists() {
        std::fs::read_to_string(&path)?
    } else {
        String::new()
    };
    let (mut page, errors) = Page::read(&text);
    for error in errors {
        eprintln!("left out: {error}");
    }
    let wanted: Vec<_> = all_sections()
        .filter(|section| options.wants(section, &page))
        .collect();
    if options.is_list {
        list(&wanted, &page);
        return Ok(0);
    }
    let is_prepared =
        !wanted.iter().any(|section| section.group == Group::Chip) || is_image_built(root);
    let mut failed = 0;
    for section in wanted {
        println!("{}: {}", section.name, section.command(options.is_short));
        if section.group == Group::Chip && !is_prepared {
            failed += 1;
            continue;
        }
        match run(root, section, options.is_short) {
            Ok(measured) => {
                println!("{}{}\n", measured.figures, measured.conditions);
                page.set(section, measured);
                write(root, &page)?;
            }
            Err(error) => {
                eprintln!("{}: {error}", section.name);
                failed += 1;
            }
        }
    }
    write(root, &page)?;
    Ok(failed)
}

/// The page, and the table that the simulated machine's description has from it.
fn write(root: &Path, page: &Page) -> std::io::Result<()> {
    std::fs::write(path(root), page.text())?;
    let plant = plant_path(root);
    match plant_text(&std::fs::read_to_string(&plant)?, page) {
        Some(text) => std::fs::write(plant, text),
        None => Ok(()),
    }
}

fn is_image_built(root: &Path) -> bool {
    match prepare(root) {
        Ok(()) => true,
        Err(error) => {
            eprintln!("the image: {error}");
            false
        }
    }
}

fn list(wanted: &[&Section], page: &Page) {
    for section in wanted {
        let run = page
            .get(section.name)
            .map_or("not run yet", |it| &it.conditions);
        println!(
            "{:<14}{:>5} s  {:<30}  {run}",
            section.name,
            section.seconds,
            section.kind.text()
        );
    }
    let seconds: u32 = wanted.iter().map(|section| section.seconds).sum();
    println!("{:<14}{seconds:>5} s  and what has to be built", "together");
}

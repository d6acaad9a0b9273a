//! The page: written from the table and what was measured, and read back.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::{Group, Measured, Section, all_sections};

const HEAD: &str = "# Measured

Written by `cargo run --release -p tests --bin measured`, which runs the commands below and takes the figures from what they
print. What is run stands in `tests/src/measured/registry/`; edit that, not this. `--only NAME` runs one section again and
leaves the others as they are, `--list` names them, `--short` takes shorter runs, `--missing` what has not been run yet, `--page`
writes the page again and runs nothing.

**No real machine has been measured.** The stage is the [simulated one](PLANT.md), the chip an emulated one. Deterministic figures
are the same at every run: `cargo test` runs the demonstrations again and fails when a figure is off by more than a tenth of what
stands here; others are bounded by the tests that print them. Instructions and bytes depend on the compiler besides. Host times are
of one machine, and count as ratios.
";
/// Widest line of text.
const WIDTH: usize = 120;
const COMMAND: &str = "- command: ";
const RUN: &str = "- run: ";
const NOT_YET: &str = "not run yet";
const FENCE: &str = "```";

/// Where the page is.
#[must_use]
pub fn path(root: &Path) -> PathBuf {
    root.join("hal-sim/MEASURED.md")
}

/// What the page holds: the sections that have been run, by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Page(BTreeMap<&'static str, Measured>);

/// What in a page is not of the table.
#[derive(Debug, PartialEq, Eq)]
pub enum PageError {
    /// A section that the table does not have.
    Surplus(String),
    /// A section's figures were given by another command than the table's.
    Command(String),
    /// A section without command or conditions.
    Incomplete(String),
}

impl std::fmt::Display for PageError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Surplus(title) => write!(f, "\"{title}\" is no section"),
            Self::Command(title) => write!(f, "\"{title}\" was measured by another command"),
            Self::Incomplete(title) => write!(f, "\"{title}\" has no command, run or figures"),
        }
    }
}

impl std::error::Error for PageError {}

impl Page {
    /// What was measured in a section.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Measured> {
        self.0.get(name)
    }

    /// Puts a section's figures in place of those it has.
    pub fn set(&mut self, section: &Section, measured: Measured) {
        self.0.insert(section.name, measured);
    }

    /// Reads a page. What is not of the table is left out, and told.
    #[must_use]
    pub fn read(text: &str) -> (Self, Vec<PageError>) {
        let mut page = Self::default();
        let mut errors = Vec::new();
        for (title, lines) in sections(text) {
            match measured(title, &lines) {
                Ok(Some((section, measured))) => page.set(section, measured),
                Ok(None) => {}
                Err(error) => errors.push(error),
            }
        }
        (page, errors)
    }

    /// The page.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = format!("{HEAD}\n| section | name | figures | run |\n|---|---|---|---|\n");
        for section in all_sections() {
            let _ = writeln!(
                text,
                "| [{}](#{}) | `{}` | {} | {} |",
                section.title,
                anchor(section.title),
                section.name,
                section.kind.text(),
                self.day(section)
            );
        }
        for group in Group::ALL {
            let _ = writeln!(text, "\n## {}", group.title());
            if let Some(about) = group.about() {
                let _ = writeln!(text, "\n{}", wrapped(about));
            }
            for section in all_sections().filter(|section| section.group == group) {
                self.section(&mut text, section);
            }
        }
        text
    }

    fn day(&self, section: &Section) -> &str {
        let conditions = self.get(section.name).map(|it| &*it.conditions);
        conditions.map_or(NOT_YET, |all| all.split(',').next().unwrap_or(all))
    }

    fn section(&self, text: &mut String, section: &Section) {
        let _ = writeln!(
            text,
            "\n### {}\n\n{}\n",
            section.title,
            wrapped(section.about)
        );
        let measured = self.get(section.name);
        let command = measured.map_or(section.command, |it| &it.command);
        let _ = writeln!(text, "{COMMAND}`{command}`");
        if command != section.command {
            let _ = writeln!(text, "- in full: `{}`", section.command);
        }
        let _ = writeln!(text, "- figures: {}", section.kind.text());
        match measured {
            None => {
                let _ = writeln!(text, "{RUN}{NOT_YET}");
            }
            Some(Measured {
                conditions,
                figures,
                ..
            }) => {
                let _ = writeln!(text, "{RUN}{conditions}\n\n{FENCE}text\n{figures}{FENCE}");
            }
        }
    }
}

/// Titles of sections, and the lines under each.
fn sections(text: &str) -> Vec<(&str, Vec<&str>)> {
    let mut sections: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut is_fenced = false;
    for line in text.lines() {
        is_fenced ^= line.starts_with(FENCE);
        match (line.strip_prefix("### "), sections.last_mut()) {
            (Some(title), _) if !is_fenced => sections.push((title, Vec::new())),
            (_, Some((_, lines))) => lines.push(line),
            (_, None) => {}
        }
    }
    sections
}

/// What a section of the page says was measured; `None` where it has not been run yet.
fn measured(
    title: &str,
    lines: &[&str],
) -> Result<Option<(&'static Section, Measured)>, PageError> {
    let section = (all_sections().find(|section| section.title == title))
        .ok_or_else(|| PageError::Surplus(title.to_owned()))?;
    let after = |prefix: &str| lines.iter().find_map(|line| line.strip_prefix(prefix));
    let incomplete = || PageError::Incomplete(title.to_owned());
    let command = after(COMMAND).ok_or_else(incomplete)?.trim_matches('`');
    let conditions = after(RUN).ok_or_else(incomplete)?;
    if !section.is_measured_by(command) {
        return Err(PageError::Command(title.to_owned()));
    }
    if conditions == NOT_YET {
        return Ok(None);
    }
    let mut fences = (lines.iter().enumerate()).filter(|(_, line)| line.starts_with(FENCE));
    let (Some((open, _)), Some((close, _))) = (fences.next(), fences.next()) else {
        return Err(incomplete());
    };
    let figures = lines[open + 1..close]
        .iter()
        .map(|line| format!("{line}\n"));
    Ok(Some((
        section,
        Measured {
            command: command.to_owned(),
            conditions: conditions.to_owned(),
            figures: figures.collect(),
        },
    )))
}

/// The anchor that a heading gets.
fn anchor(title: &str) -> String {
    (title.to_lowercase().chars())
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// A paragraph in lines.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("at least one");
        if last.is_empty() {
            *last += word;
        } else if last.len() + 1 + word.len() <= WIDTH {
            *last += &format!(" {word}");
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.join("\n")
}

//! What was found of a board, as one page: to be kept with it.

use super::{Found, Outcome, Test, Verdict};
use drawing::page::{END, escaped, head};
use std::fmt::Write;

/// A test, and what it has found; `None` where it was left out.
pub type Done = (&'static Test, Option<Found>);

/// The page of a run of the plan.
#[must_use]
pub fn page(date: &str, outcome: &Outcome, all: &[Done]) -> String {
    let mut page = head("A board's tests");
    let verdict = if outcome.passed {
        "<span class=\"ok\">nothing has failed</span>"
    } else {
        "<span class=\"failed\">failed</span>"
    };
    let left_out = all.iter().filter(|(_, found)| found.is_none()).count();
    let tests = match left_out {
        0 => format!("{} tests", all.len()),
        _ => format!(
            "{} tests; {left_out} more, that move the stage, were left out",
            all.len() - left_out
        ),
    };
    // Writing to a text does not fail.
    let _ = write!(
        page,
        "<h1>{}: {verdict}</h1>\n<p>{}, {tests}<br>{}</p>\n",
        escaped(board_name(&outcome.self_test)),
        escaped(date),
        escaped(&outcome.identity)
    );
    page +=
        "<h2>tests</h2>\n<table><tr><th>test</th><th>found</th><th>expected</th><th></th></tr>\n";
    for (test, found) in all {
        let (class, said, text) = match found {
            None => ("none", "left out", ""),
            Some(Found { text, verdict }) => match verdict {
                Verdict::Passed => ("ok", "ok", text.as_str()),
                Verdict::NotJudged => ("none", "not judged", text.as_str()),
                Verdict::Failed => ("failed", "failed", text.as_str()),
            },
        };
        row(&mut page, [test.name, text, test.expected], class, said);
    }
    page += "</table>\n<h2>what the board reads of itself</h2>\n\
             <table><tr><th>reading</th><th>value</th><th>has to be</th><th></th></tr>\n";
    for [name, value, wanted, judged] in outcome.self_test.lines().filter_map(reading) {
        let class = if judged == "ok" { "ok" } else { "failed" };
        row(&mut page, [name, value, wanted], class, judged);
    }
    page += "</table>\n";
    page + END
}

fn row(page: &mut String, cells: [&str; 3], class: &str, said: &str) {
    let [name, found, wanted] = cells.map(escaped);
    // Writing to a text does not fail.
    let _ = writeln!(
        page,
        "<tr><td>{name}</td><td>{found}</td><td>{wanted}</td><td class=\"{class}\">{said}</td></tr>"
    );
}

/// What the first line of `TST?` says.
fn board_name(self_test: &str) -> &str {
    let first = self_test.lines().next().unwrap_or_default();
    first.trim().strip_prefix("BOARD=").unwrap_or("a board")
}

/// Name, value, what it has to be and how it was judged, of a line of `TST?`.
fn reading(line: &str) -> Option<[&str; 4]> {
    let (name, rest) = line.trim().split_once('=')?;
    let (rest, judged) = rest.rsplit_once(", ")?;
    let (value, wanted) = rest.rsplit_once(", ")?;
    Some([name, value, wanted, judged])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_the_self_test_is_taken_apart() {
        let line = "SUPPLY=48.001 V, 45.6 to 50.4, ok ";
        assert_eq!(
            reading(line),
            Some(["SUPPLY", "48.001 V", "45.6 to 50.4", "ok"])
        );
        assert_eq!(reading("BOARD=reference board, STM32F427 "), None);
        assert_eq!(reading("BAD=0"), None);
        assert_eq!(
            board_name("BOARD=reference board, STM32F427 \nX"),
            "reference board, STM32F427"
        );
    }
}

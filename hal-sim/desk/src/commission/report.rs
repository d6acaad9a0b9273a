//! All of it, as one page.

use super::results::{Change, Conditions};
use super::{Done, STEPS};
use drawing::page::{END, escaped, figure, head};
use std::fmt::Write;

/// The report of a commissioning as an HTML page; changes are those since an earlier one, if there was one.
#[must_use]
pub fn page(conditions: &Conditions, all: &[Done], changes: Option<&[Change]>) -> String {
    let mut page = head("Commissioning");
    let failed = all.iter().any(|done| done.failure.is_some());
    let verdict = if failed {
        "<span class=\"failed\">not commissioned</span>"
    } else if all.last().map(|done| done.step.name) == STEPS.last().map(|step| step.name) {
        "<span class=\"ok\">commissioned</span>"
    } else {
        "<span class=\"none\">measured, nothing kept</span>"
    };
    let Conditions {
        machine,
        identity,
        date,
        temperature_c,
    } = conditions;
    let [identity, date, machine] = [identity, date, machine].map(|text| escaped(text));
    let air = temperature_c.map_or_else(
        || "temperature of the air not told".to_owned(),
        |celsius| format!("air {celsius} deg C"),
    );
    // Writing to a text does not fail.
    let _ = write!(
        page,
        "<h1>{machine}: {verdict}</h1>\n<p>{date}, {air}<br>{identity}</p>\n"
    );
    if let Some(changes) = changes {
        page += "<h2>changed since the last time</h2>\n";
        if changes.is_empty() {
            page += "<p>Nothing by a hundredth or more.</p>\n";
        } else {
            page += "<ul>\n";
            for change in changes {
                let _ = writeln!(page, "<li>{}</li>", escaped(&change.words()));
            }
            page += "</ul>\n";
        }
    }
    for done in all {
        let _ = write!(
            page,
            "<h2>{}</h2>\n<p>{}; {:.1} s</p>\n",
            escaped(done.step.name),
            escaped(done.step.about),
            done.seconds
        );
        if !done.found.findings.is_empty() {
            page += "<table><tr><th>measured</th><th>value</th><th>limit</th><th></th></tr>\n";
            for finding in &done.found.findings {
                let (class, verdict) = match (finding.passed, finding.limit.is_empty()) {
                    (true, true) => ("none", ""),
                    (true, false) => ("ok", "ok"),
                    (false, _) => ("failed", "failed"),
                };
                let _ = writeln!(
                    page,
                    "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"{class}\">{verdict}</td></tr>",
                    escaped(&finding.name),
                    escaped(&finding.value),
                    escaped(&finding.limit)
                );
            }
            page += "</table>\n";
        }
        for plot in &done.found.plots {
            page += &figure(&plot.svg, &plot.caption);
        }
        if let Some(failure) = &done.failure {
            let _ = writeln!(
                page,
                "<p class=\"failed\">Failed: {}.</p>\n<p>What to do: {}.</p>",
                escaped(&failure.what),
                escaped(failure.advice)
            );
        }
    }
    page + END
}

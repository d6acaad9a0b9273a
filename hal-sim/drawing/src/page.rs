//! Reports as pages that stand alone: one style, headings, tables and figures.

use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\n\
    h1{font-size:1.6em}h2{font-size:1.15em;margin:1.6em 0 .3em}p{margin:.2em 0 .6em;color:#555}\n\
    table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.25em .6em;border-bottom:1px solid #ddd;vertical-align:top}\n\
    figure{margin:1em 0}figure svg{width:100%;height:auto}figcaption{color:#555}\n\
    .ok{color:#176b2c}.failed{color:#a61b1b;font-weight:600}.none{color:#888}\n";

/// A page's beginning, with its title.
#[must_use]
pub fn head(title: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title><style>\n{STYLE}</style></head><body>\n",
        escaped(title)
    )
}

/// A page's end.
pub const END: &str = "</body></html>\n";

/// A picture with what is to be seen in it.
#[must_use]
pub fn figure(svg: &str, caption: &str) -> String {
    format!(
        "<figure>{svg}<figcaption>{}</figcaption></figure>\n",
        escaped(caption)
    )
}

/// A table: names of its columns, and rows of texts.
#[must_use]
pub fn table<const N: usize>(columns: [&str; N], rows: &[[String; N]]) -> String {
    let mut text = "<table><tr>".to_owned();
    // Writing to a text does not fail.
    for column in columns {
        let _ = write!(text, "<th>{}</th>", escaped(column));
    }
    text += "</tr>\n";
    for row in rows {
        text += "<tr>";
        for cell in row {
            let _ = write!(text, "<td>{}</td>", escaped(cell));
        }
        text += "</tr>\n";
    }
    text + "</table>\n"
}

/// Text as a page has it.
#[must_use]
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

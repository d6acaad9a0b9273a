//! `PARAMETERS.md` is what the table of parameters says. `UPDATE=1 cargo test -p firmware --test parameter_page` writes
//! it.

mod written_page;

use firmware::gcs::{Kind, PARAMETERS, Parameter};
use firmware::parameters::Parameters;
use std::fmt::Write;

const HEAD: &str = "# Parameters

Written by `UPDATE=1 cargo test -p firmware --test parameter_page` from the one table that the controller has
(`firmware/src/gcs/parameter/table/`); edit that, not this.

`SPA 1 <id> <value>` sets one, `SPA? 1 <id>` asks for it, `HPA?` lists all; ids in decimal or hexadecimal. Values are those that a
controller has before anything is stored. A value out of its range, or one that does not go together with the others, is refused with error 17, and
nothing of its line is done. Limits of motion that the drives do not bear with their load are refused with 4011 ([GCS.md](GCS.md#motion)). Level 1 needs `CCL 1 ADVANCED` on the same connection, or the answer is 60. Setting one in motion
is refused with 53, one that needs the servo off with 89. Limits of motion over what the stage was set up for need level 1.
`WPA 100` keeps them over a restart, `RPA` brings back what is kept. Another reading at pivot angle 0 or another direction of
an encoder takes the reference: `FRF` afterwards.
";

fn row(parameter: &Parameter) -> String {
    let kind = match parameter.kind {
        Kind::Int => "whole",
        Kind::Float => "number",
        Kind::Char => "text",
    };
    let value = (parameter.number(&Parameters::REFERENCE.uncommissioned()))
        .map_or_else(String::new, |value| value.to_string());
    let range = if parameter.is_read_only() {
        String::new()
    } else {
        format!("{} to {}", parameter.range[0], parameter.range[1])
    };
    format!(
        "| 0x{:08X} | {}{} | {} | {kind} | {value} | {range} | {} | {} |\n",
        parameter.id,
        parameter.text,
        parameter.whose(),
        parameter.unit,
        parameter.level,
        parameter.when
    )
}

fn page() -> String {
    let mut page = HEAD.to_owned();
    let mut group = "";
    for parameter in PARAMETERS {
        if parameter.group != group {
            group = parameter.group;
            write!(
                page,
                "\n## {}{}\n\n| id | what | unit | kind | value | range | level | may be set |\n|---|---|---|---|---|---|---|---|\n",
                group[..1].to_uppercase(),
                &group[1..]
            )
            .unwrap();
        }
        page += &row(parameter);
    }
    page
}

#[test]
fn page_is_up_to_date() {
    written_page::hold("PARAMETERS.md", &page());
}

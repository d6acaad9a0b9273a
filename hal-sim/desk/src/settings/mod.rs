//! `tripivot settings`: the settings of a controller that runs, as a readable file, and back.
//!
//! | file | idea |
//! |---|---|
//! | here | asking a controller for them, and giving them to one |
//! | `file` | how they are written down |

mod file;

pub use file::{Macro, Parameter, Settings, SettingsError};

use crate::record::RecordError;
use crate::record::desk::Desk;
use crate::web::Endpoint;

/// What came of bringing settings back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changed {
    /// Parameters that had another value.
    pub parameters: usize,
    /// Macros that were not there, or were others.
    pub macros: usize,
}

/// Asks a controller for all parameters that can be set, and for its macros.
///
/// # Errors
/// [`SettingsError::Controller`]
pub fn export(endpoint: &Endpoint) -> Result<Settings, SettingsError> {
    let mut desk = Desk::open(endpoint)?;
    let help = desk.ask("HPA?")?.unwrap_or_default();
    let values = desk.ask("SPA?")?.unwrap_or_default();
    let parameters = (help.lines())
        .filter(|line| !line.ends_with("(read only)"))
        .filter_map(|line| {
            let (id, rest) = line.split_once("=\t")?;
            // Level, items, kind, group, text.
            let text = rest.splitn(5, '\t').nth(4)?;
            Some(Parameter {
                id: id.to_owned(),
                value: value(&values, id)?.to_owned(),
                text: text.to_owned(),
            })
        })
        .collect();
    Ok(Settings {
        of: desk.identity().to_owned(),
        parameters,
        macros: macros(&mut desk)?,
    })
}

/// The value of a parameter in an answer of `SPA?`.
fn value<'a>(answer: &'a str, id: &str) -> Option<&'a str> {
    (answer.lines()).find_map(|line| line.strip_prefix("1 ")?.strip_prefix(id)?.strip_prefix('='))
}

fn macros(desk: &mut Desk) -> Result<Vec<Macro>, RecordError> {
    let names = desk.ask("MAC?")?.unwrap_or_default();
    let names = names.lines().filter(|name| !name.is_empty());
    names
        .map(|name| {
            let lines = desk.ask(&format!("MAC? {name}"))?.unwrap_or_default();
            let lines = lines.lines().filter(|line| !line.is_empty());
            Ok(Macro {
                name: name.to_owned(),
                lines: lines.map(str::to_owned).collect(),
            })
        })
        .collect()
}

/// Gives a controller settings, as far as it has others, and has them kept. Parameters that have to go together with others
/// are tried again after those.
///
/// # Errors
/// [`SettingsError::Controller`]; nothing has been kept then, and `RPA` brings back what was before.
pub fn import(settings: &Settings, endpoint: &Endpoint) -> Result<Changed, SettingsError> {
    let mut desk = Desk::open(endpoint)?;
    desk.carry_out("CCL 1 ADVANCED")?;
    let there = desk.ask("SPA?")?.unwrap_or_default();
    let mut left: Vec<&Parameter> = (settings.parameters.iter())
        .filter(|parameter| value(&there, &parameter.id) != Some(&*parameter.value))
        .collect();
    let mut changed = Changed {
        parameters: left.len(),
        macros: 0,
    };
    while !left.is_empty() {
        let before = left.len();
        let mut refusal = None;
        left.retain(|parameter| {
            let line = format!("SPA 1 {} {}", parameter.id, parameter.value);
            match desk.carry_out(&line) {
                Ok(()) => false,
                Err(error) => {
                    refusal.get_or_insert(error);
                    true
                }
            }
        });
        if let Some(refusal) = refusal.filter(|_| left.len() == before) {
            return Err(refusal.into());
        }
    }
    desk.carry_out("WPA 100")?;
    let there = macros(&mut desk)?;
    for wanted in settings.macros.iter().filter(|m| !there.contains(m)) {
        desk.carry_out(&format!("MAC BEG {}", wanted.name))?;
        let recorded = (wanted.lines.iter()).try_for_each(|line| desk.carry_out(line));
        // In any case, so that the recording does not stay open.
        let ended = desk.carry_out("MAC END");
        recorded.and(ended)?;
        changed.macros += 1;
    }
    Ok(changed)
}

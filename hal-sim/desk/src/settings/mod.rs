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

/// Gives a controller settings, as far as it has others, and has them kept: all of them, or none.
///
/// # Errors
/// [`SettingsError::Controller`]: everything is as it was, or [`SettingsError::NotTakenBack`].
pub fn import(settings: &Settings, endpoint: &Endpoint) -> Result<Changed, SettingsError> {
    let mut desk = Desk::open(endpoint)?;
    desk.carry_out("CCL 1 ADVANCED")?;
    let values = desk.ask("SPA?")?.unwrap_or_default();
    let macros_there = macros(&mut desk)?;
    let parameters: Vec<(&str, &str)> = (settings.parameters.iter())
        .map(|parameter| (&*parameter.id, &*parameter.value))
        .filter(|(id, wanted)| value(&values, id) != Some(wanted))
        .collect();
    let macros: Vec<&Macro> = (settings.macros.iter())
        .filter(|wanted| !macros_there.contains(wanted))
        .collect();
    let given = give(&mut desk, &parameters, &macros).and_then(|()| desk.carry_out("WPA 100"));
    if let Err(error) = given {
        let before: Vec<_> = (parameters.iter())
            .filter_map(|(id, _)| Some((*id, value(&values, id)?)))
            .collect();
        let taken_back = take_back(&mut desk, &before, &macros, &macros_there);
        return Err(match taken_back {
            Ok(()) => error.into(),
            Err(_) => SettingsError::NotTakenBack(error),
        });
    }
    Ok(Changed {
        parameters: parameters.len(),
        macros: macros.len(),
    })
}

fn give(
    desk: &mut Desk,
    parameters: &[(&str, &str)],
    macros: &[&Macro],
) -> Result<(), RecordError> {
    set(desk, parameters)?;
    macros
        .iter()
        .try_for_each(|wanted| give_macro(desk, wanted))
}

/// Sets parameters. Those that have to go together with others are tried again after those.
fn set(desk: &mut Desk, parameters: &[(&str, &str)]) -> Result<(), RecordError> {
    let mut left = parameters.to_vec();
    while !left.is_empty() {
        let before = left.len();
        let mut refusal = None;
        left.retain(
            |(id, wanted)| match desk.carry_out(&format!("SPA 1 {id} {wanted}")) {
                Ok(()) => false,
                Err(error) => {
                    refusal.get_or_insert(error);
                    true
                }
            },
        );
        if let Some(refusal) = refusal.filter(|_| left.len() == before) {
            return Err(refusal);
        }
    }
    Ok(())
}

fn give_macro(desk: &mut Desk, wanted: &Macro) -> Result<(), RecordError> {
    desk.carry_out(&format!("MAC BEG {}", wanted.name))?;
    let recorded = (wanted.lines.iter()).try_for_each(|line| desk.carry_out(line));
    // In any case, so that the recording does not stay open.
    let ended = desk.carry_out("MAC END");
    recorded.and(ended)
}

/// Gives back the values and macros that were there.
fn take_back(
    desk: &mut Desk,
    before: &[(&str, &str)],
    changed: &[&Macro],
    macros_there: &[Macro],
) -> Result<(), RecordError> {
    set(desk, before)?;
    let now = macros(desk)?;
    for changed in changed
        .iter()
        .filter(|changed| now.iter().any(|there| there.name == changed.name))
    {
        match macros_there.iter().find(|there| there.name == changed.name) {
            Some(there) => give_macro(desk, there)?,
            None => desk.carry_out(&format!("MAC DEL {}", changed.name))?,
        }
    }
    Ok(())
}

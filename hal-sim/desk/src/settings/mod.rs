//! `tripivot settings`: the settings of a controller that runs, as a readable file, and back.
//!
//! | file | idea |
//! |---|---|
//! | here | asking a controller for them, and giving them to one |
//! | `file` | how they are written down |

mod file;

pub use file::{Macro, Parameter, Settings, SettingsError};

use crate::line::Endpoint;
use crate::record::RecordError;
use crate::record::desk::Desk;
use firmware::gcs::PARAMETERS;

/// A line to a controller, and its answer if it has one.
pub(crate) type Ask<'a> = dyn FnMut(&str) -> Result<Option<String>, RecordError> + 'a;

/// What came of bringing settings back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changed {
    /// Parameters that had another value.
    pub parameters: usize,
    /// Macros that were not there, or were others.
    pub macros: usize,
}

/// Asks a controller for all parameters that it keeps, each pivot's by itself, and for its macros.
///
/// # Errors
/// [`SettingsError::Controller`]
pub fn export(endpoint: &Endpoint) -> Result<Settings, SettingsError> {
    let mut desk = Desk::open(endpoint)?;
    Ok(export_from(&mut |line| desk.ask(line))?)
}

/// The same, of whoever answers.
pub(crate) fn export_from(ask: &mut Ask<'_>) -> Result<Settings, RecordError> {
    let of = ask("*IDN?")?.unwrap_or_default();
    let help = ask("HPA?")?.unwrap_or_default();
    let values = ask("SPA?")?.unwrap_or_default();
    let parameters = (help.lines())
        .filter(|line| !line.ends_with("(read only)"))
        .filter_map(|line| {
            let (id, rest) = line.split_once("=\t").filter(|(id, _)| is_kept(id))?;
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
        of: of.trim().to_owned(),
        parameters,
        macros: macros(ask)?,
    })
}

/// Whether it is kept under this number: not where it stands for those of three pivots.
fn is_kept(id: &str) -> bool {
    let number = id.strip_prefix("0x");
    let number = number.and_then(|digits| u32::from_str_radix(digits, 16).ok());
    !(PARAMETERS.iter()).any(|one| Some(one.id) == number && !one.is_stored())
}

/// The value of a parameter in an answer of `SPA?`.
fn value<'a>(answer: &'a str, id: &str) -> Option<&'a str> {
    (answer.lines()).find_map(|line| line.strip_prefix("1 ")?.strip_prefix(id)?.strip_prefix('='))
}

fn macros(ask: &mut Ask<'_>) -> Result<Vec<Macro>, RecordError> {
    let names = ask("MAC?")?.unwrap_or_default();
    let names = names.lines().filter(|name| !name.is_empty());
    names
        .map(|name| {
            let lines = ask(&format!("MAC? {name}"))?.unwrap_or_default();
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
    import_to(settings, &mut |line| desk.ask(line))
}

/// The same, to whoever answers.
pub(crate) fn import_to(settings: &Settings, ask: &mut Ask<'_>) -> Result<Changed, SettingsError> {
    ask("CCL 1 ADVANCED")?;
    let values = ask("SPA?")?.unwrap_or_default();
    let macros_there = macros(ask)?;
    let parameters = (settings.parameters.iter())
        .filter(|wanted| value(&values, &wanted.id) != Some(&wanted.value))
        .count();
    let macros: Vec<&Macro> = (settings.macros.iter())
        .filter(|wanted| !macros_there.contains(wanted))
        .collect();
    let given = give(ask, settings, &macros).and_then(|()| ask("WPA 100").map(|_| ()));
    if let Err(error) = given {
        let taken_back = take_back(ask, &values, &macros, &macros_there);
        return Err(match taken_back {
            Ok(()) => error.into(),
            Err(_) => SettingsError::NotTakenBack(error),
        });
    }
    Ok(Changed {
        parameters,
        macros: macros.len(),
    })
}

fn give(ask: &mut Ask<'_>, settings: &Settings, macros: &[&Macro]) -> Result<(), RecordError> {
    let wanted = |kept: bool| -> Vec<(&str, &str)> {
        (settings.parameters.iter())
            .map(|parameter| (&*parameter.id, &*parameter.value))
            .filter(|(id, _)| is_kept(id) == kept)
            .collect()
    };
    // A number for all pivots takes those of each with it, so that they come after it.
    set(ask, wanted(false))?;
    set(ask, wanted(true))?;
    macros.iter().try_for_each(|wanted| give_macro(ask, wanted))
}

/// Sets parameters that have another value. Those that have to go together with others are tried again after those.
fn set(ask: &mut Ask<'_>, mut left: Vec<(&str, &str)>) -> Result<(), RecordError> {
    let values = ask("SPA?")?.unwrap_or_default();
    // What reads as pivot 1's does not tell those of the others.
    left.retain(|(id, wanted)| !is_kept(id) || value(&values, id) != Some(wanted));
    while !left.is_empty() {
        let before = left.len();
        let mut refusal = None;
        left.retain(|(id, wanted)| match ask(&format!("SPA 1 {id} {wanted}")) {
            Ok(_) => false,
            Err(error) => {
                refusal.get_or_insert(error);
                true
            }
        });
        if let Some(refusal) = refusal.filter(|_| left.len() == before) {
            return Err(refusal);
        }
    }
    Ok(())
}

fn give_macro(ask: &mut Ask<'_>, wanted: &Macro) -> Result<(), RecordError> {
    ask(&format!("MAC BEG {}", wanted.name))?;
    let recorded = (wanted.lines.iter()).try_for_each(|line| ask(line).map(|_| ()));
    // In any case, so that the recording does not stay open.
    let ended = ask("MAC END").map(|_| ());
    recorded.and(ended)
}

/// Gives a controller the values in force that `SPA?` has told, without having them kept.
pub(crate) fn bring_back(ask: &mut Ask<'_>, values: &str) -> Result<(), RecordError> {
    let before = (values.lines())
        .filter_map(|line| line.strip_prefix("1 ")?.split_once('='))
        .filter(|(id, _)| is_kept(id));
    set(ask, before.collect())
}

/// Gives back the values, as `SPA?` has told them, and the macros that were there.
fn take_back(
    ask: &mut Ask<'_>,
    values: &str,
    changed: &[&Macro],
    macros_there: &[Macro],
) -> Result<(), RecordError> {
    bring_back(ask, values)?;
    let now = macros(ask)?;
    for changed in changed
        .iter()
        .filter(|changed| now.iter().any(|there| there.name == changed.name))
    {
        match macros_there.iter().find(|there| there.name == changed.name) {
            Some(there) => give_macro(ask, there)?,
            None => {
                ask(&format!("MAC DEL {}", changed.name))?;
            }
        }
    }
    Ok(())
}

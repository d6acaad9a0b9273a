//! The parameters that `SPA?`, `SPA` and `HPA?` know: one line each in [`PARAMETERS`], from which all three come, and the page
//! `PARAMETERS.md` with them.
//!
//! Ids that clients ask for by themselves are those of the hexapod profile; the others begin with 0x5450.
//!
//! | file | idea |
//! |---|---|
//! | here | what a parameter is |
//! | `table` | which there are |
//! | `check` | what has to hold between them |
//! | `set` | when one may be set, and how it reaches the tick |

mod consistency;
mod execute;
mod table;

pub(super) use execute::LEVEL_PASSWORD;
pub use table::PARAMETERS;

use super::error::ErrorCode;
use crate::commander::axis::Axis;
use crate::parameters::Parameters;
use core::fmt;

/// What a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// `1`: the controller as a whole.
    System,
    /// An axis.
    Axis(Axis),
}

/// A parameter of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    /// Whose.
    pub item: Item,
    /// Which.
    pub id: u32,
}

/// Parameters that a line can name.
pub const MAX_ADDRESSES: usize = 8;
/// The parameters that `SPA?` names, from the left; none stands for all.
pub type Addresses = [Option<Address>; MAX_ADDRESSES];
/// The parameters that `SPA` sets, from the left.
pub type Settings = [Option<(Address, f64)>; MAX_ADDRESSES];

/// A parameter: what `HPA?` says of it.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its number.
    pub id: u32,
    /// What kind of value it has.
    pub kind: Kind,
    /// When it may be set.
    pub when: When,
    /// Command level that setting it needs.
    pub level: u8,
    /// What it belongs to, in a word.
    pub group: &'static str,
    /// What it is.
    pub text: &'static str,
    /// Unit of its value; empty where it has none.
    pub unit: &'static str,
    /// Smallest and largest value.
    pub range: [f64; 2],
    source: ValueSource,
}

/// Kind of a parameter's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// A text.
    Char,
}

/// When a parameter may be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Never: it is what it is.
    Never,
    /// With everything at rest, whether the servo is on or off.
    AtRest,
    /// With the servo off.
    ServoOff,
}

/// Where its value is.
#[derive(Clone, Copy, Debug)]
enum ValueSource {
    /// Read only.
    ReadOnly(fn(&Parameters) -> f64),
    /// A text for each axis; read only.
    Axis(fn(Axis) -> &'static str),
    /// How it is read and set.
    Settable(fn(&Parameters) -> f64, fn(&mut Parameters, f64)),
}

/// A value as it is answered.
pub(super) enum Value {
    Number(f64),
    Text(&'static str),
}

impl Parameter {
    /// That of an id.
    pub fn find(id: u32) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.id == id)
    }

    /// Whether it can never be set.
    pub const fn is_read_only(&self) -> bool {
        matches!(self.when, When::Never)
    }

    /// Whether it has a value for `item`: those of the system are told for every axis too.
    pub(super) const fn belongs_to(&self, item: Item) -> bool {
        !matches!((&self.source, item), (ValueSource::Axis(_), Item::System))
    }

    /// The items under which it is listed.
    pub(super) fn items(&self) -> impl Iterator<Item = Item> {
        let of_axes = matches!(self.source, ValueSource::Axis(_));
        let axes = (Axis::ALL.into_iter())
            .filter(move |_| of_axes)
            .map(Item::Axis);
        axes.chain((!of_axes).then_some(Item::System))
    }

    /// Its value for an item that it [belongs to](Self::belongs_to).
    pub(super) fn value(&self, item: Item, parameters: &Parameters) -> Value {
        match (&self.source, item) {
            (ValueSource::ReadOnly(get) | ValueSource::Settable(get, _), _) => {
                Value::Number(get(parameters))
            }
            (ValueSource::Axis(text), Item::Axis(axis)) => Value::Text(text(axis)),
            (ValueSource::Axis(_), Item::System) => Value::Text(""),
        }
    }

    /// Its value, where that is a number.
    pub fn number(&self, parameters: &Parameters) -> Option<f64> {
        match self.source {
            ValueSource::ReadOnly(get) | ValueSource::Settable(get, _) => Some(get(parameters)),
            ValueSource::Axis(_) => None,
        }
    }

    /// Puts a value that can be set into `parameters`, as it stands: whether the parameters go together is for
    /// [`Parameters::are_sound`].
    ///
    /// # Errors
    /// [`ErrorCode::ReadOnly`], or [`ErrorCode::OutOfRange`] when it is out of its range or not whole where it has to be;
    /// nothing has changed then.
    pub fn set(&self, value: f64, parameters: &mut Parameters) -> Result<(), ErrorCode> {
        let ValueSource::Settable(_, set) = self.source else {
            return Err(ErrorCode::ReadOnly);
        };
        let [lowest, highest] = self.range;
        let fits = self.kind != Kind::Int || libm::rint(value) == value;
        if !fits || !(lowest..=highest).contains(&value) {
            return Err(ErrorCode::OutOfRange);
        }
        set(parameters, value);
        Ok(())
    }
}

/// Its line of `HPA?`.
impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            Kind::Int => "INT",
            Kind::Float => "FLOAT",
            Kind::Char => "CHAR",
        };
        let items = self.items().count();
        let (id, level, group, text) = (self.id, self.level, self.group, self.text);
        write!(f, "0x{id:X}=\t{level}\t{items}\t{kind}\t{group}\t{text}")?;
        if !self.unit.is_empty() {
            write!(f, ", {}", self.unit)?;
        }
        if self.is_read_only() {
            f.write_str(" (read only)")
        } else {
            let [lowest, highest] = self.range;
            write!(f, ", {lowest} to {highest}")
        }
    }
}

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Never => "read only",
            Self::AtRest => "at rest",
            Self::ServoOff => "servo off",
        })
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::System => f.write_str("1"),
            Self::Axis(axis) => write!(f, "{}", axis.letter()),
        }
    }
}

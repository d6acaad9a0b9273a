//! What a parameter is: its number, its range, when it may be set, and where its value is.

use super::address::Item;
use crate::commander::axis::Axis;
use crate::gcs::error::ErrorCode;
use crate::parameters::Parameters;
use core::fmt;

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
    pub(super) source: ValueSource,
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
pub(super) enum ValueSource {
    /// Read only.
    ReadOnly(fn(&Parameters) -> f64),
    /// A text for each axis; read only.
    Axis(fn(Axis) -> &'static str),
    /// How it is read and set.
    Settable(fn(&Parameters) -> f64, fn(&mut Parameters, f64)),
    /// The same for a pivot.
    Pivot(usize, GetOfPivot, SetOfPivot),
    /// One number for what each pivot has of its own: it sets all three, and reads as pivot 1's.
    AllPivots(GetOfPivot, SetOfPivot),
}

pub(in crate::gcs) type GetOfPivot = fn(&Parameters, usize) -> f64;
pub(in crate::gcs) type SetOfPivot = fn(&mut Parameters, usize, f64);

/// A value as it is answered.
pub(in crate::gcs) enum Value {
    Number(f64),
    Text(&'static str),
}

impl Parameter {
    /// Whether it can never be set.
    pub const fn is_read_only(&self) -> bool {
        matches!(self.when, When::Never)
    }

    /// Whether it has a value for `item`: those of the system are told for every axis too.
    pub(in crate::gcs) const fn belongs_to(&self, item: Item) -> bool {
        !matches!((&self.source, item), (ValueSource::Axis(_), Item::System))
    }

    /// The items under which it is listed.
    pub(in crate::gcs) fn items(&self) -> impl Iterator<Item = Item> {
        let of_axes = matches!(self.source, ValueSource::Axis(_));
        let axes = (Axis::ALL.into_iter())
            .filter(move |_| of_axes)
            .map(Item::Axis);
        axes.chain((!of_axes).then_some(Item::System))
    }

    /// Its value for an item that it [belongs to](Self::belongs_to).
    pub(in crate::gcs) fn value(&self, item: Item, parameters: &Parameters) -> Value {
        match (&self.source, item) {
            (ValueSource::Axis(text), Item::Axis(axis)) => Value::Text(text(axis)),
            _ => (self.number(parameters)).map_or(Value::Text(""), Value::Number),
        }
    }

    /// Its value, where that is a number.
    pub fn number(&self, parameters: &Parameters) -> Option<f64> {
        match self.source {
            ValueSource::ReadOnly(get) | ValueSource::Settable(get, _) => Some(get(parameters)),
            ValueSource::Pivot(pivot, get, _) => Some(get(parameters, pivot)),
            ValueSource::AllPivots(get, _) => Some(get(parameters, 0)),
            ValueSource::Axis(_) => None,
        }
    }

    /// Puts a value that can be set into `parameters`, as it stands: whether the parameters go together is for
    /// [`Parameters::are_sound`].
    ///
    /// # Errors
    /// [`ErrorCode::ReadOnly`], or [`ErrorCode::OutOfRange`] when it is out of its range or not whole where it has to
    /// be; nothing has changed then.
    pub fn set(&self, value: f64, parameters: &mut Parameters) -> Result<(), ErrorCode> {
        if self.is_read_only() {
            return Err(ErrorCode::ReadOnly);
        }
        let [lowest, highest] = self.range;
        let fits = self.kind != Kind::Int || libm::rint(value) == value;
        if !fits || !(lowest..=highest).contains(&value) {
            return Err(ErrorCode::OutOfRange);
        }
        match self.source {
            ValueSource::Settable(_, set) => set(parameters, value),
            ValueSource::Pivot(pivot, _, set) => set(parameters, pivot, value),
            ValueSource::AllPivots(_, set) => {
                (0..3).for_each(|pivot| set(parameters, pivot, value))
            }
            ValueSource::ReadOnly(_) | ValueSource::Axis(_) => {}
        }
        Ok(())
    }

    /// Makes it what it is in others.
    ///
    /// # Errors
    /// [`ErrorCode::ReadOnly`].
    pub fn copy(&self, others: &Parameters, parameters: &mut Parameters) -> Result<(), ErrorCode> {
        if let ValueSource::AllPivots(get, set) = self.source {
            (0..3).for_each(|pivot| set(parameters, pivot, get(others, pivot)));
            return Ok(());
        }
        let value = self.number(others).ok_or(ErrorCode::ReadOnly)?;
        self.set(value, parameters)
    }

    /// Whether it is kept under this number: not where three others keep the same.
    pub const fn is_stored(&self) -> bool {
        !self.is_read_only() && !matches!(self.source, ValueSource::AllPivots(..))
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
        write!(
            f,
            "0x{id:X}=\t{level}\t{items}\t{kind}\t{group}\t{text}{}",
            self.whose()
        )?;
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

impl Parameter {
    /// Which pivot's it is, as words behind what it is.
    pub fn whose(&self) -> &'static str {
        match self.source {
            ValueSource::Pivot(0, ..) => " (pivot 1)",
            ValueSource::Pivot(1, ..) => " (pivot 2)",
            ValueSource::Pivot(..) => " (pivot 3)",
            ValueSource::AllPivots(..) => " (all pivots; reads as pivot 1's)",
            _ => "",
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

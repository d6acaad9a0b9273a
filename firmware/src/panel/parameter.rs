//! The parameters that `SPA?`, `SPA` and `HPA?` know: one line each, from which all three come.
//!
//! Ids that clients ask for by themselves are those of the hexapod profile; the others begin with 0x5450. Limits of motion can
//! be lowered, down to a thousandth, and raised again as far as the stage was set up for; everything else is read only.

use super::axis::Axis;
use crate::motion::Limits;
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
pub const ADDRESSES: usize = 8;
/// The parameters that `SPA?` names, from the left; none stands for all.
pub type Addresses = [Option<Address>; ADDRESSES];
/// The parameters that `SPA` sets, from the left.
pub type Settings = [Option<(Address, f64)>; ADDRESSES];

/// A parameter.
pub(super) struct Parameter {
    pub id: u32,
    kind: Kind,
    text: &'static str,
    source: Source,
}

#[derive(Clone, Copy)]
enum Kind {
    Int,
    Float,
    Char,
}

/// Where its value is.
enum Source {
    /// The same for the whole controller; read only.
    System(fn(&Parameters) -> f64),
    /// A text for each axis; read only.
    Axis(fn(Axis) -> &'static str),
    /// A limit of motion.
    Limit(fn(&mut Limits) -> &mut f64),
}

/// A value as it is answered.
pub(super) enum Value {
    Number(f64),
    Text(&'static str),
}

/// How far a limit of motion can be lowered.
const LOWEST_SHARE: f64 = 1e-3;

impl Parameter {
    /// That of an id.
    pub fn find(id: u32) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| parameter.id == id)
    }

    pub const fn is_read_only(&self) -> bool {
        !matches!(self.source, Source::Limit(_))
    }

    /// Whether it has a value for `item`: those of the system are told for every axis too.
    pub const fn belongs_to(&self, item: Item) -> bool {
        !matches!((&self.source, item), (Source::Axis(_), Item::System))
    }

    /// The items under which it is listed.
    pub fn items(&self) -> impl Iterator<Item = Item> {
        let of_axes = matches!(self.source, Source::Axis(_));
        let axes = (Axis::ALL.into_iter())
            .filter(move |_| of_axes)
            .map(Item::Axis);
        axes.chain((!of_axes).then_some(Item::System))
    }

    /// Its value for an item that it [belongs to](Self::belongs_to).
    pub fn value(&self, item: Item, parameters: &Parameters) -> Value {
        match (&self.source, item) {
            (Source::System(value), _) => Value::Number(value(parameters)),
            (Source::Limit(limit), _) => Value::Number(*limit(&mut { parameters.limits })),
            (Source::Axis(text), Item::Axis(axis)) => Value::Text(text(axis)),
            (Source::Axis(_), Item::System) => Value::Text(""),
        }
    }

    /// Sets it in `limits`; false, and nothing has changed, when that is out of what `rated` allows.
    pub fn set(&self, value: f64, limits: &mut Limits, rated: &Limits) -> bool {
        let Source::Limit(limit) = self.source else {
            return false;
        };
        let most = *limit(&mut { *rated });
        let allowed = (most * LOWEST_SHARE..=most).contains(&value);
        if allowed {
            *limit(limits) = value;
        }
        allowed
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
        let (items, group) = match self.source {
            Source::Axis(_) => (Axis::ALL.len(), "axis"),
            Source::System(_) => (1, "read only"),
            Source::Limit(_) => (1, "limit"),
        };
        write!(
            f,
            "0x{:X}=\t0\t{items}\t{kind}\t{group}\t{}",
            self.id, self.text
        )
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

const fn float(id: u32, text: &'static str, value: fn(&Parameters) -> f64) -> Parameter {
    Parameter {
        id,
        kind: Kind::Float,
        text,
        source: Source::System(value),
    }
}

const fn int(id: u32, text: &'static str, value: fn(&Parameters) -> f64) -> Parameter {
    Parameter {
        id,
        kind: Kind::Int,
        text,
        source: Source::System(value),
    }
}

const fn limit(id: u32, text: &'static str, limit: fn(&mut Limits) -> &mut f64) -> Parameter {
    Parameter {
        id,
        kind: Kind::Float,
        text,
        source: Source::Limit(limit),
    }
}

/// Every parameter, in the order of `HPA?`.
#[rustfmt::skip]
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter { id: 0x0700_0601, kind: Kind::Char, text: "unit of the axis", source: Source::Axis(Axis::unit) },
    float(0x0E00_0200, "servo update time, s", |p| 1.0 / p.limits.rate_hz),
    // There is no recorder to be asked yet, and clients ask.
    int(0x1600_0201, "points of the data recorder", |_| 0.0),
    int(0x1900_1900, "trajectory source: 0 controller", |_| 0.0),
    limit(0x5450_0100, "speed of the platform centre, mm/s", |l| &mut l.speed_mm_s),
    limit(0x5450_0101, "acceleration of the platform centre, mm/s^2", |l| &mut l.acceleration_mm_s2),
    limit(0x5450_0102, "jerk of the platform centre, mm/s^3", |l| &mut l.jerk_mm_s3),
    limit(0x5450_0103, "speed of rotation, deg/s", |l| &mut l.turn_speed_deg_s),
    limit(0x5450_0104, "acceleration of rotation, deg/s^2", |l| &mut l.turn_acceleration_deg_s2),
    limit(0x5450_0105, "jerk of rotation, deg/s^3", |l| &mut l.turn_jerk_deg_s3),
    limit(0x5450_0106, "rate of a pivot, rad/s", |l| &mut l.pivot_rate_rad_s),
    float(0x5450_0200, "radius of the track, mm", |p| p.geometry.radius_mm),
    float(0x5450_0201, "start of a guide, track radii", |p| p.geometry.guide_start),
    float(0x5450_0202, "length of a guide, track radii", |p| p.geometry.guide_length),
    float(0x5450_0203, "smallest angle between pivots, deg", |p| p.geometry.separation_rad.to_degrees()),
    float(0x5450_0300, "position gain, 1/s", |p| p.servo.position_1_s),
    float(0x5450_0301, "velocity gain, V s/rad", |p| p.servo.velocity_v_s_rad),
    float(0x5450_0302, "integral gain, V/rad", |p| p.servo.integral_v_rad),
    float(0x5450_0400, "settling window, encoder counts", |p| p.window.counts),
    float(0x5450_0401, "settling dwell, s", |p| p.window.dwell_s),
    float(0x5450_0500, "largest following error, rad", |p| p.supervision.following_error_rad),
    float(0x5450_0501, "lowest supply, V", |p| p.supervision.supply_min_v),
    int(0x5450_0502, "bad encoder frames that are bridged", |p| f64::from(p.supervision.bridged_frames)),
];

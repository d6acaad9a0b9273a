//! The six axes of the hexapod profile, sets of them, and values for them.

/// An axis of the interface. Z, U and V are frozen at 0; theta is W.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// x of the platform centre, mm.
    X,
    /// y of the platform centre, mm.
    Y,
    /// Frozen, mm.
    Z,
    /// Frozen, deg.
    U,
    /// Frozen, deg.
    V,
    /// Orientation theta, multi-turn, deg.
    W,
}

/// A value for each axis that was named, in the order of [`Axis::ALL`]; mm and deg.
pub type AxisValues = [Option<f64>; 6];

/// Coordinates in the order of [`Axis::ALL`], mm and deg.
pub type Coordinates = [f64; 6];

/// Lowest and highest coordinate of each axis, mm and deg.
pub type Travel = [[f64; 2]; 6];

/// The coordinates with those replaced that have a value.
pub fn replaced(coordinates: &Coordinates, values: &AxisValues) -> Coordinates {
    core::array::from_fn(|i| values[i].unwrap_or(coordinates[i]))
}

impl Axis {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::U, Self::V, Self::W];

    /// The axis of a name: one letter, in either case.
    pub fn named(name: &[u8]) -> Option<Self> {
        let [letter] = name else { return None };
        let letter = char::from(letter.to_ascii_uppercase());
        Self::ALL.into_iter().find(|axis| axis.letter() == letter)
    }

    /// Its name.
    pub const fn letter(self) -> char {
        match self {
            Self::X => 'X',
            Self::Y => 'Y',
            Self::Z => 'Z',
            Self::U => 'U',
            Self::V => 'V',
            Self::W => 'W',
        }
    }

    /// Unit of its positions.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::X | Self::Y | Self::Z => "mm",
            Self::U | Self::V | Self::W => "deg",
        }
    }

    /// Its place in [`Axis::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Its place in a [`Position`](crate::motion::Position); `None` for a frozen axis.
    pub const fn component(self) -> Option<usize> {
        match self {
            Self::X => Some(0),
            Self::Y => Some(1),
            Self::W => Some(2),
            Self::Z | Self::U | Self::V => None,
        }
    }
}

/// A set of axes: bit i is [`Axis::ALL`]`[i]`, counted from the lowest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisSet(u8);

impl AxisSet {
    /// No axis.
    pub const EMPTY: Self = Self(0);
    /// X, Y, Z, U, V, W.
    pub const ALL: Self = Self(0x3F);
    /// X, Y and W: those that can move. Their masks need no hexadecimal letter.
    pub const MOVABLE: Self = Self(0x23);

    /// Whether `axis` is in it.
    pub const fn contains(self, axis: Axis) -> bool {
        self.0 >> axis.index() & 1 == 1
    }

    /// Adds an axis; false when it was there already.
    pub const fn insert(&mut self, axis: Axis) -> bool {
        let new = !self.contains(axis);
        self.0 |= 1 << axis.index();
        new
    }

    /// Whether no axis is in it.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Bit i for [`Axis::ALL`]`[i]`.
    pub const fn mask(self) -> u8 {
        self.0
    }

    /// Its axes, in the order of [`Axis::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Axis> {
        Axis::ALL
            .into_iter()
            .filter(move |&axis| self.contains(axis))
    }
}

//! What an instrument cannot tell, however often it measures: directions of the unknowns in which no row changes.
//!
//! A choice of frames is among them always, and belongs to the user; a scale where no length is known. Others mean that the instrument
//! does not see a real error of the machine.

use core::fmt;

use nalgebra::{DMatrix, DVector};

use crate::kit::Instrument;
use crate::least_squares::Problem;
use crate::model::GUIDES_RAD;
use crate::{MACHINE_NUMBERS, visit::Rows};
use kinematics::COEFFICIENTS;

/// A singular value so small, over the largest, is 0 but for rounding, which leaves 1e-16; the weakest real direction, of ends of guides,
/// has 2e-11.
const ZERO: f64 = 1e-13;
/// A freedom has a name where it is that direction but for this share.
const NAMED: f64 = 1e-2;
/// Less than this share of a direction is rounding.
const PRESENT: f64 = 1e-6;

/// A freedom with a name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Freedom {
    /// Where the base frame's origin lies, in x or in y.
    BaseX,
    /// See [`Freedom::BaseX`].
    BaseY,
    /// Where the base frame's x axis points.
    BaseTurn,
    /// Which point of the platform is its centre, in x' or in y'.
    PlatformX,
    /// See [`Freedom::PlatformX`].
    PlatformY,
    /// What orientation of the platform is called 0.
    PlatformTurn,
    /// How long a mm is.
    Scale,
    /// The plate's shear looks like errors of the machine.
    PlateShear,
    /// The plate's aspect ratio looks like errors of the machine.
    PlateAspect,
}

/// All of them.
const ALL: [Freedom; 9] = [
    Freedom::BaseX,
    Freedom::BaseY,
    Freedom::BaseTurn,
    Freedom::PlatformX,
    Freedom::PlatformY,
    Freedom::PlatformTurn,
    Freedom::Scale,
    Freedom::PlateShear,
    Freedom::PlateAspect,
];

impl Freedom {
    /// Whether it is the user's to choose, and no error of the machine.
    #[must_use]
    pub const fn is_choice(self) -> bool {
        !matches!(self, Self::PlateShear | Self::PlateAspect)
    }
}

impl fmt::Display for Freedom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BaseX => "base frame's origin in x",
            Self::BaseY => "base frame's origin in y",
            Self::BaseTurn => "base frame's direction",
            Self::PlatformX => "platform's centre in x'",
            Self::PlatformY => "platform's centre in y'",
            Self::PlatformTurn => "theta's zero",
            Self::Scale => "scale",
            Self::PlateShear => "shear of the plate",
            Self::PlateAspect => "aspect ratio of the plate",
        })
    }
}

/// What an instrument cannot tell.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Freedoms {
    /// How many directions of the machine's numbers there are.
    pub count: usize,
    /// Those that have a name.
    pub named: Vec<Freedom>,
}

impl Freedoms {
    /// Directions that are neither named nor the user's: errors of the machine that stay unknown.
    #[must_use]
    pub fn unnamed(&self) -> usize {
        self.count.saturating_sub(self.named.len())
    }

    /// Of rows in which the unknowns have these sizes.
    #[must_use]
    pub fn new(instrument: &Instrument, rows: &[Rows], sizes: &[f64]) -> Self {
        let mut problem = Problem::without_priors(sizes.len());
        for rows in rows {
            for &row in rows.seen {
                rows.for_columns(sizes, |column, values| {
                    problem.set(column, values[row]);
                });
                problem.end_row(0.0);
            }
        }
        let svd = problem.factor().root.svd(false, true);
        let largest = svd.singular_values.max();
        let Some(directions) = svd.v_t else {
            return Self {
                count: 0,
                named: Vec::new(),
            };
        };
        let null: Vec<usize> = (0..sizes.len())
            .filter(|&k| svd.singular_values[k] < ZERO * largest)
            .collect();
        let null = directions.select_rows(&null).transpose();
        // What only the instrument has, as a place of a target that is not looked at, is no freedom of the machine.
        let count = null.rows(0, MACHINE_NUMBERS).into_owned().rank(PRESENT);
        let named = (ALL.into_iter())
            .filter(|&freedom| is_among(&null, &signature(freedom, instrument), sizes))
            .collect();
        Self { count, named }
    }
}

/// Some unknowns, and how they go together in a freedom: whatever the others do.
fn signature(freedom: Freedom, instrument: &Instrument) -> Vec<(usize, f64)> {
    let of_pivots = |number: usize, values: [f64; 3]| {
        (values.iter().enumerate())
            .map(|(pivot, &value)| (pivot * COEFFICIENTS + number, value))
            .collect::<Vec<_>>()
    };
    let of_marks = |deform: fn([f64; 2]) -> [f64; 2]| {
        let marks = instrument.marks.iter().enumerate();
        marks
            .flat_map(|(mark, &place)| {
                let at = MACHINE_NUMBERS + instrument.mark_at(mark);
                let [x, y] = deform(place);
                [(at, x), (at + 1, y)]
            })
            .collect()
    };
    match freedom {
        Freedom::BaseX => of_pivots(2, [1.0; 3]),
        Freedom::BaseY => of_pivots(3, [1.0; 3]),
        Freedom::BaseTurn => of_pivots(0, [1.0; 3]),
        Freedom::PlatformX => of_pivots(5, GUIDES_RAD.map(f64::sin)),
        Freedom::PlatformY => of_pivots(5, GUIDES_RAD.map(f64::cos)),
        Freedom::PlatformTurn => of_pivots(4, [1.0; 3]),
        Freedom::Scale => of_pivots(1, [1.0; 3]),
        Freedom::PlateShear => of_marks(|[x, y]| [y, x]),
        Freedom::PlateAspect => of_marks(|[x, y]| [x, -y]),
    }
}

/// Whether some null direction has these unknowns, counted in their sizes, go together so.
fn is_among(null: &DMatrix<f64>, signature: &[(usize, f64)], sizes: &[f64]) -> bool {
    if signature.is_empty() || null.ncols() == 0 {
        return false;
    }
    let places: Vec<usize> = signature.iter().map(|&(place, _)| place).collect();
    let wanted = signature.iter().map(|&(place, value)| value / sizes[place]);
    let wanted = DVector::from_iterator(places.len(), wanted).normalize();
    let parts = null.select_rows(&places);
    match parts.clone().svd(true, true).solve(&wanted, PRESENT) {
        Ok(shares) => (parts * shares - &wanted).norm() < NAMED,
        Err(_) => false,
    }
}

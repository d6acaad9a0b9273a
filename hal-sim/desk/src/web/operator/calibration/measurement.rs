//! What was measured so far.

use calibration::plan::Stop;
use calibration::table::Table;
use calibration::{Instrument, Plan};
use kinematics::Geometry;

use crate::calibrate::{Fitted, FittedError, Measured, Way, rows, with_references};

/// Visits before what they say is looked at for the first time; then after a tenth more.
const FIRST_LOOK: usize = 12;
const NEXT_LOOK: f64 = 1.1;

/// See the module.
pub(super) struct Measurement {
    pub instrument: Instrument,
    /// Of the controller that was measured.
    pub serial: String,
    pub stops: Vec<Stop>,
    /// As it is kept.
    pub text: String,
    pub visits: usize,
    /// Visits at which what they say is looked at next.
    look_at: usize,
}

impl Measurement {
    /// Nothing of it so far.
    pub fn new(instrument: Instrument, plan: &Plan, serial: String) -> Self {
        let begun = format!(
            "# tripivot, from its page: machine {serial}, {}",
            instrument.kit
        );
        Self {
            serial,
            stops: with_references(&plan.stops),
            text: rows::head(&begun, &instrument),
            visits: 0,
            look_at: FIRST_LOOK,
            instrument,
        }
    }

    /// It begins, or goes on.
    pub fn begin(&mut self) {
        self.text += &rows::from(self.visits);
    }

    /// Another visit. Whether it is time to look at what they say.
    pub fn keep(&mut self, measured: &Measured) -> bool {
        self.text += &rows::row(&self.instrument, &self.stops, measured);
        self.visits += 1;
        let looks = self.visits >= self.look_at && !self.is_whole();
        if looks {
            self.look_at = (self.visits as f64 * NEXT_LOOK).ceil() as usize;
        }
        looks
    }

    /// Whether all of it is there.
    pub const fn is_whole(&self) -> bool {
        self.visits == self.stops.len()
    }

    /// Where to go on.
    pub fn way<'a>(&self, stops: &'a [Stop], ends: &'a [(usize, f64)]) -> Way<'a> {
        Way {
            stops,
            first: self.visits,
            radius_mm: Geometry::REFERENCE.radius_mm,
            ends,
            is_from_both_sides: false,
        }
    }

    /// The visits.
    pub fn table(&self) -> Result<Table, String> {
        Table::from_text(&self.text, Geometry::REFERENCE.radius_mm)
            .map_err(|error| error.to_string())
    }

    /// Their fit.
    pub fn fitted(&self, table: &Table, temperature_c: Option<f64>) -> Result<Fitted, FittedError> {
        let instrument = table.instrument(self.instrument.noise);
        Fitted::new(table, &instrument, &self.serial, temperature_c)
    }
}

//! What comes of the cases of a set: durations over rsruckig's, and what is no duration.

use crate::case::Case;
use crate::check::Walked;

#[derive(Default)]
pub struct Tally {
    pub cases: u64,
    /// For which rsruckig finds nothing; they have no ratio.
    pub reference_none: u64,
    /// Targets that ours refuses; they have no ratio.
    pub refused: u64,
    /// That come to rest before they set out for the target.
    pub stops_first: u64,
    /// What comes of walking the plans, if that is asked for.
    pub walked: Option<Walked>,
    /// Durations over rsruckig's, and of which case.
    ratios: Vec<(f64, u64)>,
}

impl Tally {
    pub fn new(is_checked: bool) -> Self {
        Self {
            walked: is_checked.then(Walked::default),
            ..Self::default()
        }
    }

    /// Takes case `number`.
    pub fn take(&mut self, number: u64, case: &Case) {
        self.cases += 1;
        let reference = case.reference_ticks();
        self.reference_none += u64::from(reference.is_none());
        let Ok(way) = case.retargeted() else {
            self.refused += 1;
            return;
        };
        assert!(way.leads_to(&case.to), "case {number} ends elsewhere");
        self.stops_first += u64::from(way.rests_before());
        if let Some(walked) = &mut self.walked {
            walked.take(&way, &case.constraints);
        }
        if let Some(reference) = reference {
            let ratio = way.ticks(case.at) as f64 / reference;
            self.ratios.push((ratio, number));
        }
    }

    /// Puts the ratios in order.
    pub fn sort(&mut self) {
        self.ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    }

    /// The ratio that a part of the cases do not exceed, and the number of the case; none of no cases.
    pub fn at(&self, part: f64) -> (f64, u64) {
        let last = self.ratios.len().saturating_sub(1);
        let place = (last as f64 * part) as usize;
        self.ratios.get(place).copied().unwrap_or((f64::NAN, 0))
    }
}

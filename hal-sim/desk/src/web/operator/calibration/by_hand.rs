//! An instrument that whoever looks at a page reads.

use std::sync::Arc;

use calibration::{Instrument, Seen};

use super::super::runs::Control;
use super::status::{Asks, Told};
use crate::calibrate::{Reader, Wanted, fields, question, reading};

/// See the module.
pub(super) struct ByHand {
    pub instrument: Instrument,
    pub control: Arc<Control>,
    pub told: Arc<Told>,
}

impl ByHand {
    fn asks(&self, wanted: &Wanted, wrong: String) {
        let numbers = question(&self.instrument, wanted);
        let words: Vec<String> = (numbers.split_whitespace())
            .zip(WORDS)
            .map(|(number, word)| match number.parse::<f64>() {
                Ok(number) => format!("{word} {number:.4}"),
                Err(_) => format!("{word} {number}"),
            })
            .collect();
        let asks = Asks {
            visit: wanted.visit + 1,
            where_to: words.join(", "),
            fields: fields(self.instrument.kit),
            wrong,
        };
        self.told.change(|status| status.asks = Some(asks));
    }
}

/// What a question's numbers are.
const WORDS: [&str; 7] = [
    "x (mm)",
    "y (mm)",
    "theta (deg)",
    "mark x (mm)",
    "mark y (mm)",
    "camera x (mm)",
    "camera y (mm)",
];

impl Reader for ByHand {
    fn read(&mut self, wanted: &Wanted) -> Result<Seen, String> {
        let mut wrong = String::new();
        let read = loop {
            self.asks(wanted, wrong);
            let Some(text) = self.control.reading() else {
                // Which is known hereby: what follows brings the stage to rest.
                let by = self.control.ended().unwrap_or_default();
                break Err(format!("ended by {by}"));
            };
            if let Some(seen) = reading(&self.instrument, wanted.at, &text) {
                break Ok(seen);
            }
            wrong = format!("'{text}' is no reading of this instrument");
        };
        self.told.change(|status| status.asks = None);
        read
    }
}

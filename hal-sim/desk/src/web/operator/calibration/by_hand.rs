//! An instrument that whoever looks at a page reads.

use std::sync::Arc;

use calibration::{Instrument, Kit, Seen};

use super::super::runs::{Control, Told};
use super::status::{Asks, Status};
use crate::calibrate::{Reader, Wanted, fields, question, reading};

/// See the module.
pub(super) struct ByHand {
    pub instrument: Instrument,
    pub control: Arc<Control>,
    pub told: Arc<Told<Status>>,
}

impl ByHand {
    fn asks(&self, wanted: &Wanted, wrong: String) {
        let numbers = question(&self.instrument, wanted);
        let words: Vec<String> = (numbers.split_whitespace())
            .zip(words(self.instrument.kit))
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
const fn words(kit: Kit) -> [&'static str; 7] {
    let [mark_x, mark_y, camera_x, camera_y] = match kit {
        Kit::Balls => [
            "ball x (mm)",
            "ball y (mm)",
            "gauges x (mm)",
            "gauges y (mm)",
        ],
        _ => [
            "mark x (mm)",
            "mark y (mm)",
            "camera x (mm)",
            "camera y (mm)",
        ],
    };
    [
        "x (mm)",
        "y (mm)",
        "theta (deg)",
        mark_x,
        mark_y,
        camera_x,
        camera_y,
    ]
}

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

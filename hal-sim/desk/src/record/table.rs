//! A record of a controller's data recorder, as a table and as a picture.

use std::fs::File;
use std::path::Path;

use csv::Writer;

use drawing::chart::{Chart, Series, TimeAxis, draw_time_labels};
use drawing::envelope::Envelope;
use drawing::scale::{Scale, Steps, Ticks};
use drawing::svg::{Anchor, Font, Rect, Svg};
use drawing::{ReportError, colour, make_folder, unwritable, write_file, write_png};

const WIDTH: f64 = 1200.0;
const LEFT: f64 = 110.0;
const TOP: f64 = 110.0;
const CHART_HEIGHT: f64 = 130.0;
const PITCH: f64 = 175.0;
/// Columns that a record can have.
const COLUMNS: usize = 8;
/// One after the other.
const COLOURS: [&str; 4] = [
    colour::PIVOTS[0],
    colour::PIVOTS[1],
    colour::PIVOTS[2],
    colour::CENTRE,
];

/// What a recorder has recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// What each column is, with its unit.
    pub names: Vec<String>,
    /// Seconds from row to row.
    pub period_s: f64,
    /// Time of each row since the trigger, s.
    pub times_s: Vec<f64>,
    /// The values.
    pub rows: Vec<Vec<f64>>,
}

impl Record {
    /// Writes `record.csv`, `record.svg` and `record.png` into `folder`, which is made if it is not there.
    ///
    /// # Errors
    /// [`ReportError`] names the file that could not be written.
    pub fn write(&self, heading: &str, folder: &Path) -> Result<(), ReportError> {
        make_folder(folder)?;
        self.write_table(&folder.join("record.csv"))?;
        let picture = self.picture(heading);
        write_file(&folder.join("record.svg"), picture.as_bytes())?;
        write_png(&folder.join("record.png"), &picture)
    }

    fn write_table(&self, path: &Path) -> Result<(), ReportError> {
        let file = File::create(path).map_err(unwritable(path))?;
        let mut writer = Writer::from_writer(file);
        let failed = |error: csv::Error| unwritable(path)(error.into());
        let names = self.names.iter().map(String::as_str);
        let head = std::iter::once("time since trigger, s").chain(names);
        writer.write_record(head).map_err(failed)?;
        for (time_s, row) in self.times_s.iter().zip(&self.rows) {
            let cells = std::iter::once(time_s).chain(row);
            // As many digits as tell the number from its neighbours.
            let cells = cells.map(|value| format!("{}", value + 0.0));
            writer.write_record(cells).map_err(failed)?;
        }
        writer.flush().map_err(unwritable(path))
    }

    /// A chart for each column, as an SVG document.
    pub fn picture(&self, heading: &str) -> String {
        let charts = self.names.len();
        let mut svg = Svg::new(WIDTH, TOP + PITCH * charts as f64 + 30.0);
        let title = Font::new(26.0, colour::INK, Anchor::Start).bold();
        svg.text([30.0, 48.0], heading, &title);
        let envelope = self.envelope();
        let time = self.time_axis();
        let mut last = None;
        for (column, name) in self.names.iter().enumerate() {
            let frame = Rect {
                left: LEFT,
                top: TOP + PITCH * column as f64,
                width: WIDTH - LEFT - 30.0,
                height: CHART_HEIGHT,
            };
            let chart = Chart {
                title: name,
                note: String::new(),
                bins: envelope.bins(),
                factor: 1.0,
                series: &[Series {
                    name: "",
                    colour: COLOURS[column % COLOURS.len()],
                    channel: column,
                }],
                steps: Steps::Decimal,
                from_zero: false,
                marks: &[],
            };
            chart.draw(&mut svg, &frame, &time);
            last = Some(frame);
        }
        if let Some(frame) = last {
            draw_time_labels(&mut svg, &frame, &time);
        }
        svg.finish()
    }

    fn envelope(&self) -> Envelope<COLUMNS> {
        let mut envelope = Envelope::default();
        for (time_s, row) in self.times_s.iter().zip(&self.rows) {
            let value = |column| row.get(column).copied().unwrap_or(0.0);
            envelope.add(*time_s, &std::array::from_fn(value));
        }
        envelope
    }

    fn time_axis(&self) -> TimeAxis {
        let start_s = self.times_s.first().copied().unwrap_or(0.0);
        let end_s = self.times_s.last().copied().unwrap_or(0.0);
        let end_s = end_s.max(start_s + 1e-6);
        let mut ticks = Ticks::covering((start_s, end_s), 10.0, Steps::Decimal);
        let slack_s = 1e-3 * (end_s - start_s);
        (ticks.values).retain(|tick| (start_s - slack_s..=end_s + slack_s).contains(tick));
        TimeAxis {
            scale: Scale::new((start_s, end_s), (LEFT, WIDTH - 30.0)),
            ticks,
            moving: Vec::new(),
        }
    }
}

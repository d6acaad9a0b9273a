//! `tripivot record`: sets up the data recorder of a controller that runs, waits for its record and fetches it.
//!
//! | file | idea |
//! |---|---|
//! | here | what is asked for, and the steps |
//! | `desk` | the controller's end: questions, refusals, waiting |
//! | `answer` | the answer of `DRR?` |
//! | `table` | the record, as a table and as a picture |

pub(crate) mod answer;
pub(crate) mod desk;
mod table;

use std::fmt;
use std::io;
use std::time::Duration;

use crate::line::Endpoint;
pub(crate) use desk::Desk;
use drawing::Progress;
pub use table::Record;

/// Tables of a controller's recorder.
pub const TABLES: usize = 8;
/// Option whose values are the time since the trigger.
const TIME: &str = "0 8";
/// Rows that are fetched at a time.
const ROWS: usize = 256;
/// Numbers of the parameters.
const POINTS: &str = "0x16000201";
const BEFORE: &str = "0x54500900";
const PERIOD: &str = "0xE000200";

/// What begins the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trigger {
    /// At once.
    Now,
    /// The next command that moves.
    Move,
    /// A fault.
    Fault,
    /// The signal of a table, counted from 1, crosses a value.
    Crosses {
        /// Which.
        table: usize,
        /// In the signal's unit.
        value: f64,
        /// From below to at or above it, or the other way.
        rising: bool,
    },
}

/// What is to be recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// Where the controller is.
    pub endpoint: Endpoint,
    /// Source and option of each table, as `DRC` takes them: `X 1`.
    pub tables: Vec<String>,
    /// Ticks from row to row.
    pub every: u32,
    /// Rows; as the controller has it when nothing is said.
    pub points: Option<u32>,
    /// Rows from before the trigger.
    pub before: u32,
    /// What begins it.
    pub trigger: Trigger,
    /// A line to be sent once the recorder is armed.
    pub send: Option<String>,
    /// How long the record may take.
    pub patience: Duration,
    /// No progress bar.
    pub quiet: bool,
}

/// Why there is no record.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// There is nobody.
    #[error(
        "no controller at {place}: {error} (`tripivot serve` runs a simulated one at 127.0.0.1:50000)"
    )]
    Unreachable {
        /// Where.
        place: String,
        /// What the system says.
        error: io::Error,
    },
    /// The connection broke down.
    #[error("the connection to {place} broke down: {error}")]
    Broken {
        /// Where.
        place: String,
        /// What the system says.
        error: io::Error,
    },
    /// Somebody has ended it.
    #[error("ended by {0}")]
    Ended(String),
    /// The controller refuses a line.
    #[error("the controller refused `{line}` with GCS error {code}{hint}")]
    Refused {
        /// The line.
        line: String,
        /// The error.
        code: u16,
        /// What may help.
        hint: &'static str,
    },
    /// What it answers is not what was asked.
    #[error("the controller's answer to `{line}` is not understood: {answer:?}")]
    Strange {
        /// The line.
        line: String,
        /// Its beginning.
        answer: String,
    },
    /// The trigger has not come.
    #[error("nothing has triggered the record within {0:?}; it is disarmed again")]
    NoTrigger(Duration),
    /// It takes longer than it may.
    #[error("only {rows} of {points} points were recorded within {patience:?}")]
    Slow {
        /// Recorded.
        rows: usize,
        /// Wanted.
        points: usize,
        /// The time it had.
        patience: Duration,
    },
    /// Places are not those of the base frame.
    #[error(
        "the frame {frame} is in force, and places would be others than those that are meant: `KEN ZERO` puts the base frame in force"
    )]
    OtherFrame {
        /// Its name.
        frame: String,
    },
    /// Places are not those of the platform's own centre.
    #[error(
        "the centre of rotation is at R {r_mm} S {s_mm} mm of the platform, and places would be others than those that are meant: `SPI R 0 S 0` makes it the \
         platform's own"
    )]
    OtherCentre {
        /// Along the platform's x.
        r_mm: f64,
        /// Along its y.
        s_mm: f64,
    },
    /// It has ended, and what the controller keeps is not in force again.
    #[error("{error}; and what is kept is not in force again: {refused}")]
    NotAsBefore {
        /// Why it has ended.
        error: Box<Self>,
        /// What was refused of bringing that back.
        refused: Box<Self>,
    },
}

impl RecordError {
    /// Whether the controller was there and understood, and it went wrong all the same.
    #[must_use]
    pub const fn is_failure(&self) -> bool {
        !matches!(self, Self::Unreachable { .. })
    }
}

impl fmt::Display for Trigger {
    /// As `DRT` takes it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Now => f.write_str("0 4 0"),
            Self::Move => f.write_str("0 2 0"),
            Self::Fault => f.write_str("0 102 0"),
            Self::Crosses {
                table,
                value,
                rising,
            } => write!(f, "{table} {} {value}", if *rising { 100 } else { 101 }),
        }
    }
}

/// Makes the record.
///
/// # Errors
/// [`RecordError`]. The recorder is disarmed when the line to be sent is refused or the trigger does not come.
pub fn record(order: &Order) -> Result<Record, RecordError> {
    let mut desk = Desk::open(&order.endpoint)?;
    let points = set_up(&mut desk, order)?;
    desk.carry_out("DRT 0 0 0")?;
    desk.carry_out(&format!("DRT {}", order.trigger))?;
    if let Some(line) = &order.send {
        // The rows before the trigger have to come first.
        let period_s = desk.parameter(PERIOD)?;
        desk.delay(f64::from(order.before) * f64::from(order.every) * period_s)?;
        if let Err(error) = desk.carry_out(line) {
            let _ = desk.carry_out("DRT 0 0 0");
            return Err(error);
        }
    }
    let progress = Progress::new(2 * points as u64, order.quiet);
    let waited = desk.wait(points, order.patience, |rows| {
        progress.tell(rows as u64, "recording");
    });
    if let Err(error) = waited {
        let _ = desk.carry_out("DRT 0 0 0");
        return Err(error);
    }
    let mut record = Record::default();
    while record.rows.len() < points {
        let done = record.rows.len();
        let rows = ROWS.min(points - done);
        desk.fetch(done + 1, rows, &mut record)?;
        progress.tell((points + record.rows.len()) as u64, "fetching");
    }
    progress.finish();
    set_times(&mut record, order);
    Ok(record)
}

/// Tells the recorder what to record; the points it will have.
fn set_up(desk: &mut Desk, order: &Order) -> Result<usize, RecordError> {
    for table in 0..TABLES {
        // The last column is the time, which costs nothing, where a table is left for it.
        let wanted = match order.tables.get(table) {
            Some(wanted) => wanted,
            None if table == order.tables.len() => TIME,
            None => "0 0",
        };
        desk.carry_out(&format!("DRC {} {wanted}", table + 1))?;
    }
    desk.carry_out(&format!("RTR {}", order.every))?;
    let points = match order.points {
        Some(points) => f64::from(points),
        None => desk.parameter(POINTS)?,
    };
    desk.carry_out(&format!(
        "SPA 1 {POINTS} {points} 1 {BEFORE} {}",
        order.before
    ))?;
    Ok(points as usize)
}

/// Takes the times out of the last column, or works them out.
fn set_times(record: &mut Record, order: &Order) {
    let told = order.tables.len() < TABLES;
    for (at, row) in record.rows.iter_mut().enumerate() {
        let counted = (at as f64 - f64::from(order.before)) * record.period_s;
        let time_s = if told { row.pop() } else { None };
        record.times_s.push(time_s.unwrap_or(counted));
    }
    if told {
        record.names.pop();
    }
}

//! Options of what talks to a controller that runs already.

use super::super::number::{whole, within};
use clap::{Args, Subcommand};
use desk::record::Trigger;
use std::path::PathBuf;

/// Where a controller is that runs already.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Controller {
    /// Host and port that the controller is at.
    #[arg(
        long,
        value_name = "ADDRESS",
        default_value = "127.0.0.1:50000",
        conflicts_with = "port"
    )]
    pub(in super::super) connect: String,
    /// The serial line that the controller is at (/dev/ttyUSB0, COM3), or a pseudo-terminal.
    #[arg(long, value_name = "DEVICE")]
    pub(in super::super) port: Option<PathBuf>,
    /// Bits a second on the serial line. On macOS a pseudo-terminal takes 0 only, which leaves its rate alone.
    #[arg(long, value_name = "N", default_value_t = 921_600, allow_negative_numbers = true, value_parser = whole(1..=u32::MAX))]
    pub(in super::super) baud: u32,
}

/// A page for a controller that runs already.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct View {
    #[command(flatten)]
    pub(in super::super) controller: Controller,
    /// Address and port of the page [default: 127.0.0.1:8080, or a free port if that is taken].
    #[arg(long, value_name = "ADDRESS")]
    pub(in super::super) web: Option<String>,
    /// Command that reads the instrument for a calibration from the page, as for `tripivot calibrate measure` [default: whoever looks at the page
    /// is asked].
    #[arg(long, value_name = "COMMAND")]
    pub(in super::super) reader: Option<String>,
    #[command(flatten)]
    pub(in super::super) access: Access,
}

/// Who reaches what is served.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct Access {
    /// Listen at addresses that other machines reach. The command language knows no password; the page asks for one.
    #[arg(long)]
    pub(in super::super) allow_remote: bool,
    /// File whose first line is the page's password [default: one is made and printed where the page is not for this machine
    /// alone].
    #[arg(long, value_name = "FILE")]
    pub(in super::super) password_file: Option<PathBuf>,
    /// Where browsers find the page, such as https://stage.example.org, if a proxy stands in front of it.
    #[arg(long, value_name = "URL")]
    pub(in super::super) public_url: Option<String>,
}

/// A record of a controller that runs already.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct RecordRun {
    #[command(flatten)]
    pub(in super::super) controller: Controller,
    /// What to record, up to eight: source (X, Y, W; 1 to 3 for a pivot; 0 for the controller) and option, as HDR? lists them.
    #[arg(long, value_name = "SOURCE:OPTION", value_delimiter = ',', default_value = "X:1,X:3,Y:1,Y:3,W:1,W:3,1:73", value_parser = recorded)]
    pub(in super::super) tables: Vec<String>,
    /// Ticks from point to point.
    #[arg(long, value_name = "N", default_value_t = 1, allow_negative_numbers = true, value_parser = whole(1..=65_536_u32))]
    pub(in super::super) every: u32,
    /// Points of the record [default: as the controller has it].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(1..=u32::MAX))]
    pub(in super::super) points: Option<u32>,
    /// How many of them are from before the trigger.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = whole(0..=u32::MAX))]
    pub(in super::super) before: u32,
    /// What begins it: now, move, fault, rises:TABLE:VALUE or falls:TABLE:VALUE [default: move with --send, now without].
    #[arg(long, value_name = "TRIGGER", value_parser = trigger)]
    pub(in super::super) trigger: Option<Trigger>,
    /// A line to send once the recorder is armed, such as "MOV X 10".
    #[arg(long, value_name = "LINE")]
    pub(in super::super) send: Option<String>,
    /// Seconds that the record may take.
    #[arg(long, value_name = "S", default_value_t = 60.0, allow_negative_numbers = true, value_parser = within(0.0..=LONGEST_S))]
    pub(in super::super) patience: f64,
    /// Folder for table and picture.
    #[arg(long, value_name = "DIR", default_value = "tripivot-record")]
    pub(in super::super) out: PathBuf,
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: controller; sent (null if nothing was); points; period_us; signals (name with its unit, lowest, highest); folder.
    #[arg(long)]
    pub(in super::super) json: bool,
    /// No progress bar.
    #[arg(long, short)]
    pub(in super::super) quiet: bool,
}

/// The tests of a board.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct BoardRun {
    #[command(flatten)]
    pub(in super::super) controller: Controller,
    /// List the tests and what is expected of each; no controller is needed.
    #[arg(long)]
    pub(in super::super) list: bool,
    /// Run the tests that move the stage too, by 10 mm at most: the machine is commissioned, and nobody is near.
    #[arg(long = "move")]
    pub(in super::super) moves: bool,
    /// The controller runs on an emulated chip, whose seconds are not those of this machine.
    #[arg(long)]
    pub(in super::super) emulated: bool,
    /// Write what was found into this file, as a page to be kept with the board.
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    pub(in super::super) out: Option<PathBuf>,
}

/// What to do with settings.
#[derive(Subcommand, Clone, Debug)]
pub(in super::super) enum SettingsCommand {
    /// Write all parameters that can be set, and all macros, into a file.
    Export(SettingsFile),
    /// Set the parameters of a file, record its macros, and have both kept. All must be at rest; some need the servo off.
    Import(SettingsFile),
}

/// A file of settings, and the controller.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct SettingsFile {
    /// The file.
    pub(in super::super) file: PathBuf,
    #[command(flatten)]
    pub(in super::super) controller: Controller,
}

/// Source and option as the controller takes them.
fn recorded(text: &str) -> Result<String, String> {
    match text.split_once(':') {
        Some((source, option)) if !source.is_empty() && option.parse::<u16>().is_ok() => {
            Ok(format!("{source} {option}"))
        }
        _ => Err("not a source and an option's number, such as X:1".to_owned()),
    }
}

fn trigger(text: &str) -> Result<Trigger, String> {
    let expected = || "not now, move, fault, rises:TABLE:VALUE or falls:TABLE:VALUE".to_owned();
    let words: Vec<&str> = text.split(':').collect();
    match words[..] {
        ["now"] => Ok(Trigger::Now),
        ["move"] => Ok(Trigger::Move),
        ["fault"] => Ok(Trigger::Fault),
        [way @ ("rises" | "falls"), table, value] => Ok(Trigger::Crosses {
            table: table.parse().map_err(|_| expected())?,
            value: value.parse().map_err(|_| expected())?,
            rising: way == "rises",
        }),
        _ => Err(expected()),
    }
}

/// A day.
const LONGEST_S: f64 = 86_400.0;

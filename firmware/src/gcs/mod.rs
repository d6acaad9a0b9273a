//! The language: the General Command Set.
//!
//! It runs at low priority, outside the tick, and meets it only through the queues of [`crate::queues`]. An
//! [`Interpreter`] is what all connections share, a [`Session`] is one of them. Bytes go into the session,
//! [`Interpreter::service`] handles them and writes the replies:
//!
//! ```text
//! bytes -> Session::receive -> line or single byte -> parse -> Request -> Commander -> Command -> tick
//!                                                        \-> reply <- Commander <- Snapshot <----/
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `interpreter` | what all connections share |
//! | `session` | input, line, error and wait of a connection |
//! | `service` | what a connection has sent: taken, understood, carried out, answered |
//! | `connection_number`, `connections` | what a connection is known by; who commanded last, what ends with one |
//! | `waits` | what holds up the lines of a connection |
//! | `table` | what commands there are; parsing, `HLP?` and dispatch read it |
//! | `syntax` | what an entry of the table is |
//! | `parse` | from a line to a [`Request`], or what is wrong with it and where |
//! | `scan`, `arguments` | words of a line, and what commands take |
//! | `request` | what a line asks for |
//! | `execute` | what changes something |
//! | `replies` | what is answered |
//! | `output`, `reply_writer` | where replies go, and their form |
//! | `error` | error numbers, and the table from the commander's errors to them |
//! | `text` | names and short texts |
//! | `learnt` | what the servos have learnt, told and kept |
//! | `streaming` | the time between streamed targets |
//!
//! | folder | commands |
//! |---|---|
//! | `frames`, `wave` | coordinate systems and the centre of rotation; waveforms |
//! | `parameter`, `persistence` | parameters; what is stored over a restart |
//! | `calibration` | `CAL`: what a built machine is off the drawing |
//! | `excitation` | `EXC`: a known voltage on a motor |
//! | `iterative_learning` | `ILC`: moves that are repeated |
//! | `macros`, `variables` | lines that are stored and carried out later; values in lines |
//! | `recorder` | the data recorder: what it records, when, and reading it |
//! | `monitor` | `MON?`, for clients that draw the stage while it moves |
//! | `self_test` | what the board reads about itself |
//! | `events`, `statistics`, `heartbeat` | what has happened, how the loop does, whether the host is there |
//! | `condition` | whether motors and current sensors are still what the parameters say |
//! | `jog`, `ownership` | whose constant velocities are in force; who alone may command |
//! | `recovery` | the way back of a stage that was found out of its reach |
//!
//! Each folder has, as far as there is something to say: `state`, `request`, `parse`, `execute`, `replies`.
//!
//! Lines are handled in order. While a command is on its way to the tick (one tick) lines that depend on it stay where
//! they are; while `DEL`, `WAC` or `FRF` waits all lines do, and single bytes act ahead of them. A stop (`STP`, `#24`)
//! from any connection ends those waits on all of them, with error 10, and throws away the lines behind them but for
//! questions, which are answered: a script does not go on after a stop, and a client gets its answers.

mod arguments;
mod calibration;
mod condition;
mod connection_number;
mod connections;
mod error;
mod events;
mod excitation;
mod execute;
mod frames;
mod heartbeat;
mod interpreter;
mod iterative_learning;
mod jog;
mod learnt;
mod macros;
mod monitor;
mod output;
mod ownership;
mod parameter;
mod parse;
mod persistence;
mod recorder;
mod recovery;
mod replies;
mod reply_writer;
mod request;
mod scan;
mod self_test;
mod service;
mod session;
mod statistics;
mod streaming;
mod syntax;
mod table;
mod text;
mod variables;
mod waits;
mod wave;

pub use arguments::ParseError;
pub use error::ErrorCode;
pub use events::{BoardNotice, CRASH_FILE_BYTES, Crash, CrashCause, START_CAUSES};
pub use frames::{FrameQuery, ListItem};
pub use interpreter::{Identity, Interpreter};
pub use macros::{LINES_PER_TICK, MACRO_BYTES, MAX_CALL_DEPTH, MAX_MACROS, MacroRequest};
pub use parameter::{
    Address, Addresses, Item, Kind, MAX_ADDRESSES, PARAMETERS, Parameter, Settings, When,
};
pub use parse::parse;
pub use persistence::{Contents, STORED_BYTES};
pub use recorder::{Channel, RecordAction, RecordQuery, SignalSource, TableList, Trigger};
pub use request::{Action, Condition, Operand, Operator, Property, Query, Request};
pub use session::Session;
pub use text::{FixedText, LINE_BYTES, NAME_BYTES, Name, TEXT_BYTES, Text};
pub use variables::{MAX_NAMED_VARIABLES, MAX_VARIABLES, VariableRequest};
pub use wave::WaveQuery;

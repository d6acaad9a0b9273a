//! What all connections share.

use super::calibration::GatheredCalibration;
use super::condition::DriveWatches;
use super::connections::Connections;
use super::error::ErrorCode;
use super::events::{BoardNotice, Crash, Event, EventLog};
use super::heartbeat::Heartbeat;
use super::jog::Jogs;
use super::learnt::ServoReports;
use super::macros::Macros;
use super::ownership::Ownership;
use super::persistence::Persistence;
use super::recorder::RecorderState;
use super::recovery::RecoveryOwner;
use super::statistics::Statistics;
use super::variables::Variables;
use crate::commander::{Commander, Lamps};
use crate::motion::Limits;
use crate::parameters::Parameters;
use crate::self_test::Board;

/// Who answers `*IDN?`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Serial number.
    pub serial: &'static str,
    /// Version of the firmware.
    pub version: &'static str,
}

/// What all connections share.
pub struct Interpreter {
    pub(super) identity: Identity,
    pub(super) parameters: Parameters,
    /// Those before they were set last, in case the tick refuses.
    pub(super) previous_parameters: Parameters,
    /// Limits of motion that the stage was set up for, and those that level 1 has set over them.
    pub(super) rated_limits: Limits,
    pub(super) commander: Commander,
    /// Thresholds of supervision that are looser than the reference, as was told last.
    pub(super) loosened: u16,
    /// Why the controller started, if that is worth telling.
    pub(super) start_cause: Option<&'static str>,
    /// Times everything was stopped.
    pub(super) stops: u32,
    pub(super) recorder_state: RecorderState,
    pub(super) events: EventLog,
    pub(super) statistics: Statistics,
    pub(super) servo_reports: ServoReports,
    pub(super) drive_watches: DriveWatches,
    pub(super) heartbeat: Heartbeat,
    pub(super) connections: Connections,
    pub(super) jogs: Jogs,
    pub(super) ownership: Ownership,
    pub(super) recovery_owner: RecoveryOwner,
    pub(super) gathered_calibration: Option<GatheredCalibration>,
    /// The machine is told to be further from the temperature of its calibration than that holds for.
    pub(super) is_off_calibrated_temperature: bool,
    pub(super) wants_restart: bool,
    /// What `TST?` asks, where there is one.
    pub(super) board: Option<&'static dyn Board>,
    pub(super) macros: Macros,
    /// Those of macros.
    pub(super) variables: Variables,
    pub(super) persistence: Persistence,
    /// Errors for every connection: how many so far, and the latest.
    pub(super) reported: (u32, ErrorCode),
}

impl Interpreter {
    /// For a stage of these parameters.
    pub fn new(parameters: &Parameters, identity: Identity) -> Self {
        Self {
            identity,
            parameters: parameters.clone(),
            previous_parameters: parameters.clone(),
            rated_limits: parameters.limits,
            commander: Commander::new(parameters),
            loosened: 0,
            stops: 0,
            recorder_state: RecorderState::new(),
            events: EventLog::new(),
            statistics: Statistics::default(),
            servo_reports: ServoReports::default(),
            drive_watches: DriveWatches::new(parameters),
            heartbeat: Heartbeat::default(),
            connections: Connections::default(),
            jogs: Jogs::default(),
            ownership: Ownership::default(),
            recovery_owner: RecoveryOwner::default(),
            gathered_calibration: None,
            is_off_calibrated_temperature: false,
            wants_restart: false,
            board: None,
            macros: Macros::default(),
            variables: Variables::default(),
            persistence: Persistence::new(parameters),
            reported: (0, ErrorCode::None),
            start_cause: None,
        }
    }

    /// Notes why the controller started (a watchdog reset, say): `FLT?` tells it while there is no fault, and `EVT?`.
    /// The retained memory knows the [`START_CAUSES`](super::START_CAUSES) alone.
    pub fn set_start_cause(&mut self, cause: &'static str) {
        self.start_cause = Some(cause);
        self.events.set_start_cause(cause);
    }

    /// Notes why the controller started, for `EVT?` alone: somebody wanted it to. One of the [`START_CAUSES`](super::START_CAUSES).
    pub fn set_wanted_start(&mut self, cause: &'static str) {
        self.events.set_start_cause(cause);
    }

    /// What the board's lamps show now.
    pub fn lamps(&self) -> Lamps {
        self.commander.lamps()
    }

    /// Notes how the program ended before this start, for `EVT?`. To be called before anything is served.
    pub fn add_crash(&mut self, crash: Crash) {
        self.events.add(0, Event::Crashed(crash));
    }

    /// Notes what the board has found out about itself, for `EVT?`. To be called before anything is served.
    pub fn add_board_notice(&mut self, notice: BoardNotice) {
        self.events.add(0, Event::BoardNotice(notice));
    }

    /// The tick of the latest snapshot taken; 0 before the first.
    pub fn tick(&self) -> u64 {
        self.commander.tick()
    }

    /// Whether `RBT` has been given: the board is to start the controller again.
    pub const fn wants_restart(&self) -> bool {
        self.wants_restart
    }
}

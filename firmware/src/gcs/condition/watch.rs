//! Thresholds, events, lines of `LST?`.

use super::drive::{DriveCondition, DriveWatch, find};
use super::knocks::KnockWatch;
use crate::gcs::events::Event;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::WriteFailed;
use crate::gcs::reply_writer::ReplyWriter;
use crate::mode::Mode;
use crate::parameters::Parameters;
use crate::queues::Snapshot;

/// What of a drive may be no more what its parameters say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(in crate::gcs) enum DriveQuantity {
    /// Motor constant over the parameter's.
    MotorConstant,
    /// What the current sensor reads more than flows, A.
    CurrentOffset,
    /// Friction besides the parameters', at the ring, N m.
    Friction,
}

impl DriveQuantity {
    /// All of them, each in the place of its number.
    pub const ALL: [Self; 3] = [Self::MotorConstant, Self::CurrentOffset, Self::Friction];

    /// What it may be off. Sound machines on another day than that of the telling are found within 5 %, 0.1 A and 0.8 N m of it
    /// (`cargo bench -p tests --bench drive_changes`).
    const fn within(self) -> f32 {
        match self {
            Self::MotorConstant => 0.1,
            Self::CurrentOffset => 0.3,
            Self::Friction => 1.5,
        }
    }

    /// Where it stands, and how far that is from what it should be.
    const fn of(self, found: &DriveCondition) -> (f32, f32) {
        match self {
            Self::MotorConstant => {
                let ratio = found.motor_constant_ratio;
                (ratio, (ratio - 1.0).abs())
            }
            Self::CurrentOffset => (found.current_offset_a, found.current_offset_a.abs()),
            Self::Friction => (found.more_friction_n_m, found.more_friction_n_m),
        }
    }
}

/// The drives, what was found of them last, and what has been told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::gcs) struct DriveWatches {
    rate_hz: f32,
    knocks: KnockWatch,
    drives: [DriveWatch; 3],
    found: [Option<DriveCondition>; 3],
    told: [[Told; DriveQuantity::ALL.len()]; 3],
}

/// What has been told of a quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Told {
    is_off: bool,
    /// The last finding was otherwise.
    was_otherwise: bool,
}

impl Told {
    /// Takes the next finding; whether there is something to tell. One finding is none: it may be from before and after a change. What is
    /// off is so until it has come half of the way back.
    fn take(&mut self, off: f32, within: f32) -> bool {
        let is_off = off > if self.is_off { 0.5 * within } else { within };
        let is_otherwise = is_off != self.is_off;
        let changes = is_otherwise && self.was_otherwise;
        self.was_otherwise = is_otherwise && !changes;
        self.is_off ^= changes;
        changes
    }
}

impl DriveWatches {
    /// For a stage of these parameters: nothing has been seen.
    pub fn new(parameters: &Parameters) -> Self {
        let rate_hz = parameters.limits.rate_hz as f32;
        Self {
            rate_hz,
            knocks: KnockWatch::new(rate_hz),
            ..Self::default()
        }
    }
}

impl Interpreter {
    /// Other parameters from now on: what was seen, and told, is not held against them.
    pub(in crate::gcs) fn restart_drive_watches(&mut self) {
        self.drive_watches = DriveWatches::new(&self.parameters);
    }

    /// Looks at a snapshot: at all pivots for knocks, and at the drive that it tells of.
    pub(in crate::gcs) fn watch_drives(&mut self, snapshot: &Snapshot) {
        let rate_hz = self.drive_watches.rate_hz;
        if let Some(knocks) = self.drive_watches.knocks.look(snapshot, rate_hz) {
            self.events.add(snapshot.tick, Event::Knocks(knocks));
        }
        self.watch_drive(snapshot, rate_hz);
    }

    fn watch_drive(&mut self, snapshot: &Snapshot, rate_hz: f32) {
        let (servo, watches) = (&snapshot.servo, &mut self.drive_watches);
        let pivot = servo.pivot.min(2);
        let watch = &mut watches.drives[pivot];
        if !matches!(snapshot.mode, Mode::Holding | Mode::Moving) {
            // What turns a pivot then is not its motor, or it has not ended its way.
            *watch = DriveWatch::default();
            return;
        }
        let Some(ways) = watch.look(snapshot.tick, snapshot.pivots[pivot], servo, rate_hz) else {
            return;
        };
        let found = find(ways, &self.parameters, pivot);
        watches.found[pivot] = Some(found);
        for quantity in DriveQuantity::ALL {
            let told = &mut watches.told[pivot][quantity as usize];
            let (value, off) = quantity.of(&found);
            if told.take(off, quantity.within()) {
                let event = Event::Drive(pivot as u8, quantity, told.is_off, value);
                self.events.add(snapshot.tick, event);
            }
        }
    }

    /// The lines of `LST?`.
    pub(in crate::gcs) fn reply_conditions(
        &self,
        reply: &mut ReplyWriter<'_>,
    ) -> Result<(), WriteFailed> {
        for (number, found) in (1..).zip(self.drive_watches.found) {
            if let Some(found) = found {
                let DriveCondition {
                    motor_constant_ratio: ratio,
                    current_offset_a: offset_a,
                    more_friction_n_m: friction_n_m,
                } = found;
                reply.line(format_args!(
                    "DRIVE{number}={ratio:.3} {offset_a:.3} {friction_n_m:.3}"
                ))?;
            }
        }
        Ok(())
    }
}

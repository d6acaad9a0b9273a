//! The supervisor: which commands are taken in which state, and what is a fault.
//!
//! | file | idea |
//! |---|---|
//! | here | commands and faults, as the table has them |
//! | `table` | what every event does in every state |
//! | `inputs` | faults that the inputs show |
//! | `setpoint` | faults that the setpoint shows |
//! | `watch` | faults of a single pivot, one pivot a tick |
//!
//! Off coasts, so that a stage can be moved by hand; holding, moving and stopping drive; a fault brakes, or coasts where its
//! [`Reaction`] is that. All faults with their detection, reaction and reason stand in `FAULTS.md`, which is made from
//! [`ABOUT`](crate::fault::FAULT_DESCRIPTIONS).
//!
//! The measured pose is computed when a command needs it, not at every tick: while the servo is on, every pivot is within the
//! largest following error of the setpoint, which bounds the measured pose more tightly than any margin of the mechanics. So
//! the disk and the guides' ranges are judged by the setpoint, and what lies between setpoint and pivots by the following
//! error. Only the angle between two pivots, which is a difference, is measured.

mod input_faults;
mod inspection;
mod pivot_faults;
mod setpoint_faults;
mod transitions;

pub(crate) use inspection::{INSPECTION_PERIOD_TICKS, Inspection, PivotWatch};
pub use transitions::{Event, MODES, Outcome, TRANSITIONS};

use super::state::State;
use crate::control::config::Config;
use crate::control::encoder::Encoder;
use crate::control::referencing;
use crate::fault::{Fault, FaultKind, Reaction};
use crate::mode::Mode;
use crate::motion::Position;
use crate::number::Fixed;
use crate::queues::Command;
use kinematics::{Angle, Pose, direct};
use transitions::outcome;

impl State {
    pub(crate) fn servo_on(&self) -> bool {
        matches!(self.mode, Mode::Holding | Mode::Moving | Mode::Stopping)
    }

    /// Whether the bridges drive or brake.
    pub(crate) fn bridges_awake(&self) -> bool {
        match self.mode {
            Mode::Off => false,
            Mode::Fault => !self.coasts,
            Mode::Holding | Mode::Moving | Mode::Stopping => true,
        }
    }

    pub(crate) fn handle_command(
        &mut self,
        config: &mut Config,
        command: &Command,
        pivots: &[Angle; 3],
    ) {
        let event = event_of(config, command);
        let done = match outcome(self.mode, event) {
            Outcome::Nothing => return,
            Outcome::Refused => false,
            Outcome::To(mode) => {
                self.apply(config, command);
                self.mode = mode;
                true
            }
            Outcome::If(mode) => {
                let done = self.try_apply(command, pivots);
                if done {
                    self.mode = mode;
                }
                done
            }
        };
        if !done {
            self.refused = self.refused.wrapping_add(1);
        }
    }

    /// What can not fail.
    fn apply(&mut self, config: &mut Config, command: &Command) {
        match command {
            Command::Acknowledge => {
                self.fault = None;
                self.stop_ended_by = None;
                self.lost_pivot = None;
            }
            Command::Configure(wanted) => self.configure(config, wanted),
            Command::Centre(centre) => {
                // Servo off in mid-motion leaves the motion as it was: there is nothing under way then.
                if self.mode == Mode::Off {
                    self.motion.rest_at(self.motion.position());
                }
                // At rest, as it is now, it is taken.
                let _ = self.motion.set_centre(*centre);
            }
            // The servo is on already, or goes off, which is all there is to it.
            Command::Reference | Command::Servo(_) | Command::Move(_) => {}
        }
    }

    /// What the stage may not be ready for; nothing has changed then.
    fn try_apply(&mut self, command: &Command, pivots: &[Angle; 3]) -> bool {
        match command {
            Command::Reference if !self.referenced => self.reference(pivots),
            Command::Reference | Command::Servo(_) => self.hold(pivots),
            Command::Move(plan) => {
                let taken = self.motion.accept(plan).is_ok();
                if taken {
                    self.settling.start();
                }
                taken
            }
            Command::Centre(_) | Command::Configure(_) | Command::Acknowledge => false,
        }
    }

    /// Takes theta and the pivots' turns from what single-turn encoders show, and holds.
    fn reference(&mut self, pivots: &[Angle; 3]) -> bool {
        let ready = self
            .encoders
            .iter()
            .all(|encoder| encoder.unusable().is_none());
        let (true, Ok(pose)) = (ready, direct::<Fixed>(pivots)) else {
            return false;
        };
        let (theta, unwrapped) = referencing::within_one_turn(pose.theta, pivots);
        for (encoder, angle) in self.encoders.iter_mut().zip(unwrapped) {
            encoder.unwrap_near(angle);
        }
        self.referenced = true;
        self.hold_at(&Pose { theta, ..pose });
        true
    }

    /// Servo on, at the pose where the stage is.
    fn hold(&mut self, pivots: &[Angle; 3]) -> bool {
        let (true, Ok(pose)) = (self.referenced, direct(pivots)) else {
            return false;
        };
        self.hold_at(&pose);
        true
    }

    fn hold_at(&mut self, pose: &Pose<Fixed>) {
        let platform = position(pose);
        self.motion
            .rest_at(self.motion.centre().from_platform(&platform));
        self.settling.start();
        self.set_radius_limit_from(&platform);
        self.reset_watches();
        for servo in &mut self.servo {
            servo.restart();
        }
    }

    /// Takes other constants: a quarter of the bytes that a plan has, copied in a tick that leaves no snapshot.
    fn configure(&mut self, config: &mut Config, wanted: &Config) {
        let moved = [0, 1, 2].map(|i| !config.encoders[i].has_same_mounting(&wanted.encoders[i]));
        config.clone_from(wanted);
        for (encoder, moved) in self.encoders.iter_mut().zip(moved) {
            if moved {
                // The angle jumps by what the zero moved: that is no implausible step, it is a new start.
                *encoder = Encoder::default();
                self.referenced = false;
            }
        }
    }

    /// A motion that has come to rest.
    #[cold]
    pub(crate) fn finish_motion(&mut self) {
        if let Outcome::To(mode) = outcome(self.mode, Event::AtRest) {
            self.mode = mode;
        }
    }

    /// A fault: latched, and answered as the table has it.
    ///
    /// The first one stays latched until it is acknowledged; one that ends its controlled stop is kept besides.
    #[cold]
    pub(crate) fn raise_fault(
        &mut self,
        kind: FaultKind,
        pivot: Option<usize>,
        value: f32,
        limit: f32,
    ) {
        self.raise_fault_with(kind.reaction(), kind, pivot, [value, limit]);
    }

    fn raise_fault_with(
        &mut self,
        mut reaction: Reaction,
        kind: FaultKind,
        pivot: Option<usize>,
        [value, limit]: [f32; 2],
    ) {
        if kind.concerns_encoder() {
            self.referenced = false;
            // One lost pivot is led by its model; two are not.
            if self.lost_pivot.is_some() {
                reaction = Reaction::Brake;
            }
            self.mark_pivot_lost(pivot);
        }
        let Outcome::To(mode) = outcome(self.mode, Event::of(reaction)) else {
            return;
        };
        let fault = Some(Fault {
            kind,
            pivot: pivot.map(|i| i as u8),
            tick: self.tick,
            value,
            limit,
        });
        if self.fault.is_none() {
            self.fault = fault;
        } else {
            self.stop_ended_by = fault;
        }
        if mode == Mode::Stopping {
            self.motion.begin_fault_stop();
        }
        self.mode = mode;
        self.coasts = reaction == Reaction::Coast;
        self.settling.start();
    }

    /// From here on a pivot's setpoint stands for what its encoder can not tell.
    fn mark_pivot_lost(&mut self, pivot: Option<usize>) {
        self.lost_pivot = pivot;
        if let Some(servo) = pivot.and_then(|i| self.servo.get_mut(i)) {
            servo.run_open_loop();
        }
    }
}

fn event_of(config: &Config, command: &Command) -> Event {
    match command {
        Command::Reference => Event::Reference,
        Command::Servo(true) => Event::ServoOn,
        Command::Servo(false) => Event::ServoOff,
        Command::Move(_) => Event::Move,
        Command::Centre(_) => Event::Centre,
        Command::Configure(wanted) => {
            let same = (config.encoders.iter().zip(&wanted.encoders))
                .all(|(now, wanted)| now.has_same_mounting(wanted));
            if same {
                Event::Constants
            } else {
                Event::Mounting
            }
        }
        Command::Acknowledge => Event::Acknowledge,
    }
}

/// The platform's position in a pose.
fn position(pose: &Pose<Fixed>) -> Position {
    [
        pose.x.to_position(),
        pose.y.to_position(),
        pose.theta.units(),
    ]
}

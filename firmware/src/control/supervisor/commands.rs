//! Commands: which are taken in which state, and what each does.

use super::transitions::{Event, Outcome, outcome};
use crate::control::command::Command;
use crate::control::config::Config;
use crate::control::encoder::Encoder;
use crate::control::excitation::{Excitation, ExcitationEnd};
use crate::control::guides::Guides;
use crate::control::referencing;
use crate::control::state::State;
use crate::control::subdivision::SubdivisionTable;
use crate::fault::Fault;
use crate::mode::Mode;
use crate::motion::{PlanReceiver, Position};
use crate::number::Fixed;
use kinematics::{Angle, Pose};

impl State {
    /// Handles a command as the table of transitions has it.
    pub(in crate::control) fn handle_command(
        &mut self,
        config: &mut Config,
        command: &Command,
        plans: PlanReceiver<'_>,
        pivots: &[Angle; 3],
    ) {
        let event = event_of(config, command);
        let done = match outcome(self.mode, event) {
            Outcome::Nothing => None,
            Outcome::Refused => Some(false),
            Outcome::To(mode) => {
                self.apply(config, command);
                self.mode = mode;
                Some(true)
            }
            Outcome::If(mode) => {
                let done = self.try_apply(config, command, plans, pivots);
                if done {
                    let slept = !self.bridges_awake();
                    self.mode = mode;
                    if slept && self.bridges_awake() {
                        self.wake_bridges(&config.limits);
                    }
                }
                Some(done)
            }
        };
        if done == Some(false) {
            self.refused = self.refused.wrapping_add(1);
        }
        if done != Some(true)
            && let Command::Move(plan) = command
        {
            plans.give_back(plan.slot);
        }
    }

    /// What can not fail.
    fn apply(&mut self, config: &mut Config, command: &Command) {
        match command {
            Command::Configure(wanted) => self.configure(config, wanted),
            Command::Centre(centre) => {
                // Servo off in mid-motion leaves the motion as it was: there is nothing under way then.
                if self.mode == Mode::Off {
                    self.motion.rest_at(self.motion.position());
                }
                // At rest, as it is now, it is taken.
                let _ = self.motion.set_centre(*centre);
            }
            Command::Calibrate(wanted) => self.calibrated.set(wanted),
            Command::Subdivide(tables) => {
                let takes = tables.iter().any(SubdivisionTable::takes);
                self.subdivision = takes.then_some(*tables);
            }
            // The servo is on already, or goes off, which is all there is to it.
            Command::Servo(false) | Command::EndExcitation => {
                self.excitation.end(ExcitationEnd::Stopped);
            }
            Command::Reference
            | Command::Servo(true)
            | Command::Move(_)
            | Command::Excite(_)
            | Command::Acknowledge => {}
        }
    }

    /// What the stage may not be ready for; nothing has changed then.
    fn try_apply(
        &mut self,
        config: &Config,
        command: &Command,
        plans: PlanReceiver<'_>,
        pivots: &[Angle; 3],
    ) -> bool {
        match command {
            // The command side refuses it before: this is for the case that it does not.
            Command::Reference | Command::Servo(_) if !config.commissioned => false,
            Command::Reference if !self.referenced => self.reference(config, pivots),
            Command::Reference | Command::Servo(_) => self.hold(config, pivots),
            Command::Move(plan) => {
                let taken = self.motion.accept(plan, plans).is_ok();
                if taken {
                    self.settling.start();
                    self.put_off_brake_resistor_test();
                }
                taken
            }
            Command::Acknowledge => {
                let lasts = |fault: Fault| fault.kind.lasts_until_restart();
                if self.fault.is_some_and(lasts) {
                    return false;
                }
                self.fault = None;
                self.stop_ended_by = None;
                self.lost_pivot = None;
                true
            }
            Command::Excite(excitation) => self.excite(excitation, pivots),
            Command::Centre(_)
            | Command::Configure(_)
            | Command::Calibrate(_)
            | Command::Subdivide(_)
            | Command::EndExcitation => false,
        }
    }

    /// Takes theta and the pivots' turns from what single-turn encoders show, and holds.
    fn reference(&mut self, config: &Config, pivots: &[Angle; 3]) -> bool {
        let ready = self
            .encoders
            .iter()
            .all(|encoder| encoder.unusable().is_none());
        if !ready {
            return false;
        }
        let Ok(pose) = self.calibrated.measured_pose(config, pivots) else {
            return false;
        };
        let (theta, unwrapped) = referencing::within_one_turn(pose.theta, pivots);
        for (encoder, angle) in self.encoders.iter_mut().zip(unwrapped) {
            encoder.unwrap_near(angle);
        }
        self.referenced = true;
        self.hold_at(config, &Pose { theta, ..pose });
        true
    }

    /// Servo on, at the pose where the stage is.
    fn hold(&mut self, config: &Config, pivots: &[Angle; 3]) -> bool {
        if !self.referenced {
            return false;
        }
        let Ok(pose) = self.calibrated.measured_pose(config, pivots) else {
            return false;
        };
        self.hold_at(config, &pose);
        true
    }

    fn hold_at(&mut self, config: &Config, pose: &Pose<Fixed>) {
        let platform = config.steps.nearest(&position(pose));
        self.motion
            .rest_at(self.motion.centre().from_platform(&platform));
        self.settling.restart();
        self.rest_mode.restart();
        self.set_radius_limit_from(&platform);
        self.reset_watches();
        self.guides = Guides::default();
        for servo in &mut self.servo {
            servo.restart();
        }
    }

    /// Begins an excitation: one at a time, with encoders that answer, and with the servo on none that has its own.
    fn excite(&mut self, excitation: &Excitation, pivots: &[Angle; 3]) -> bool {
        let ready = (self.encoders.iter()).all(|encoder| encoder.unusable().is_none());
        if !ready
            || self.excitation.request().is_some()
            || excitation.needs_servo_off() && self.servo_on()
        {
            return false;
        }
        if self.mode == Mode::Off {
            for servo in &mut self.servo {
                servo.restart();
            }
        }
        self.excitation.start(excitation, pivots);
        true
    }

    /// Takes other constants.
    fn configure(&mut self, config: &mut Config, wanted: &Config) {
        let moved = [0, 1, 2].map(|i| {
            !config.encoders[i].has_same_mounting(&wanted.encoders[i])
                || !config.wiring.has_same_encoders(&wanted.wiring)
        });
        for (i, servo) in self.servo.iter_mut().enumerate() {
            // Other ones than were set last: what has been learnt since then stays otherwise.
            let learnt = &wanted.servo.pivots[i].learnt;
            if config.servo.pivots[i].learnt != *learnt {
                servo.restore(learnt);
            }
        }
        config.clone_from(wanted);
        for (encoder, moved) in self.encoders.iter_mut().zip(moved) {
            if moved {
                // The angle jumps by what the zero moved: that is no implausible step, it is a new start.
                *encoder = Encoder::default();
                self.referenced = false;
            }
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
            if same && config.wiring == wanted.wiring {
                Event::Constants
            } else {
                Event::Mounting
            }
        }
        // What the readings mean is another pose.
        Command::Calibrate(_) | Command::Subdivide(_) => Event::Mounting,
        Command::Excite(_) => Event::Excite,
        Command::EndExcitation => Event::EndExcitation,
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

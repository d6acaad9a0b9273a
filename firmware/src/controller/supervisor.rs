//! The supervisor: which commands are taken in which state, and what is a fault.
//!
//! | state | bridges | commands taken |
//! |---|---|---|
//! | off | coast | reference; servo on once referenced; centre of rotation; other constants |
//! | holding | drive | servo off; a plan that starts where the motion is; centre of rotation; constants but those of the encoders' mounting |
//! | moving | drive | servo off; a plan that starts where the motion is |
//! | fault | brake, or coast if a bridge or the supply is at fault | acknowledge, which leads to off; other constants |
//!
//! What is not taken is counted as refused, and changes nothing.
//!
//! The measured pose is computed when a command needs it, not at every tick: while the servo is on, the setpoint is a pose of
//! the mechanism and every pivot is within the largest following error of it, which bounds the measured pose more tightly
//! than any margin of the mechanics.

use super::{Inputs, State};
use crate::config::{Config, SUPPLY_V_PER_COUNT};
use crate::encoder::Encoder;
use crate::fault::{Fault, FaultKind};
use crate::link::{Command, Mode};
use crate::motion::Position;
use crate::number::Fixed;
use crate::reference;
use kinematics::{Angle, Pose, direct};

impl State {
    pub(super) fn servo_on(&self) -> bool {
        matches!(self.mode, Mode::Holding | Mode::Moving)
    }

    /// Whether the bridges drive or brake. Off coasts, so that a stage can be moved by hand; a fault brakes, but for one of
    /// the bridges or of their supply, which can not be trusted to.
    pub(super) fn awake(&self) -> bool {
        match (self.mode, self.fault) {
            (Mode::Off, _) => false,
            (_, Some(fault)) => {
                // Nothing has moved yet when settings cannot be used.
                !matches!(
                    fault.kind,
                    FaultKind::BridgeFault
                        | FaultKind::SupplyLow
                        | FaultKind::SettingsDamaged
                        | FaultKind::SettingsNewer
                )
            }
            _ => true,
        }
    }

    pub(super) fn obey(&mut self, config: &mut Config, command: &Command, pivots: &[Angle; 3]) {
        match command {
            Command::Acknowledge => {
                if self.fault.take().is_some() {
                    self.mode = Mode::Off;
                }
            }
            Command::Configure(wanted) => self.configure(config, wanted),
            _ if self.mode == Mode::Fault => self.refused = self.refused.wrapping_add(1),
            Command::Reference => self.reference(pivots),
            Command::Servo(true) => self.hold(pivots),
            Command::Servo(false) => self.mode = Mode::Off,
            Command::Centre(centre) => {
                // Servo off in mid-motion leaves the motion as it was: there is nothing under way then.
                if self.mode == Mode::Off {
                    self.motion.rest_at(self.motion.position());
                }
                if self.motion.set_centre(*centre).is_err() {
                    self.refused = self.refused.wrapping_add(1);
                }
            }
            Command::Move(plan) => {
                let taken = self.servo_on() && self.motion.accept(plan).is_ok();
                if taken {
                    self.mode = Mode::Moving;
                    self.settling.start();
                } else {
                    self.refused = self.refused.wrapping_add(1);
                }
            }
        }
    }

    /// Takes theta and the pivots' turns from what single-turn encoders show, and holds.
    fn reference(&mut self, pivots: &[Angle; 3]) {
        let ready = self
            .encoders
            .iter()
            .all(|encoder| encoder.unusable().is_none());
        if self.referenced {
            self.hold(pivots);
            return;
        }
        let (true, Ok(pose)) = (ready, direct::<Fixed>(pivots)) else {
            self.refused = self.refused.wrapping_add(1);
            return;
        };
        let (theta, unwrapped) = reference::within_one_turn(pose.theta, pivots);
        for (encoder, angle) in self.encoders.iter_mut().zip(unwrapped) {
            encoder.unwrap_near(angle);
        }
        self.referenced = true;
        self.hold_at(&Pose { theta, ..pose });
    }

    /// Servo on, at the pose where the stage is. Nothing happens when it is on already.
    fn hold(&mut self, pivots: &[Angle; 3]) {
        if self.servo_on() {
            return;
        }
        let (true, Ok(pose)) = (self.referenced, direct(pivots)) else {
            self.refused = self.refused.wrapping_add(1);
            return;
        };
        self.hold_at(&pose);
    }

    fn hold_at(&mut self, pose: &Pose<Fixed>) {
        let platform = position(pose);
        self.motion
            .rest_at(self.motion.centre().of_platform(&platform));
        self.settling.start();
        self.mode = Mode::Holding;
        for servo in &mut self.servo {
            servo.restart();
        }
    }

    /// Takes other constants: a quarter of the bytes that a plan has, copied in a tick that leaves no snapshot.
    fn configure(&mut self, config: &mut Config, wanted: &Config) {
        let moved = [0, 1, 2].map(|i| !config.encoders[i].reads_as(&wanted.encoders[i]));
        let remounted = moved.contains(&true);
        if self.mode == Mode::Moving || (remounted && self.servo_on()) {
            self.refused = self.refused.wrapping_add(1);
            return;
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

    pub(super) fn check_inputs(&mut self, config: &Config, inputs: &Inputs) {
        if self.mode == Mode::Fault {
            // An encoder that is lost loses its turns, whatever else is wrong already.
            self.referenced &= self.encoders.iter().all(|e| e.unusable().is_none());
            return;
        }
        if inputs.emergency_stop {
            self.fail(FaultKind::EmergencyStop, None, 0.0, 0.0);
            return;
        }
        if self.referenced {
            for i in 0..3 {
                if let Some(kind) = self.encoders[i].unusable() {
                    self.referenced = false;
                    self.fail(kind, Some(i), 0.0, 0.0);
                    return;
                }
            }
        }
        if !self.servo_on() {
            return;
        }
        for i in 0..3 {
            if inputs.bridge_fault[i] {
                self.fail(FaultKind::BridgeFault, Some(i), 0.0, 0.0);
                return;
            }
        }
        if inputs.supply_counts < config.limits.supply_min {
            let volts = |counts: u16| f32::from(counts) * SUPPLY_V_PER_COUNT as f32;
            self.fail(
                FaultKind::SupplyLow,
                None,
                volts(inputs.supply_counts),
                volts(config.limits.supply_min),
            );
        }
    }

    #[cold]
    pub(super) fn fail(&mut self, kind: FaultKind, pivot: Option<usize>, value: f32, limit: f32) {
        self.mode = Mode::Fault;
        self.fault = Some(Fault {
            kind,
            pivot: pivot.map(|i| i as u8),
            tick: self.tick,
            value,
            limit,
        });
        self.settling.start();
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

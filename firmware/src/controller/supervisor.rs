//! The supervisor: which commands are taken in which state, and what is a fault.
//!
//! | state | bridges | commands taken |
//! |---|---|---|
//! | off | coast | reference; servo on once referenced |
//! | holding, moving | drive | servo off; a plan that starts where the motion is |
//! | fault | brake, or coast if a bridge or the supply is at fault | acknowledge, which leads to off |
//!
//! What is not taken is counted as refused, and changes nothing.

use super::{Inputs, State};
use crate::config::{Config, SUPPLY_V_PER_COUNT};
use crate::fault::{Fault, FaultKind};
use crate::link::{Command, Mode};
use crate::motion::Position;
use crate::number::Fixed;
use crate::reference;
use kinematics::{Angle, Pose};

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
                !matches!(fault.kind, FaultKind::BridgeFault | FaultKind::SupplyLow)
            }
            _ => true,
        }
    }

    pub(super) fn obey(
        &mut self,
        command: &Command,
        pivots: &[Angle; 3],
        pose: Option<&Pose<Fixed>>,
    ) {
        match command {
            Command::Acknowledge => {
                if self.fault.take().is_some() {
                    self.mode = Mode::Off;
                }
            }
            _ if self.mode == Mode::Fault => self.refused = self.refused.wrapping_add(1),
            Command::Reference => self.reference(pivots, pose),
            Command::Servo(true) => self.hold(pose),
            Command::Servo(false) => self.mode = Mode::Off,
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
    fn reference(&mut self, pivots: &[Angle; 3], pose: Option<&Pose<Fixed>>) {
        let ready = self
            .encoders
            .iter()
            .all(|encoder| encoder.unusable().is_none());
        let (true, Some(pose)) = (ready, pose) else {
            self.refused = self.refused.wrapping_add(1);
            return;
        };
        if self.referenced {
            self.hold(Some(pose));
            return;
        }
        let (theta, unwrapped) = reference::within_one_turn(pose.theta, pivots);
        for (encoder, angle) in self.encoders.iter_mut().zip(unwrapped) {
            encoder.unwrap_near(angle);
        }
        self.referenced = true;
        self.hold(Some(&Pose { theta, ..*pose }));
    }

    /// Servo on, at the pose where the stage is. Nothing happens when it is on already.
    fn hold(&mut self, pose: Option<&Pose<Fixed>>) {
        let (true, Some(pose)) = (self.referenced, pose) else {
            self.refused = self.refused.wrapping_add(1);
            return;
        };
        if self.servo_on() {
            return;
        }
        self.motion.rest_at(position(pose));
        self.settling.start();
        self.mode = Mode::Holding;
        for servo in &mut self.servo {
            servo.restart();
        }
    }

    pub(super) fn check_inputs(&mut self, config: &Config, inputs: &Inputs, no_pose: bool) {
        if self.mode == Mode::Fault {
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
            return;
        }
        if no_pose {
            self.fail(FaultKind::ImpossiblePose, None, 0.0, 0.0);
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

/// The position of a pose.
fn position(pose: &Pose<Fixed>) -> Position {
    [
        pose.x.to_position(),
        pose.y.to_position(),
        pose.theta.units(),
    ]
}

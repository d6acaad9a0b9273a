//! The control loop: one function of state and inputs.

use crate::config::Config;
use crate::drivers::biss::RawFrame;
use crate::drivers::bridge::Duty;
use crate::encoder::Encoder;
use crate::fault::{Fault, FaultKind};
use crate::link::{Command, Mode, Snapshot, TickLink};
use crate::motion::{Motion, Position, Setpoint};
use crate::number::Fixed;
use crate::recorder::{Record, Sample};
use crate::reference;
use crate::servo::{AxisServo, PivotSetpoint, platform_torques};
use crate::settling::Settling;
use kinematics::{Angle, Guide, Inverse, Pose, direct, inverse, pivot_motion};

/// What the hardware gives a tick.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Frames of the three encoders, all latched at the same instant.
    pub frames: [RawFrame; 3],
    /// Fault pins of the bridges (true: fault).
    pub bridge_fault: [bool; 3],
    /// Emergency stop pressed.
    pub emergency_stop: bool,
    /// Motor currents, ADC counts.
    pub current_counts: [u16; 3],
    /// Supply, ADC counts.
    pub supply_counts: u16,
}

/// What a tick gives the hardware.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Duties; zero brakes.
    pub duty: [Duty; 3],
    /// Sleep pins: false lets the motors coast whatever the duty.
    pub awake: bool,
}

/// All that the loop remembers.
#[derive(Clone, Debug, Default)]
pub struct State {
    tick: u64,
    mode: Mode,
    fault: Option<Fault>,
    referenced: bool,
    encoders: [Encoder; 3],
    motion: Motion,
    servo: [AxisServo; 3],
    settling: Settling,
    supply: f32,
    commands: u32,
    refused: u32,
}

/// One period of the control loop, at 20 kHz by default.
///
/// Encoder frames go in, duties come out; in between the data path reads top to bottom. Called by the timer's update interrupt
/// with the highest priority. The frames were latched 15 us before; the duties act from the next PWM period, 25 us after the
/// update, which is the deadline. A miss is a late duty: the old one acts one PWM period longer. No allocation, no blocking,
/// no panic, no unbounded loop, no f64; its cost on the chip stands in the README and is printed by `cargo chip`.
#[inline]
pub fn tick(
    config: &Config,
    state: &mut State,
    inputs: &Inputs,
    link: &mut TickLink<'_>,
    recorder: &mut impl Record,
) -> Outputs {
    state.tick = state.tick.wrapping_add(1);
    for i in 0..3 {
        state.encoders[i].take(&config.encoders[i], &inputs.frames[i]);
    }
    let pivots = state.encoders.each_ref().map(Encoder::angle);
    let pose = direct::<Fixed>(&pivots).ok();
    // A slow average: the supply feeds every duty, and one count of the ADC is 0.03 % of it.
    let supply = f32::from(inputs.supply_counts);
    if state.tick == 1 {
        state.supply = supply;
    }
    state.supply += (supply - state.supply) * SUPPLY_SMOOTHING;

    if let Some(command) = link.commands.dequeue() {
        state.commands = state.commands.wrapping_add(1);
        state.obey(command, &pivots, pose.as_ref());
    }
    // Once more: referencing gives the pivots their turns.
    let pivots = state.encoders.each_ref().map(Encoder::angle);
    state.check_inputs(config, inputs, pose.is_none());

    state.motion.advance();
    let setpoint = state.motion.setpoint(&config.scale);
    let driven = if state.servo_on() {
        state.drive(config, &setpoint, &pivots)
    } else {
        None
    };
    let (target, rates, duty) = driven.unwrap_or((pivots, [0.0; 3], [Duty(0); 3]));
    let outputs = Outputs {
        duty,
        awake: state.awake(),
    };
    recorder.record(&Sample {
        tick: state.tick,
        mode: state.mode,
        setpoint,
        pivot_setpoints: target,
        pivot_rates: rates,
        pivots,
        duty,
        commands: state.commands,
    });
    if link.snapshots.ready() {
        // There is room: `ready` said so, and only this side fills the queue.
        let _ = link.snapshots.enqueue(state.snapshot(&pivots));
    }
    outputs
}

const SUPPLY_SMOOTHING: f32 = 1.0 / 256.0;

type Driven = ([Angle; 3], [f32; 3], [Duty; 3]);

impl State {
    /// State at power-up.
    pub fn new() -> Self {
        Self::default()
    }

    /// The latched fault.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    fn servo_on(&self) -> bool {
        matches!(self.mode, Mode::Holding | Mode::Moving)
    }

    /// Whether the bridges drive or brake. Off coasts, so that a stage can be moved by hand; a fault brakes, but for one of
    /// the bridges or of their supply, which can not be trusted to.
    fn awake(&self) -> bool {
        match (self.mode, self.fault) {
            (Mode::Off, _) => false,
            (_, Some(fault)) => {
                !matches!(fault.kind, FaultKind::BridgeFault | FaultKind::SupplyLow)
            }
            _ => true,
        }
    }

    fn obey(&mut self, command: Command, pivots: &[Angle; 3], pose: Option<&Pose<Fixed>>) {
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

    fn check_inputs(&mut self, config: &Config, inputs: &Inputs, no_pose: bool) {
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
            let volts = |counts: u16| f32::from(counts) * crate::config::SUPPLY_V_PER_COUNT as f32;
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

    /// Setpoint to duties; `None` when a fault came of it.
    fn drive(
        &mut self,
        config: &Config,
        setpoint: &Setpoint,
        pivots: &[Angle; 3],
    ) -> Option<Driven> {
        let Some(Inverse {
            pivots: target,
            guides,
        }) = pose(&setpoint.position).and_then(|pose| inverse(&pose).ok())
        else {
            self.fail(FaultKind::ImpossibleSetpoint, None, 0.0, 0.0);
            return None;
        };
        let guides = guides.map(|guide: Guide<Fixed>| guide.map(Fixed::to_f32));
        let (twist, acceleration) = (&setpoint.twist, &setpoint.acceleration);
        let motion = pivot_motion(&guides, twist, acceleration);
        let torques = platform_torques(&config.servo.body, &guides, twist, acceleration);

        let mut errors = [0i32; 3];
        for i in 0..3 {
            let error = pivots[i].units().wrapping_sub(target[i].units());
            errors[i] = error.clamp(i64::from(i32::MIN + 1), i64::from(i32::MAX)) as i32;
            if errors[i].unsigned_abs() > config.limits.following_error.unsigned_abs() {
                const RAD: f32 = (1.0 / crate::config::UNITS_PER_RAD) as f32;
                let limit = config.limits.following_error as f32 * RAD;
                self.fail(
                    FaultKind::FollowingError,
                    Some(i),
                    errors[i] as f32 * RAD,
                    limit,
                );
                return None;
            }
        }
        self.settling
            .look(&config.limits, &errors, self.motion.moving());
        self.mode = if self.motion.moving() {
            Mode::Moving
        } else {
            Mode::Holding
        };
        let counts_per_volt = config.servo.counts_per_volt(self.supply);
        let mut duty = [Duty(0); 3];
        for i in 0..3 {
            let pivot = PivotSetpoint {
                error: errors[i],
                rate: motion.rates[i],
                acceleration: motion.accelerations[i],
                platform_torque: torques[i],
            };
            duty[i] = self.servo[i].step(&config.servo, &pivot, counts_per_volt);
        }
        Some((target, motion.rates, duty))
    }

    fn fail(&mut self, kind: FaultKind, pivot: Option<usize>, value: f32, limit: f32) {
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

    fn snapshot(&self, pivots: &[Angle; 3]) -> Snapshot {
        let (plan, plan_tick) = self.motion.progress();
        Snapshot {
            tick: self.tick,
            mode: self.mode,
            fault: self.fault,
            referenced: self.referenced,
            encoder_faults: self.encoders.each_ref().map(Encoder::unusable),
            pivots: *pivots,
            setpoint: self.motion.position(),
            plan,
            plan_tick,
            settled: self.settling.settled() && self.servo_on(),
            commands: self.commands,
            refused: self.refused,
            peak_following_error_rad: self.settling.peak_rad(),
        }
    }
}

/// The pose of a position, as far as it is one of the mechanism.
#[inline]
fn pose(position: &Position) -> Option<Pose<Fixed>> {
    Some(Pose {
        x: Fixed::from_position(position[0])?,
        y: Fixed::from_position(position[1])?,
        theta: Angle::from_units(position[2]),
    })
}

/// The position of a pose.
fn position(pose: &Pose<Fixed>) -> Position {
    [
        pose.x.to_position(),
        pose.y.to_position(),
        pose.theta.units(),
    ]
}

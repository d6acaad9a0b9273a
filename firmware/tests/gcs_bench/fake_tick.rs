//! A tick that moves exactly as commanded.
#![allow(dead_code)] // Each test file uses its part.

use super::axes::{Axes, Course};
use firmware::control::config::Config;
use firmware::control::loop_counters::LoopCounters;
use firmware::drivers::bridge::Duty;
use firmware::fault::{Fault, FaultKind};
use firmware::mode::Mode;
use firmware::motion::{AxisState, PlanFollower, Setpoint, SetpointScale};
use firmware::parameters::Parameters;
use firmware::queues::{Command, Snapshot, TickQueues};
use firmware::recorder::{Sample, TickObserver};
use kinematics::{Angle, Pose, inverse};

/// Ticks that a stage at rest takes to settle.
pub const DWELL: u64 = 40;

/// A tick without encoders and motors: pivots are where the setpoint puts them.
pub struct FakeTick<'q> {
    queues: TickQueues<'q>,
    motion: PlanFollower,
    axes: Axes,
    /// The plan accepted in the last tick, if one was.
    pub accepted: Option<Course>,
    scale: SetpointScale,
    /// What the next snapshot says; tests set faults here.
    pub now: Snapshot,
    at_rest: u64,
    /// Kinds of commands taken, in order.
    pub log: Vec<&'static str>,
    /// Largest change of velocity between two ticks, track radii (turns) per second: continuity.
    pub worst_jump: f32,
    last_twist: [f32; 3],
    /// What the tick computes with, as it was told.
    pub config: Config,
    /// Takes no settings.
    pub refuses_settings: bool,
}

impl<'q> FakeTick<'q> {
    /// At this end of the queues, of a stage of these parameters: not referenced, at the origin.
    pub fn new(queues: TickQueues<'q>, parameters: &Parameters) -> Self {
        Self {
            queues,
            motion: PlanFollower::default(),
            axes: Axes::default(),
            accepted: None,
            scale: SetpointScale::new(parameters.limits.rate_hz),
            now: Snapshot::default(),
            at_rest: 0,
            log: Vec::new(),
            worst_jump: 0.0,
            last_twist: [0.0; 3],
            config: Config::new(parameters),
            refuses_settings: false,
        }
    }

    pub fn run(&mut self) {
        self.now.tick += 1;
        self.accepted = None;
        if let Some(command) = self.queues.commands.dequeue() {
            self.now.commands += 1;
            self.obey(command);
        }
        self.motion.advance(self.queues.plans);
        self.axes.follow(&self.motion);
        let setpoint = self.motion.setpoint(&self.scale);
        let on = matches!(self.now.mode, Mode::Holding | Mode::Moving);
        if on {
            self.now.mode = if self.motion.is_moving() {
                Mode::Moving
            } else {
                Mode::Holding
            };
            self.watch([setpoint.twist.x, setpoint.twist.y, setpoint.twist.theta]);
        }
        self.at_rest = if self.now.mode == Mode::Holding {
            self.at_rest + 1
        } else {
            0
        };
        self.now.settled = self.at_rest > DWELL;
        self.now.setpoint = setpoint.position;
        (self.now.plan, self.now.plan_tick) = self.motion.progress();
        self.now.centre = self.motion.centre();
        let platform = self.now.centre.to_platform(&setpoint.position);
        self.now.pivots = pivots(&platform);
        self.now.loop_counters.ticks += 1;
        let sample = self.sample(setpoint);
        if let Some(observers) = &mut self.queues.observers {
            observers.observe(&sample);
        }
        if self.queues.snapshots.ready() {
            let _ = self.queues.snapshots.enqueue(self.now.clone());
            self.now.loop_counters = LoopCounters::default();
        }
    }

    /// Position, velocity and acceleration of the setpoint.
    pub fn axes(&self) -> &[AxisState; 3] {
        self.axes.now()
    }

    /// Commands sent and not taken yet.
    pub fn commands_waiting(&self) -> usize {
        self.queues.commands.len()
    }

    /// What the recorder sees of this tick.
    fn sample(&self, setpoint: Setpoint) -> Sample {
        Sample {
            tick: self.now.tick,
            mode: self.now.mode,
            fault: self.now.fault.map(|fault| fault.kind),
            setpoint,
            reference_point: setpoint,
            pivot_setpoints: self.now.pivots,
            pivot_rates: [0.0; 3],
            pivots: self.now.pivots,
            duty: [Duty(420), Duty(-420), Duty(0)],
            current_counts: [0; 3],
            supply_counts: 0,
            tick_cycles: 3000,
            commands: self.now.commands,
            servo: None,
        }
    }

    fn obey(&mut self, command: Command) {
        if self.now.mode == Mode::Fault && command != Command::Acknowledge {
            self.now.refused += 1;
            if let Command::Move(handle) = command {
                self.queues.plans.give_back(handle.slot);
            }
            return;
        }
        match command {
            Command::Reference => {
                self.log.push("reference");
                self.now.referenced = true;
                self.hold();
            }
            Command::Servo(true) => {
                self.log.push("on");
                self.hold();
            }
            Command::Servo(false) => {
                self.log.push("off");
                self.now.mode = Mode::Off;
            }
            Command::Centre(centre) => {
                self.log.push("centre");
                if self.motion.set_centre(centre).is_err() {
                    self.now.refused += 1;
                }
            }
            Command::Move(handle) => {
                let plan = self.queues.plans.plan(&handle);
                let accepted = self.motion.accept(&handle, self.queues.plans).is_ok();
                self.log.push(if accepted { "move" } else { "refused" });
                if accepted {
                    self.now.mode = Mode::Moving;
                    self.accepted = Some(self.axes.accept(plan).clone());
                } else {
                    self.queues.plans.give_back(handle.slot);
                    self.now.refused += 1;
                }
            }
            Command::Configure(_) if self.refuses_settings => {
                self.log.push("settings refused");
                self.now.refused += 1;
            }
            Command::Configure(config) => {
                self.log.push("configure");
                self.config = config;
            }
            Command::Subdivide(_) => self.log.push("subdivide"),
            Command::Excite(_) | Command::EndExcitation | Command::Calibrate(_) => {}
            Command::Acknowledge => {
                self.log.push("acknowledge");
                self.now.fault = None;
                self.now.mode = Mode::Off;
            }
        }
    }

    /// Servo on, where the stage is, as far as that is told.
    fn hold(&mut self) {
        let centre = self.motion.centre();
        let platform = centre.to_platform(&self.motion.position());
        let held = self.config.steps.nearest(&platform);
        self.motion.rest_at(centre.from_platform(&held));
        self.now.mode = Mode::Holding;
    }

    fn watch(&mut self, twist: [f32; 3]) {
        for (now, last) in twist.iter().zip(self.last_twist) {
            self.worst_jump = self.worst_jump.max((now - last).abs());
        }
        self.last_twist = twist;
    }

    /// Puts the stage at rest at a pose, as if moved by hand.
    pub fn place(&mut self, x_mm: f64, y_mm: f64, theta_deg: f64) {
        let units = |mm: f64| (mm / 100.0 * 4_294_967_296.0).round() as i64;
        let theta = Angle::from_degrees(theta_deg).unwrap().units();
        let platform = [units(x_mm), units(y_mm), theta];
        let point = self.motion.centre().from_platform(&platform);
        self.motion.rest_at(point);
    }

    pub fn fail(&mut self, kind: FaultKind, pivot: Option<u8>) {
        self.now.mode = Mode::Fault;
        self.now.fault = Some(Fault {
            kind,
            pivot,
            tick: self.now.tick,
            value: 0.003,
            limit: 0.002,
        });
    }
}

fn pivots(position: &[i64; 3]) -> [Angle; 3] {
    let radii = |units: i64| units as f64 / 4_294_967_296.0;
    let theta = Angle::from_units(position[2]);
    let whole = Angle::from_units(i64::from(theta.turns()) << 32);
    let pose = Pose {
        x: radii(position[0]),
        y: radii(position[1]),
        theta: (theta - whole).radians(),
    };
    inverse(&pose)
        .unwrap()
        .pivots
        .map(|pivot: f64| Angle::from_radians(pivot).unwrap() + whole)
}

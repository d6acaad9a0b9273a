//! A panel with several connections in front of a tick that moves exactly as commanded.
#![allow(dead_code)] // Each test file uses its part.

use core::convert::Infallible;
use firmware::control::config::Config;
use firmware::control::loop_counters::LoopCounters;
use firmware::drivers::bridge::Duty;
use firmware::fault::{Fault, FaultKind};
use firmware::gcs::{Identity, Panel, Session};
use firmware::mode::Mode;
use firmware::motion::{PlanFollower, Setpoint, SetpointScale};
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Queues, Snapshot, TickQueues};
use firmware::recorder::Sample;
use kinematics::{Angle, Pose, inverse};

/// Ticks that a stage at rest takes to settle.
pub const DWELL: u64 = 40;

/// What the panel has written.
#[derive(Default)]
pub struct Written(pub Vec<u8>);

impl embedded_io::ErrorType for Written {
    type Error = Infallible;
}

impl embedded_io::Write for Written {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// A tick without encoders and motors: pivots are where the setpoint puts them.
pub struct FakeTick {
    queues: TickQueues<'static>,
    motion: PlanFollower,
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

impl FakeTick {
    pub fn run(&mut self) {
        self.now.tick += 1;
        if let Some(command) = self.queues.commands.dequeue() {
            self.now.commands += 1;
            self.obey(command);
        }
        self.motion.advance();
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
        if self.queues.recorder.is_active() {
            self.queues.recorder.observe(&self.sample(setpoint));
        }
        if self.queues.snapshots.ready() {
            let _ = self.queues.snapshots.enqueue(self.now.clone());
            self.now.loop_counters = LoopCounters::default();
        }
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
        }
    }

    fn obey(&mut self, command: Command) {
        if self.now.mode == Mode::Fault && command != Command::Acknowledge {
            self.now.refused += 1;
            return;
        }
        match command {
            Command::Reference => {
                self.log.push("reference");
                self.now.referenced = true;
                self.now.mode = Mode::Holding;
            }
            Command::Servo(true) => {
                self.log.push("on");
                let at = self.motion.setpoint(&self.scale).position;
                self.motion.rest_at(at);
                self.now.mode = Mode::Holding;
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
            Command::Move(plan) => {
                let accepted = self.motion.accept(plan).is_ok();
                self.log.push(if accepted { "move" } else { "refused" });
                if accepted {
                    self.now.mode = Mode::Moving;
                } else {
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
            Command::Acknowledge => {
                self.log.push("acknowledge");
                self.now.fault = None;
                self.now.mode = Mode::Off;
            }
        }
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

/// The panel, its connections and the tick.
pub struct Bench {
    panel: Panel,
    sessions: Vec<(Session, Written)>,
    pub queues: CommandQueues<'static>,
    pub tick: FakeTick,
}

impl Bench {
    /// One connection, nothing has run yet.
    pub fn cold() -> Self {
        let identity = Identity {
            serial: "4711",
            version: "0.1.0",
        };
        Self::with(Panel::new(&Parameters::REFERENCE, identity))
    }

    /// The same with this panel.
    pub fn with(panel: Panel) -> Self {
        let parameters = Parameters::REFERENCE;
        let (tick, queues) = Box::leak(Box::new(Queues::new())).split();
        Self {
            panel,
            sessions: vec![(Session::new(), Written::default())],
            queues,
            tick: FakeTick {
                queues: tick,
                motion: PlanFollower::default(),
                scale: SetpointScale::new(parameters.limits.rate_hz),
                now: Snapshot::default(),
                at_rest: 0,
                log: Vec::new(),
                worst_jump: 0.0,
                last_twist: [0.0; 3],
                config: Config::new(&parameters),
                refuses_settings: false,
            },
        }
    }

    /// Running, not referenced.
    pub fn new() -> Self {
        let mut bench = Self::cold();
        bench.run(2);
        bench
    }

    /// Referenced at the origin, settled.
    pub fn ready() -> Self {
        let mut bench = Self::new();
        assert_eq!(bench.say("FRF\n"), "");
        bench.run(2 * DWELL);
        assert_eq!(bench.say("ERR?\n"), "0\n");
        bench.tick.log.clear();
        bench
    }

    /// One more connection; its number.
    pub fn connect(&mut self) -> usize {
        self.sessions.push((Session::new(), Written::default()));
        self.service(self.sessions.len() - 1);
        self.sessions.len() - 1
    }

    pub fn service(&mut self, number: usize) {
        let (session, out) = &mut self.sessions[number];
        match self.panel.service(session, &mut self.queues, out) {
            Ok(()) => {}
        }
    }

    /// Services the first connection with another output.
    pub fn service_into<W: embedded_io::Write>(&mut self, out: &mut W) -> Result<(), W::Error> {
        self.panel
            .service(&mut self.sessions[0].0, &mut self.queues, out)
    }

    pub fn session(&mut self, number: usize) -> &mut Session {
        &mut self.sessions[number].0
    }

    /// Offers bytes to a connection, servicing it whenever it has no room; no tick runs. False when it takes no more.
    pub fn offer(&mut self, number: usize, mut bytes: &[u8]) -> bool {
        let mut refusals = 0;
        while refusals < 2 {
            let taken = self.session(number).receive(bytes);
            bytes = &bytes[taken..];
            self.service(number);
            if bytes.is_empty() {
                return true;
            }
            refusals = if taken == 0 { refusals + 1 } else { 0 };
        }
        false
    }

    /// A tick and a service of every connection, `ticks` times.
    pub fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick.run();
            for number in 0..self.sessions.len() {
                self.service(number);
            }
        }
    }

    /// Runs until the tick holds and is settled.
    pub fn run_to_rest(&mut self) {
        for _ in 0..1_000_000 {
            self.run(1);
            if self.say("\x05") == "0\n" {
                return;
            }
        }
        panic!("never at rest");
    }

    pub fn panel(&self) -> &Panel {
        &self.panel
    }

    pub fn panel_mut(&mut self) -> &mut Panel {
        &mut self.panel
    }

    /// What a connection has been answered since the last time.
    pub fn answers_of(&mut self, number: usize) -> Vec<u8> {
        core::mem::take(&mut self.sessions[number].1.0)
    }

    /// Sends to the first connection, runs three ticks (for what waits for one), and returns its answers.
    pub fn say(&mut self, bytes: &str) -> String {
        self.say_to(0, bytes)
    }

    pub fn say_to(&mut self, number: usize, bytes: &str) -> String {
        assert!(self.offer(number, bytes.as_bytes()), "no room");
        self.run(3);
        let answers = self.answers_of(number);
        answers.iter().map(|&byte| char::from(byte)).collect()
    }

    /// The number that a query of one axis answers.
    pub fn value(&mut self, query: &str) -> f64 {
        let answer = self.say(&format!("{query}\n"));
        let (_, number) = answer.trim_end().split_once('=').expect("one answer");
        number.parse().expect("a number")
    }

    /// The error after `bytes`, which are answered by nothing else.
    pub fn error_after(&mut self, bytes: &str) -> String {
        let answer = self.say(&format!("{bytes}\nERR?\n"));
        answer.trim_end().to_string()
    }
}

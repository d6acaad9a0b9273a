//! Runs a script under the watch.

use super::counts::Counts;
use super::limits_in_force::SpeedLimits;
use super::rule::{Breaches, Rule};
use super::script::{Script, Step};
use super::watch::Watch;
use crate::gcs_bench::{BenchBetween, reference_panel};
use crate::motion_bench::LIMITS;
use firmware::gcs::Session;
use firmware::mode::Mode;
use firmware::motion::Stop;
use firmware::queues::Queues;

/// What came of a script.
pub struct Outcome {
    pub breaches: Breaches,
    pub counts: Counts,
    /// The tick at which each line was sent.
    pub sent: Vec<u64>,
    /// The error that each line was answered by.
    pub errors: Vec<u16>,
}

/// Longest wait for rest, ticks.
const PATIENCE: u64 = 400_000;

/// Parameters that a script may set: whether targets are streamed, and limits of the pivots.
const STREAMED: &str = "0x19001900";
const PIVOT_RATE: &str = "0x54500106";
const PIVOT_ACCELERATION: &str = "0x54500107";

/// A stage that is referenced at the origin, and is sent a script.
struct Run<'q> {
    bench: BenchBetween<'q>,
    watch: Watch,
    /// Every `MOV` is the next target of a stream.
    streamed: bool,
}

/// Runs a script, and on until the stage has settled.
pub fn run(script: &Script) -> Outcome {
    let mut queues = Box::new(Queues::new());
    let mut bench = BenchBetween::new_between(reference_panel(), &mut queues);
    bench.run(2);
    bench.reference();
    let watch = Watch::new(&bench.tick);
    let mut run = Run {
        bench,
        watch,
        streamed: false,
    };
    let (mut sent, mut errors) = (Vec::new(), Vec::new());
    for step in script.steps() {
        sent.push(run.watch.counts.ticks);
        let mut error = 0;
        match step {
            Step::Pause(ticks) => (0..ticks).for_each(|_| run.tick()),
            Step::Settle => run.settle(),
            Step::Send(line) => error = run.send(line),
        }
        errors.push(error);
    }
    run.settle();
    Outcome {
        breaches: run.watch.breaches,
        counts: run.watch.counts,
        sent,
        errors,
    }
}

impl Run<'_> {
    fn tick(&mut self) {
        self.bench.run(1);
        self.watch.look(&self.bench.tick);
    }

    fn settle(&mut self) {
        let begun = self.watch.counts.ticks;
        // A line that has been carried out shows a tick later.
        self.tick();
        while !(self.bench.tick.now.settled && self.bench.tick.commands_waiting() == 0) {
            self.tick();
            let waited = self.watch.counts.ticks - begun;
            if waited > PATIENCE {
                let (waited, patience) = (waited as f64, PATIENCE as f64);
                self.watch.report(Rule::Rest, waited, patience, "ticks");
                return;
            }
        }
    }

    /// Sends a line on a connection of its own, so that the error is its own; the error.
    fn send(&mut self, line: &str) -> u16 {
        *self.bench.session(0) = Session::new();
        self.bench.service(0);
        self.announce(line);
        assert!(self.bench.offer(0, format!("{line}\n").as_bytes()));
        // A line waits while the tick has a command to take.
        while !self.bench.session(0).is_idle() {
            self.tick();
        }
        self.bench.answers_of(0);
        let error = self.bench.session(0).error().number();
        if error == 0 {
            self.follow(line);
        }
        error
    }

    /// What is to be known of a stop before it is sent: it is carried out at once.
    fn announce(&mut self, line: &str) {
        let stop = match line {
            "STP" => Stop::Urgent,
            "HLT" => Stop::Smooth,
            _ => return,
        };
        let waiting = self.bench.tick.commands_waiting();
        if self.bench.tick.now.mode == Mode::Moving || waiting > 0 {
            self.watch.commanded.await_stop(stop, waiting);
        }
    }

    /// What follows from a line that has been carried out.
    fn follow(&mut self, line: &str) {
        match line.split_once(' ') {
            Some(("SPA", values)) => self.set_parameter(values),
            Some(("WGO", _)) if line.ends_with(" 0") => {
                self.watch.commanded.await_stop(Stop::Smooth, 0)
            }
            Some(("WGO", _)) => self.watch.begin_motion(true, false),
            Some((word @ ("MOV" | "MVR" | "JOG"), _)) => {
                self.watch.begin_motion(self.streamed, word == "JOG");
            }
            Some(("VLS", speed)) => self.set_speed(speed.parse().expect("mm/s")),
            Some(("VEL", values)) => self.set_axis_speeds(values),
            _ => {}
        }
    }

    fn set_parameter(&mut self, values: &str) {
        let words: Vec<&str> = values.split_whitespace().collect();
        let ["1", parameter, value] = words[..] else {
            panic!("{values}: one parameter a line");
        };
        let value: f64 = value.parse().expect("a value");
        match parameter {
            STREAMED => self.streamed = value == 1.0,
            PIVOT_RATE => self.watch.pivot_limits.rate_rad_s = value,
            PIVOT_ACCELERATION => self.watch.pivot_limits.acceleration_rad_s2 = value,
            _ => panic!("{parameter}: not known to the watch"),
        }
    }

    /// Rotation goes down in proportion.
    fn set_speed(&mut self, mm_s: f64) {
        let part = mm_s / LIMITS.speed_mm_s;
        self.watch.set_limits(SpeedLimits {
            path: [mm_s, LIMITS.turn_speed_deg_s * part],
            ..self.watch.limits
        });
    }

    fn set_axis_speeds(&mut self, values: &str) {
        let mut axes = self.watch.limits.axes;
        let words: Vec<&str> = values.split_whitespace().collect();
        for pair in words.chunks(2) {
            let axis = ["X", "Y", "W"].iter().position(|axis| *axis == pair[0]);
            axes[axis.expect("an axis")] = pair[1].parse().expect("a velocity");
        }
        self.watch.set_limits(SpeedLimits {
            axes,
            ..self.watch.limits
        });
    }
}

//! `tripivot commission` on machines with something broken: refused at a step that names it, before anything has moved far.

use desk::commission::{Chosen, Done, Machine, Task, ZerosBy, run};
use desk::record::RecordError;
use hal_sim::front::{Host, Wiring};
use hal_sim::machine::devices::{EncoderFault, SettingsFlash};
use hal_sim::machine::unknown;
use std::cell::Cell;
use std::rc::Rc;
use tripivot::attended::SimulatedMachine;
use tripivot::person::hold;

/// Furthest way of a pivot and largest kinetic energy by the drives alone, until the rings have servos.
const MOST_WAY_RAD: f64 = 20e-3;
const MOST_ENERGY_J: f64 = 25e-3;
/// Steps in which nothing but known volts drives.
const BEFORE_SERVO: [&str; 4] = ["wiring", "hand", "nudges", "windings"];
/// Time for which the platform comes to rest after the person has let go of it, ticks.
const LET_GO_TICKS: u32 = 10_000;

/// What the drives have done, as the machine itself has it.
#[derive(Clone, Copy, Default)]
struct Driven {
    way_rad: f64,
    energy_j: f64,
    /// Where the pivots were before, and ticks for which nothing is looked at.
    from_rad: Option<[f64; 3]>,
    waits: u32,
    over: bool,
}

impl Driven {
    fn look(&mut self, host: &Host, in_hand: bool) {
        if in_hand {
            (self.from_rad, self.waits) = (None, LET_GO_TICKS);
        }
        if self.over || self.waits > 0 {
            self.waits = self.waits.saturating_sub(1);
            return;
        }
        let plant = &host.stage.plant;
        let now = plant.pivots_rad();
        let from = *self.from_rad.get_or_insert(now);
        let ways = [0, 1, 2].map(|i| (now[i] - from[i]).abs());
        self.way_rad = ways.into_iter().fold(self.way_rad, f64::max);
        self.energy_j = self.energy_j.max(plant.kinetic_energy_j());
    }
}

/// Commissions machine 1 with a defect until a step fails, and checks what the drives did.
fn commissioned(mut defect: impl FnMut(&mut Host) + 'static) -> Vec<Done> {
    let driven = Rc::new(Cell::new(Driven::default()));
    let watched = driven.clone();
    let mut machine = SimulatedMachine::watched(
        &unknown(1),
        SettingsFlash::in_memory(),
        Some(Box::new(move |host, in_hand| {
            defect(host);
            let mut now = watched.get();
            now.look(host, in_hand);
            watched.set(now);
        })),
    );
    let ran = run(&mut machine, &Chosen::all(ZerosBy::Jig), &mut |done| {
        if !BEFORE_SERVO[..3].contains(&done.step.name) {
            let now = driven.get();
            driven.set(Driven { over: true, ..now });
        }
    });
    let Driven {
        way_rad, energy_j, ..
    } = driven.get();
    println!(
        "by the drives: {:.2} mrad, {:.3} mJ",
        way_rad * 1e3,
        energy_j * 1e3
    );
    assert!(way_rad < MOST_WAY_RAD && energy_j < MOST_ENERGY_J);
    ran.unwrap_or_else(|error| panic!("{error}")).done
}

/// Fails at a step, and says what.
fn is_refused(all: &[Done], step: &str, says: &str) {
    let last = all.last().expect("a step");
    let failure = last.failure.as_ref();
    let what = failure.map_or("nothing", |failure| &failure.what);
    println!("{}: {what}", last.step.name);
    assert!(
        last.step.name == step && what.contains(says),
        "{}: {what}",
        last.step.name
    );
    assert!(failure.is_some_and(|failure| !failure.advice.is_empty()));
}

#[test]
fn a_lead_that_is_off_is_refused_by_the_nudges() {
    let all = commissioned(|host| host.wiring[1] = Wiring::Open);
    is_refused(&all, "nudges", "bridge 2 moves nothing");
}

#[test]
fn a_bridge_that_is_dead_is_refused_by_the_nudges() {
    let all = commissioned(|host| host.bridges[2].set_fault(true));
    is_refused(&all, "nudges", "bridge reports a fault, pivot 3");
}

#[test]
fn an_encoder_that_is_dead_is_refused_by_the_wiring() {
    let port = unknown(1).wiring.port_of_ring[0] + 1;
    let all = commissioned(|host| host.stage.encoders[0].set_fault(EncoderFault::StuckHigh));
    is_refused(&all, "wiring", &format!("encoder at port {port}"));
}

#[test]
fn an_encoder_whose_coupling_slips_is_refused_when_it_is_turned_by_hand() {
    let port = unknown(1).wiring.port_of_ring[2] + 1;
    let mut start = None;
    let all = commissioned(move |host| {
        let now = host.stage.plant.pivots_rad()[2];
        let turned = now - *start.get_or_insert(now);
        host.stage.encoders[2].set_offset(-0.6 * turned);
    });
    is_refused(&all, "hand", &format!("encoder at port {port} has turned"));
}

#[test]
fn a_jig_that_has_been_forgotten_is_refused_before_a_servo_works_against_it() {
    let mut before = None;
    let mut is_in = false;
    let all = commissioned(move |host| {
        let plant = &mut host.stage.plant;
        let pose = plant.pose();
        // No motor and no hand moves it by a millimetre within a tick.
        let [x_m, y_m, _] = before.replace(pose).unwrap_or(pose);
        is_in |= (pose[0] - x_m).hypot(pose[1] - y_m) > 1e-3;
        if is_in {
            plant.set_external(hold(plant));
        }
    });
    is_refused(&all, "zeros", "the jig is in");
}

/// Another client stops every nudge that looks whether the jig is out.
struct StoppedByAnother {
    machine: SimulatedMachine,
    comes_out: bool,
}

impl Machine for StoppedByAnother {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        let answer = self.machine.ask(line);
        if self.comes_out && line.starts_with("EXC RAMP") {
            self.machine.ask("STP")?;
        }
        answer
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.machine.delay(seconds)
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        self.comes_out |= task == Task::TakeOutJig;
        self.machine.request(task)
    }

    fn scale_periods(&self) -> Option<u32> {
        self.machine.scale_periods()
    }
}

#[test]
fn a_nudge_that_another_client_stops_is_no_jig() {
    let mut stopped = StoppedByAnother {
        machine: SimulatedMachine::new(&unknown(1), SettingsFlash::in_memory()),
        comes_out: false,
    };
    let ran = run(&mut stopped, &Chosen::all(ZerosBy::Jig), &mut |_| ());
    let all = ran.unwrap_or_else(|error| panic!("{error}")).done;
    is_refused(
        &all,
        "zeros",
        "a nudge to see whether the jig is out has ended by",
    );
}

/// Nobody is beside it, and it does not bring back what it keeps.
struct Alone(SimulatedMachine);

impl Machine for Alone {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        if line == "RPA" {
            return Err(RecordError::Refused {
                line: line.to_owned(),
                code: 4011,
                hint: "",
            });
        }
        self.0.ask(line)
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.0.delay(seconds)
    }

    fn request(&mut self, _: Task) -> Result<(), RecordError> {
        Err(RecordError::Broken {
            place: "the keyboard".to_owned(),
            error: std::io::Error::other("closed"),
        })
    }
}

#[test]
fn a_run_that_nobody_answers_says_what_it_leaves() {
    let mut alone = Alone(SimulatedMachine::new(
        &unknown(1),
        SettingsFlash::in_memory(),
    ));
    let ran = run(&mut alone, &Chosen::all(ZerosBy::Jig), &mut |_| ());
    let told = ran.err().expect("nobody").to_string();
    println!("{told}");
    assert!(told.contains("the keyboard broke down: closed"), "{told}");
    assert!(
        told.contains("what is kept is not in force again"),
        "{told}"
    );
    assert!(told.contains("refused `RPA`"), "{told}");
}

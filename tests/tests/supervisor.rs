//! The supervisor's table, line by line: every event in every state, through the tick, with the simulated machine behind it.
//! What is expected is written here once more, and not read from the table: a change of the table fails until it is made here too.

use firmware::control::config::Config;
use firmware::control::excitation::{
    Excitation, ExcitationGuards, ExcitationSignal, ExcitationUntil,
};
use firmware::control::{Event, MODES, Outcome, TRANSITIONS};
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::motion::{
    AxisState, Constraints, Plan, PlanStart, RotationCentre, Stop, plan_line, plan_stop,
};
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Queues, Snapshot, TickQueues};
use hal_sim::front::Host;
use hal_sim::machine::devices::{EncoderFault, StageParameters};

/// Ticks in which a command is taken and told.
const SOON: u32 = 4;
/// Ticks in which bridges wake up and leads are tested, and commands wait.
const WAKING: u32 = 61;
/// Ticks of any of the motions here.
const LONG: u32 = 20_000;

/// What every event does in every state, in the order of the columns: off, holding, moving, stopping, fault, exciting.
#[rustfmt::skip]
const EXPECTED: [(Event, [Outcome; 6]); 14] = {
    use Mode::{Exciting, Fault, Holding, Moving, Off, Stopping};
    use Outcome::{If, Nothing, Refused, To};
    [
        //              off           holding      moving        stopping   fault      exciting
        (Event::Reference,     [If(Holding),  To(Holding), To(Moving),   Refused,   Refused,   Refused]),
        (Event::ServoOn,       [If(Holding),  To(Holding), To(Moving),   Refused,   Refused,   Refused]),
        (Event::ServoOff,      [To(Off),      To(Off),     To(Off),      Refused,   Refused,   To(Off)]),
        (Event::Move,          [Refused,      If(Moving),  If(Moving),   Refused,   Refused,   Refused]),
        (Event::Centre,        [To(Off),      To(Holding), Refused,      Refused,   Refused,   Refused]),
        (Event::Constants,     [To(Off),      To(Holding), Refused,      Refused,   To(Fault), Refused]),
        (Event::Mounting,      [To(Off),      Refused,     Refused,      Refused,   To(Fault), Refused]),
        (Event::Excite,        [If(Exciting), If(Holding), If(Moving),   Refused,   Refused,   Refused]),
        (Event::EndExcitation, [To(Off),      To(Holding), To(Moving),   Nothing,   Nothing,   To(Exciting)]),
        (Event::Acknowledge,   [Nothing,      Nothing,     Nothing,      Refused,   If(Off),   Nothing]),
        (Event::AtRest,        [Nothing,      Nothing,     To(Holding),  To(Fault), Nothing,   To(Off)]),
        (Event::StopFault,     [To(Fault),    To(Fault),   To(Stopping), Nothing,   Nothing,   To(Fault)]),
        (Event::BrakeFault,    [To(Fault),    To(Fault),   To(Fault),    To(Fault), Nothing,   To(Fault)]),
        (Event::CoastFault,    [Nothing,      To(Fault),   To(Fault),    To(Fault), Nothing,   To(Fault)]),
    ]
};
const COLUMNS: [Mode; 6] = [
    Mode::Off,
    Mode::Holding,
    Mode::Moving,
    Mode::Stopping,
    Mode::Fault,
    Mode::Exciting,
];

struct Run {
    host: Host,
    tick_queues: TickQueues<'static>,
    commands: CommandQueues<'static>,
    plan: Option<Plan>,
    now: Snapshot,
}

impl Run {
    fn new() -> Self {
        let (tick_queues, commands) = Box::leak(Box::new(Queues::new())).split();
        let mut run = Self {
            host: Host::new(&StageParameters::REFERENCE, &Parameters::REFERENCE),
            tick_queues,
            commands,
            plan: None,
            now: Snapshot::default(),
        };
        run.ticks(10);
        run
    }

    fn ticks(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.host.tick(&mut self.tick_queues, &mut ());
            if let Some(now) = self.commands.snapshot() {
                self.now = now;
            }
        }
    }

    fn command(&mut self, command: Command) {
        let slept = self.now.mode == Mode::Off;
        self.commands.send(command).expect("room");
        self.ticks(SOON);
        if slept && self.now.mode != Mode::Off {
            self.ticks(WAKING);
        }
    }

    fn follow(&mut self, plan: &Plan) {
        let command = self.commands.hand_over(plan).expect("a slot");
        self.command(command);
    }

    /// A line of 60 mm from where it stands.
    fn line(&self) -> Plan {
        let parameters = Parameters::REFERENCE;
        let ground = Constraints::new(parameters.limits, parameters.geometry);
        let from = self.now.setpoint;
        let to = [from[0] + (6 << 32) / 10, from[1], from[2]];
        plan_line(self.now.plan + 1, from, to, &ground).expect("inside the disk")
    }

    /// In a state; referenced in all of them.
    fn in_state(state: Mode) -> Self {
        let mut run = Self::new();
        run.command(Command::Reference);
        match state {
            Mode::Off => run.command(Command::Servo(false)),
            Mode::Holding => {}
            Mode::Moving | Mode::Stopping => {
                let line = run.line();
                run.follow(&line);
                run.plan = Some(line);
                run.ticks(2_000);
            }
            Mode::Fault => {
                run.host.emergency_stop = true;
                run.ticks(1);
                run.host.emergency_stop = false;
                run.ticks(SOON);
            }
            Mode::Exciting => {
                run.command(Command::Servo(false));
                run.command(Command::Excite(excitation(LONG / 2)));
            }
        }
        if state == Mode::Stopping {
            run.host.stage.encoders[0].set_fault(EncoderFault::StuckHigh);
            run.ticks(10);
        }
        assert_eq!(run.now.mode, state);
        run
    }

    /// A plan that starts where the motion is or will be.
    fn next_plan(&self) -> Plan {
        let Some(plan) = self.plan.as_ref().filter(|_| self.now.mode == Mode::Moving) else {
            return self.line();
        };
        let parameters = Parameters::REFERENCE;
        let ground = Constraints::new(parameters.limits, parameters.geometry);
        let PlanStart::Rest(from) = plan.start else {
            panic!("a line starts at rest")
        };
        let axes = from.map(AxisState::at_rest);
        let at = self.now.plan_tick + 20;
        plan_stop(plan.id + 1, plan, &axes, at, &ground, Stop::Urgent).expect("there is a stop")
    }

    fn happens(&mut self, event: Event) {
        let mut wanted = Parameters::REFERENCE;
        match event {
            Event::Reference => self.command(Command::Reference),
            Event::ServoOn => self.command(Command::Servo(true)),
            Event::ServoOff => self.command(Command::Servo(false)),
            Event::Move => self.follow(&self.next_plan()),
            Event::Centre => {
                let centre = RotationCentre::new([0.2, 0.1]).expect("near enough");
                self.command(Command::Centre(centre));
            }
            Event::Constants => {
                wanted.servo.gains[0].position_1_s += 1.0;
                self.command(Command::Configure(Config::new(&wanted)));
            }
            Event::Mounting => {
                wanted.encoders[1].zero_counts += 1;
                self.command(Command::Configure(Config::new(&wanted)));
            }
            Event::Excite => self.command(Command::Excite(excitation(LONG / 2))),
            Event::EndExcitation => self.command(Command::EndExcitation),
            Event::Acknowledge => self.command(Command::Acknowledge),
            Event::AtRest => self.ticks(LONG),
            Event::StopFault => {
                self.host.late = true;
                self.ticks(12);
                self.host.late = false;
            }
            Event::BrakeFault => {
                self.host.emergency_stop = true;
                self.ticks(SOON);
                self.host.emergency_stop = false;
            }
            Event::CoastFault => {
                self.host.bridges[2].set_fault(true);
                self.ticks(SOON);
                self.host.bridges[2].set_fault(false);
            }
        }
    }
}

/// A voltage that moves nothing.
fn excitation(ticks: u32) -> Excitation {
    Excitation {
        pivot: 1,
        signal: ExcitationSignal::Volts {
            start: 0.1,
            per_tick: 0.0,
        },
        ticks,
        until: ExcitationUntil::TIME,
        guards: ExcitationGuards::new(&Parameters::REFERENCE),
    }
}

#[test]
fn the_table_is_what_is_expected() {
    assert_eq!(MODES, COLUMNS);
    for (row, expected) in TRANSITIONS.into_iter().zip(EXPECTED) {
        assert_eq!(row, expected);
    }
}

#[test]
fn every_event_does_in_every_state_what_is_expected() {
    for (event, outcomes) in EXPECTED {
        for (state, outcome) in COLUMNS.into_iter().zip(outcomes) {
            let mut run = Run::in_state(state);
            let (before, fault) = (run.now.refused, run.now.fault);
            run.happens(event);
            let (mode, refused) = match outcome {
                Outcome::To(mode) | Outcome::If(mode) => (mode, 0),
                Outcome::Refused => (state, 1),
                Outcome::Nothing => (state, 0),
            };
            assert_eq!(
                (run.now.mode, run.now.refused - before),
                (mode, refused),
                "{event:?} in {state:?}"
            );
            if fault.is_some() && event != Event::Acknowledge {
                assert_eq!(run.now.fault, fault, "{event:?}: the first one stays");
            }
            let faulted = matches!(run.now.mode, Mode::Fault | Mode::Stopping);
            assert_eq!(run.now.fault.is_some(), faulted, "{event:?} in {state:?}");
        }
    }
}

/// Whatever becomes of a plan, its slot or another comes back: there is room for the next.
#[test]
fn every_plan_leaves_room_for_the_next_in_every_state() {
    for state in COLUMNS {
        let mut run = Run::in_state(state);
        let (line, before) = (run.line(), run.now.refused);
        for _ in 0..4 {
            run.follow(&line);
        }
        // The first, where there is rest; the others start where the stage no longer is.
        let taken = u32::from(state == Mode::Holding);
        assert_eq!(run.now.refused - before, 4 - taken, "{state:?}");
    }
}

/// What is refused where the stage is not such that it can be had.
#[test]
fn what_needs_something_is_refused_without_it() {
    let mut seen = Vec::new();
    let mut refuses = |mut run: Run, event: Event| {
        seen.push((event, run.now.mode));
        let (state, before) = (run.now.mode, run.now.refused);
        run.happens(event);
        assert_eq!((run.now.mode, run.now.refused), (state, before + 1));
    };
    refuses(Run::new(), Event::ServoOn);
    let mut silent = Run::new();
    silent.host.stage.encoders[1].set_fault(EncoderFault::StuckLow);
    silent.ticks(20);
    refuses(silent, Event::Reference);
    for state in [Mode::Holding, Mode::Moving] {
        let mut run = Run::in_state(state);
        // A plan that starts elsewhere.
        run.now.setpoint[0] += 1;
        run.plan = None;
        refuses(run, Event::Move);
    }
    for state in [Mode::Off, Mode::Holding, Mode::Moving] {
        // Off and not referenced: an encoder that is lost is no fault then.
        let mut run = match state {
            Mode::Off => Run::new(),
            _ => Run::in_state(state),
        };
        match state {
            // An encoder that does not answer.
            Mode::Off => run.host.stage.encoders[1].set_fault(EncoderFault::StuckLow),
            // One under way.
            _ => run.command(Command::Excite(excitation(LONG))),
        }
        run.ticks(10);
        refuses(run, Event::Excite);
    }
    // What only another start can find gone.
    let mut damaged = Run::new();
    (damaged.host).restart(
        &Parameters::REFERENCE,
        Some(FaultKind::ImageDamaged),
        [0.0; 3],
    );
    damaged.ticks(SOON);
    refuses(damaged, Event::Acknowledge);
    let conditional: Vec<_> = (EXPECTED.into_iter())
        .flat_map(|(event, outcomes)| {
            let columns = COLUMNS.into_iter().zip(outcomes);
            columns.filter_map(move |(state, outcome)| {
                matches!(outcome, Outcome::If(_)).then_some((event, state))
            })
        })
        .collect();
    seen.sort_by_key(|(event, _)| *event as usize);
    assert_eq!(seen, conditional, "all that is conditional");
}

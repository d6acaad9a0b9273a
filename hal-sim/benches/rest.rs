//! How quiet the stage is at rest, second by second, as a table: `cargo bench -p hal-sim --bench rest`.
//!
//! Each machine is referenced, moved by some mm and left alone. After a second at rest every tick of the plant's true pose is looked
//! at. `SECONDS=600` is ten minutes, the form that is published; without it it is 20 s.

use firmware::control::SubdivisionTable;
use firmware::motion::{Constraints, plan_line};
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Queues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use parallel::{cores, of_all};

const TICKS_A_SECOND: u64 = 20_000;
const UNIT: f64 = 4_294_967_296.0;
const UNITS_PER_LSB: f64 = 64.0;

/// A machine, and what the encoders are.
#[derive(Clone, Copy)]
struct Case {
    /// Without most of what a workshop leaves in a machine.
    is_kind: bool,
    mismatch_percent: f64,
    payload_kg: f64,
    backlash_urad: f64,
    noise_nrad: f64,
}

/// A machine's ten minutes.
struct Quiet {
    /// Root mean square about the mean of all seconds, nm and nrad.
    all: [f64; 2],
    /// The same of the median and the worst second, each about its own mean.
    median: [f64; 2],
    worst: [f64; 2],
    /// Pivots, LSB: rms, and the largest error.
    pivots: [f64; 2],
    /// Duty about its mean, % rms.
    duty: f64,
    /// Share of the ticks in which the stage was not told as settled, %.
    lost: f64,
}

fn main() {
    let seconds =
        std::env::var("SECONDS").map_or(20, |text| text.parse().expect("a number of seconds"));
    let cases = cases();
    let rows = of_all(&cases, cores(), |case| row(case, &watch(case, seconds)));
    println!(
        "{seconds} s at rest, after a second of settling. Position and theta are the plant's own."
    );
    println!();
    println!(
        "| machine | load, kg | backlash, urad | encoder noise, nrad | position, nm rms: all / median second / worst second | theta, nrad rms | pivots, LSB rms / peak | duty, % rms | not settled, % of the time |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for row in rows {
        println!("{row}");
    }
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (backlash_urad, noise_nrad) in [(0.3, 30.0), (2.0, 30.0), (0.3, 200.0)] {
        for payload_kg in [0.0, 5.0] {
            for mismatch_percent in [0.0, 10.0, -10.0, 20.0, -20.0, 30.0, -30.0] {
                cases.push(Case {
                    is_kind: true,
                    mismatch_percent,
                    payload_kg,
                    backlash_urad,
                    noise_nrad,
                });
            }
        }
    }
    for noise_nrad in [30.0, 200.0] {
        for payload_kg in [0.0, 5.0] {
            cases.push(Case {
                is_kind: false,
                mismatch_percent: 0.0,
                payload_kg,
                backlash_urad: 0.3,
                noise_nrad,
            });
        }
    }
    if let Ok(only) = std::env::var("ONLY") {
        let one = only.parse::<usize>().expect("a case's number");
        cases = vec![cases[one]];
    }
    cases
}

fn row(case: &Case, quiet: &Quiet) -> String {
    let three = |k: usize| {
        format!(
            "{:.2} / {:.2} / {:.2}",
            quiet.all[k], quiet.median[k], quiet.worst[k]
        )
    };
    format!(
        "| {} | {} | {} | {} | {} | {} | {:.2} / {:.1} | {:.3} | {:.2} |",
        if case.is_kind {
            format!("kind, {} % off", case.mismatch_percent)
        } else {
            "reference stage".to_owned()
        },
        case.payload_kg,
        case.backlash_urad,
        case.noise_nrad,
        three(0),
        three(1),
        quiet.pivots[0],
        quiet.pivots[1],
        quiet.duty,
        quiet.lost
    )
}

/// Sums of a variable, about its first value.
#[derive(Clone, Copy, Default)]
struct Spread {
    first: Option<f64>,
    count: f64,
    sum: f64,
    squares: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        let off = value - *self.first.get_or_insert(value);
        self.count += 1.0;
        self.sum += off;
        self.squares += off * off;
    }

    fn variance(&self) -> f64 {
        let mean = self.sum / self.count;
        (self.squares / self.count - mean * mean).max(0.0)
    }
}

fn stage(case: &Case) -> (StageParameters, Parameters) {
    let options = RunOptions {
        mismatch_percent: case.mismatch_percent,
        payload_kg: case.payload_kg,
        ..if case.is_kind {
            RunOptions::default()
        } else {
            RunOptions::reference()
        }
    };
    let mut stage = stage_parameters(&options);
    stage.plant.backlash_rad = case.backlash_urad * 1e-6;
    for encoder in &mut stage.encoders {
        encoder.noise_rad = case.noise_nrad * 1e-9;
    }
    (stage, controller_parameters(&options))
}

fn watch(case: &Case, seconds: u64) -> Quiet {
    let (stage, parameters) = stage(case);
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut host = Host::new(&stage, &parameters);
    let mut record = TickRecord::default();
    let mut settled = false;
    let mut tick = |host: &mut Host, record: &mut TickRecord, commands: &mut CommandQueues<'_>| {
        host.tick(&mut tick_queues, record);
        assert_eq!(host.fault(), None);
        if let Some(snapshot) = commands.snapshot() {
            settled = snapshot.settled;
        }
        settled
    };
    for _ in 0..20 {
        tick(&mut host, &mut record, &mut commands);
    }
    let tables = (parameters.subdivision.each_ref()).map(SubdivisionTable::new);
    assert!(commands.send(Command::Subdivide(tables)).is_ok(), "room");
    tick(&mut host, &mut record, &mut commands);
    assert!(commands.send(Command::Reference).is_ok(), "room");
    tick(&mut host, &mut record, &mut commands);
    for _ in 0..4_000 {
        tick(&mut host, &mut record, &mut commands);
    }
    let from = record
        .sample
        .as_ref()
        .expect("a tick has run")
        .reference_point
        .position;
    let to = [
        from[0] + (0.2 * UNIT) as i64,
        from[1] - (0.1 * UNIT) as i64,
        from[2] + (0.1 * UNIT) as i64,
    ];
    let constraints = Constraints::new(parameters.limits, parameters.geometry);
    let plan = plan_line(1, from, to, &constraints).expect("inside the disk");
    let ticks = plan.ticks();
    assert!(commands.send_plan(&plan).is_ok(), "room");
    tick(&mut host, &mut record, &mut commands);
    for _ in 0..ticks + TICKS_A_SECOND {
        tick(&mut host, &mut record, &mut commands);
    }
    let (mut all, mut by_second) = ([Spread::default(); 3], Vec::new());
    let (mut square, mut peak, mut lost) = (0.0, 0.0_f64, 0_u64);
    let mut duties = [Spread::default(); 3];
    for _ in 0..seconds {
        let mut second = [Spread::default(); 3];
        for _ in 0..TICKS_A_SECOND {
            lost += u64::from(!tick(&mut host, &mut record, &mut commands));
            let pose = host.stage.plant.pose();
            let sample = record.sample.as_ref().expect("a tick has run");
            for i in 0..3 {
                all[i].add(pose[i]);
                second[i].add(pose[i]);
                duties[i].add(f64::from(sample.duty[i].0));
                let error =
                    (sample.pivots[i] - sample.pivot_setpoints[i]).units() as f64 / UNITS_PER_LSB;
                square += error * error;
                peak = peak.max(error.abs());
            }
        }
        by_second.push(nano(&second));
    }
    let ticks = (seconds * TICKS_A_SECOND) as f64;
    let sorted = |k: usize| {
        let mut values: Vec<f64> = by_second.iter().map(|second| second[k]).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let (way, turn) = (sorted(0), sorted(1));
    Quiet {
        all: nano(&all),
        median: [way[way.len() / 2], turn[turn.len() / 2]],
        worst: [way[way.len() - 1], turn[turn.len() - 1]],
        pivots: [(square / 3.0 / ticks).sqrt(), peak],
        duty: (duties.iter().map(Spread::variance).sum::<f64>() / 3.0).sqrt()
            / f64::from(parameters.power.pwm_counts)
            * 100.0,
        lost: lost as f64 / ticks * 100.0,
    }
}

/// Root mean square of position and theta, in nm and nrad.
fn nano([x, y, theta]: &[Spread; 3]) -> [f64; 2] {
    [
        (x.variance() + y.variance()).sqrt() * 1e9,
        theta.variance().sqrt() * 1e9,
    ]
}

//! A sine on an encoder of a stage that turns slowly, frequency by frequency; a push on one at rest.

use super::matrix::Complex;
use firmware::control::SubdivisionTable;
use firmware::motion::{Constraints, plan_line};
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Queues, TickQueues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::External;
use hal_sim::rig::observer::TickRecord;
use std::f64::consts::TAU;

const RATE_HZ: f64 = 20_000.0;
const UNIT: f64 = 4_294_967_296.0;
const UNITS_PER_LSB: f64 = 64.0;
const LSB_RAD: f64 = TAU / 67_108_864.0;
/// Amplitude of the sine, rad.
const SINE_RAD: f64 = 2e-6;

/// Frequencies that are measured one after the other.
pub struct Sweep {
    from_hz: f64,
    to_hz: f64,
    /// From one to the next.
    ratio: f64,
    /// Ticks before and while a sine is measured: whole periods of it, at least these.
    settle_ticks: u64,
    sine_ticks: f64,
}

/// All that a loop does. Meanwhile the stage turns by 150 deg.
pub const WIDE: Sweep = Sweep {
    from_hz: 20.0,
    to_hz: 3_000.0,
    ratio: 1.04,
    settle_ticks: 2_000,
    sine_ticks: 4_000.0,
};
/// Where |S| is largest, while the stage turns by 25 deg: what the guides' directions are is nearly the same all the time.
pub const AROUND_MS: Sweep = Sweep {
    from_hz: 80.0,
    to_hz: 1_600.0,
    ratio: 1.08,
    settle_ticks: 1_000,
    sine_ticks: 2_000.0,
};

/// What a sine on a pivot's encoder makes of all errors, frequency by frequency.
pub fn columns(
    stage: &StageParameters,
    parameters: &Parameters,
    place_mm: [f64; 2],
    pivot: usize,
    sweep: &Sweep,
) -> Vec<(f64, [Complex; 3])> {
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut bench = Bench::at(stage, parameters, place_mm, &mut tick_queues);
    let from = bench.referenced(&mut commands);
    let to = [
        from[0],
        from[1],
        from[2] + (60.0 / 360.0 * 60.0 * UNIT) as i64,
    ];
    let constraints = Constraints::new(parameters.limits, parameters.geometry);
    let plan = plan_line(1, from, to, &constraints).expect("in place");
    assert!(commands.send_plan(&plan).is_ok(), "room");
    bench.run(20_000);
    let mut columns = Vec::new();
    let mut hz = sweep.from_hz;
    while hz < sweep.to_hz {
        // Whole periods.
        let periods = (sweep.sine_ticks * hz / RATE_HZ).ceil();
        let ticks = (periods * RATE_HZ / hz).round();
        let exact_hz = periods * RATE_HZ / ticks;
        let column = bench.column(pivot, exact_hz, sweep.settle_ticks, ticks as u64);
        columns.push((exact_hz, column));
        hz *= sweep.ratio;
    }
    columns
}

/// Peak and the time after which the error stays within 2.5 LSB, of the mean over a millisecond.
pub fn push(stage: &StageParameters, parameters: &Parameters, place_mm: [f64; 2]) -> String {
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut bench = Bench::at(stage, parameters, place_mm, &mut tick_queues);
    bench.referenced(&mut commands);
    bench.run(60_000);
    bench.host.stage.plant.set_external(External {
        ring_torque_n_m: [1.0, 0.0, 0.0],
        ..External::default()
    });
    let (mut peak, mut outside) = (0.0_f64, 0);
    let mut last = std::collections::VecDeque::from([0.0; 20]);
    for tick in 1..=6_000 {
        bench.tick();
        let error = bench.error_lsb(0);
        peak = peak.max(error.abs());
        last.pop_front();
        last.push_back(error);
        if (last.iter().sum::<f64>() / 20.0).abs() > 2.5 {
            outside = tick;
        }
    }
    format!("{peak:.0}, {:.1}", f64::from(outside) / RATE_HZ * 1e3)
}

struct Bench<'a, 'q> {
    host: Host,
    record: TickRecord,
    /// Errors of the encoders within a period of their scales, as the controller is told.
    tables: [SubdivisionTable; 3],
    queues: &'a mut TickQueues<'q>,
}

impl<'a, 'q> Bench<'a, 'q> {
    fn at(
        stage: &StageParameters,
        parameters: &Parameters,
        [x_mm, y_mm]: [f64; 2],
        queues: &'a mut TickQueues<'q>,
    ) -> Self {
        let mut host = Host::new(stage, parameters);
        (host.stage).set_pose_at_rest([x_mm * 1e-3, y_mm * 1e-3, 0.0]);
        Self {
            host,
            record: TickRecord::default(),
            tables: (parameters.subdivision.each_ref()).map(SubdivisionTable::new),
            queues,
        }
    }

    fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    fn tick(&mut self) {
        self.host.tick(self.queues, &mut self.record);
        assert!(self.host.fault().is_none(), "{:?}", self.host.fault());
    }

    fn referenced(&mut self, commands: &mut CommandQueues<'_>) -> [i64; 3] {
        self.run(20);
        let tables = Command::Subdivide(self.tables);
        assert!(commands.send(tables).is_ok(), "room");
        self.run(20);
        assert!(commands.send(Command::Reference).is_ok(), "room");
        self.run(2_000);
        self.record
            .sample
            .as_ref()
            .expect("a tick has run")
            .reference_point
            .position
    }

    /// Following error of a pivot, LSB.
    fn error_lsb(&self, pivot: usize) -> f64 {
        let sample = self.record.sample.as_ref().expect("a tick has run");
        (sample.pivots[pivot] - sample.pivot_setpoints[pivot]).units() as f64 / UNITS_PER_LSB
    }

    fn column(&mut self, pivot: usize, hz: f64, settle_ticks: u64, ticks: u64) -> [Complex; 3] {
        let mut sums = [[0.0; 2]; 3];
        for tick in 0..settle_ticks + ticks {
            // What is set now is latched later in this period and read by the next tick.
            let phase = TAU * hz * tick as f64 / RATE_HZ;
            self.host.stage.encoders[pivot].set_offset(SINE_RAD * phase.sin());
            if let Some(measured) = tick.checked_sub(settle_ticks) {
                // Read in this tick's sample: what was set a tick ago. The sample shown is the tick's before, so its offset was set two
                // ticks ago.
                let shown = phase - 2.0 * TAU * hz / RATE_HZ;
                // Ripple is near, and no whole number of its periods: rising and falling weights keep it out.
                let weight = 1.0 - (TAU * measured as f64 / ticks as f64).cos();
                for (i, [sine, cosine]) in sums.iter_mut().enumerate() {
                    let error = weight * self.error_lsb(i) * LSB_RAD;
                    *sine += error * shown.sin();
                    *cosine += error * shown.cos();
                }
            }
            self.tick();
        }
        self.host.stage.encoders[pivot].set_offset(0.0);
        sums.map(|sum| sum.map(|sum| sum * 2.0 / ticks as f64 / SINE_RAD))
    }
}

//! Looks at every tick of a run: turns what the controller and the plant know into the report's samples and moves.

use crate::report::{MotionSample, Move, Sample, Trace};
use firmware::mode::Mode;
use firmware::motion::Position;
use firmware::parameters::Parameters;
use firmware::recorder::{RunningHash, Sample as TickSample, ServoSamples, TickObserver};
use kinematics::{Pose, direct_rates, inverse};
use std::f64::consts::{PI, TAU};

const TURN: f64 = 4_294_967_296.0;
/// Units of angle in an encoder count.
const PER_COUNT: f64 = 64.0;

/// The last tick's sample and the running hash over all of them, out of the tick.
#[derive(Clone, Debug, Default)]
pub struct TickRecord {
    /// What the tick offered.
    pub sample: Option<TickSample>,
    /// Hash of everything so far.
    pub hash: RunningHash,
}

impl TickObserver for TickRecord {
    fn observe(&mut self, sample: &TickSample) {
        self.hash.observe(sample);
        self.sample = Some(sample.clone());
    }
}

/// Collects trace and moves.
pub struct Observer {
    /// The trace.
    pub trace: Trace,
    /// The moves so far.
    pub moves: Vec<Move>,
    radius_mm: f64,
    period_s: f64,
    window_counts: f64,
    pwm_counts: f64,
    /// Dead time's knee of each drive, A.
    knees_a: [f64; 3],
    servos: ServoSamples,
    under_way: Option<f64>,
    /// Accelerations of the moved point (mm, deg) and rates of the pivots at the last tick: what follows from them is a
    /// difference.
    last: ([f64; 3], [f64; 3]),
}

impl Observer {
    /// For a stage of these parameters, keeping every `every`-th tick as a row.
    #[must_use]
    pub fn new(parameters: &Parameters, every: u32) -> Self {
        Self {
            trace: Trace::new(every),
            moves: Vec::new(),
            radius_mm: parameters.geometry.radius_mm,
            period_s: 1.0 / parameters.limits.rate_hz,
            // The half lets a setpoint between two counts be met; the controller's own window has it too.
            window_counts: parameters.window.counts + 0.5,
            pwm_counts: f64::from(parameters.power.pwm_counts),
            knees_a: (parameters.drives.each_ref()).map(|drive| drive.dead_time_knee_a),
            servos: ServoSamples::default(),
            under_way: None,
            last: Default::default(),
        }
    }

    /// Takes a tick with the plant's true pose (m, m, rad) at the encoders' latch. Ticks before referencing hold no setpoint
    /// and are left out.
    pub fn look(&mut self, tick: &TickSample, pose: [f64; 3]) {
        self.servos.update(tick);
        if !matches!(tick.mode, Mode::Holding | Mode::Moving) {
            return;
        }
        let sample = self.sample(tick, pose);
        self.follow_move(&sample, &tick.setpoint.position);
        self.trace.record(&sample);
    }

    fn sample(&mut self, tick: &TickSample, pose: [f64; 3]) -> Sample {
        let [x, y, turns] = tick.setpoint.position.map(|units| units as f64 / TURN);
        let setpoint = [x * self.radius_mm, y * self.radius_mm, turns * 360.0];
        let (true_mm, true_rad) = ([pose[0] * 1e3, pose[1] * 1e3], pose[2]);
        let twist = &tick.setpoint.twist;
        let pivots = tick.pivot_setpoints.map(|angle| angle.units() as f64);
        let servos = [0, 1, 2].map(|pivot| self.servos.of(pivot));
        let learnt = |weight: usize| servos.map(|servo| f64::from(servo.weights[weight]));
        Sample {
            time_s: tick.tick as f64 * self.period_s,
            moving: tick.mode == Mode::Moving,
            setpoint,
            setpoint_rate: [
                f64::from(twist.x) * self.radius_mm,
                f64::from(twist.y) * self.radius_mm,
                f64::from(twist.theta).to_degrees(),
            ],
            pose: [true_mm[0], true_mm[1], true_rad.to_degrees()],
            following_error: self.following_error(tick),
            true_error: [
                (true_mm[0] - setpoint[0]) * 1e3,
                (true_mm[1] - setpoint[1]) * 1e3,
                (true_rad - turns * TAU) * 1e6,
            ],
            pivot_setpoint_deg: pivots.map(|units| units / TURN * 360.0),
            pivot_rate_rad_s: tick.pivot_rates.map(f64::from),
            motion: self.motion(tick),
            pivot_error_lsb: [0, 1, 2].map(|i| {
                (tick.pivots[i].units() - tick.pivot_setpoints[i].units()) as f64 / PER_COUNT
            }),
            duty: tick.duty.map(|duty| f64::from(duty.0) / self.pwm_counts),
            integral_v: servos.map(|servo| f64::from(servo.integral_v)),
            model_current_a: [0, 1, 2]
                .map(|i| f64::from(servos[i].current_knees) * self.knees_a[i]),
            learnt_rate_v_s_rad: learnt(0),
            learnt_torque_v_n_m: learnt(1),
            learnt_friction_v: learnt(2),
            separation_deg: separation_rad(pivots.map(|units| units / TURN * TAU)).to_degrees(),
        }
    }

    /// What the encoders see of the pose's error, um, um, urad: the errors of the pivots through the Jacobian at the setpoint.
    fn following_error(&self, tick: &TickSample) -> [f64; 3] {
        let [x, y, turns] = tick.setpoint.position.map(|units| units as f64 / TURN);
        let pose = Pose {
            x,
            y,
            theta: turns.fract() * TAU,
        };
        let errors = [0, 1, 2].map(|i| {
            (tick.pivots[i].units() - tick.pivot_setpoints[i].units()) as f64 / TURN * TAU
        });
        inverse(&pose).map_or([f64::NAN; 3], |inverse| {
            let off = direct_rates(&inverse.guides, &errors);
            [
                off.x * self.radius_mm * 1e3,
                off.y * self.radius_mm * 1e3,
                off.theta * 1e6,
            ]
        })
    }

    fn motion(&mut self, tick: &TickSample) -> MotionSample {
        let (twist, acceleration) = (
            &tick.reference_point.twist,
            &tick.reference_point.acceleration,
        );
        let scaled = |x: f32, y: f32, theta: f32| {
            let [x, y] = [x, y].map(|radii| f64::from(radii) * self.radius_mm);
            [x, y, f64::from(theta).to_degrees()]
        };
        let rates = scaled(twist.x, twist.y, twist.theta);
        let accelerations = scaled(acceleration.x, acceleration.y, acceleration.theta);
        let pivots = tick.pivot_rates.map(f64::from);
        let (last, last_pivots) = std::mem::replace(&mut self.last, (accelerations, pivots));
        let per_s =
            |now: [f64; 3], last: [f64; 3]| [0, 1, 2].map(|i| (now[i] - last[i]) / self.period_s);
        let jerks = per_s(accelerations, last);
        let along = |[x, y, _]: [f64; 3]| x.hypot(y);
        MotionSample {
            translation: [rates, accelerations, jerks].map(along),
            rotation: [rates[2], accelerations[2], jerks[2]],
            pivots_rad_s2: per_s(pivots, last_pivots),
        }
    }

    fn follow_move(&mut self, sample: &Sample, position: &Position) {
        let now = sample.time_s;
        match (sample.moving, self.under_way) {
            (true, None) => self.under_way = Some(now),
            (false, Some(start_s)) => {
                self.under_way = None;
                let [x, y, turns] = position.map(|units| units as f64 / TURN);
                self.moves.push(Move {
                    start_s,
                    profile_end_s: now,
                    settled_s: None,
                    target: [x * self.radius_mm, y * self.radius_mm, turns * 360.0],
                });
            }
            _ => {}
        }
        // Settled is where the stage comes to stay: leaving the window again takes it back.
        if !sample.moving
            && let Some(last) = self.moves.last_mut()
        {
            let worst =
                (sample.pivot_error_lsb.iter()).fold(0.0_f64, |worst, e| worst.max(e.abs()));
            if worst > self.window_counts {
                last.settled_s = None;
            } else if last.settled_s.is_none() {
                last.settled_s = Some(now);
            }
        }
    }
}

/// Smallest angle between two of three pivots.
fn separation_rad(pivots: [f64; 3]) -> f64 {
    let apart = |a: f64, b: f64| {
        let turned = (a - b).rem_euclid(TAU);
        if turned > PI { TAU - turned } else { turned }
    };
    let [one, two, three] = pivots;
    apart(one, two)
        .min(apart(two, three))
        .min(apart(three, one))
}

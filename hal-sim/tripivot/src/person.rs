//! A simulated person beside a simulated machine: what commissioning asks one for.

use desk::commission::Task;
use hal_sim::machine::devices::Stage;
use hal_sim::machine::plant::{External, Plant};
use std::f64::consts::FRAC_PI_6;

/// Where the person holds the platform's middle, m, and how far it is turned, rad, in which time, s.
const OUT_M: [f64; 2] = [0.025, 0.015];
const TURN_RAD: f64 = 1.6;
const PUSH_S: f64 = 1.5;
const TURN_S: f64 = 4.0;
/// How stiff a person's hand is, N/m and N s/m, N m/rad and N m s/rad.
const HAND_N_M: f64 = 2_000.0;
const HAND_N_S_M: f64 = 200.0;
const WRIST_N_M_RAD: f64 = 30.0;
const WRIST_N_M_S_RAD: f64 = 5.0;
/// Where a jig holds the platform: in its middle with guide 1 along x, as well as jigs are made, m and rad. How stiff it is, N/m and N s/m, N m/rad and
/// N m s/rad; and how long it takes to take it out, s.
const IN_JIG: [f64; 3] = [20e-6, -20e-6, FRAC_PI_6 + 0.2e-3];
const JIG_N_M: f64 = 2e7;
const JIG_N_S_M: f64 = 8e3;
const JIG_N_M_RAD: f64 = 5e4;
const JIG_N_M_S_RAD: f64 = 30.0;
const TAKE_OUT_S: f64 = 0.9;
const TICK_S: f64 = 50e-6;

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Person {
    /// What the person is at, and for how many ticks.
    at: Option<(Task, u32)>,
    /// Where theta was as the platform was to be turned.
    start_rad: f64,
}

impl Person {
    /// Whether the platform is in hand.
    #[must_use]
    pub const fn has_it_in_hand(&self) -> bool {
        matches!(self.at, Some((Task::Turn, _)))
    }

    /// Begins what was asked for; the jig is put in at once.
    pub fn begin(&mut self, task: Task, stage: &mut Stage) {
        self.at = Some((task, 0));
        match task {
            Task::Turn => self.start_rad = stage.plant.pose()[2],
            Task::PutOnJig => stage.set_pose_at_rest(IN_JIG),
            Task::TakeOutJig => {}
        }
    }

    /// What hand and jig do in a tick.
    pub fn tick(&mut self, stage: &mut Stage) {
        let Some((task, ticks)) = &mut self.at else {
            return;
        };
        *ticks += 1;
        let now_s = f64::from(*ticks) * TICK_S;
        let plant = &mut stage.plant;
        let external = match task {
            Task::Turn if now_s <= PUSH_S + TURN_S => turn(plant, self.start_rad, now_s),
            Task::PutOnJig => hold(plant),
            Task::TakeOutJig if now_s <= TAKE_OUT_S => hold(plant),
            _ => {
                self.at = None;
                External::default()
            }
        };
        plant.set_external(external);
    }
}

/// The platform is pushed out of the middle, and turned from there.
fn turn(plant: &Plant, start_rad: f64, now_s: f64) -> External {
    let turned = ((now_s - PUSH_S) / (TURN_S - 1.0)).clamp(0.0, 1.0);
    let pushed = (now_s / PUSH_S).min(1.0);
    let to = [
        pushed * OUT_M[0],
        pushed * OUT_M[1],
        start_rad + TURN_RAD * turned,
    ];
    spring(
        plant,
        to,
        [HAND_N_M, HAND_N_S_M],
        [WRIST_N_M_RAD, WRIST_N_M_S_RAD],
    )
}

/// What the jig holds a platform with that is put into it.
#[must_use]
pub fn hold(plant: &Plant) -> External {
    spring(
        plant,
        IN_JIG,
        [JIG_N_M, JIG_N_S_M],
        [JIG_N_M_RAD, JIG_N_M_S_RAD],
    )
}

/// What pulls the platform to a pose, with a stiffness and a damping each along and about.
fn spring(plant: &Plant, to: [f64; 3], along: [f64; 2], about: [f64; 2]) -> External {
    let (pose, velocity) = (plant.pose(), plant.velocity());
    let pull = |k: usize, [stiffness, damping]: [f64; 2]| {
        stiffness * (to[k] - pose[k]) - damping * velocity[k]
    };
    External {
        force_n: [pull(0, along), pull(1, along)],
        torque_n_m: pull(2, about),
        ..External::default()
    }
}

//! A simulated person beside a simulated machine: what commissioning asks one for.

use desk::commission::Task;
use hal_sim::machine::devices::Stage;
use hal_sim::machine::plant::External;

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
/// How well a jig holds, m and rad.
const JIG_M: f64 = 20e-6;
const JIG_RAD: f64 = 0.2e-3;
const TICK_S: f64 = 50e-6;

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Person {
    /// Ticks since the person has begun to turn the platform, and where its theta was.
    turning: Option<(u32, f64)>,
}

impl Person {
    /// Whether the platform is in hand.
    #[must_use]
    pub const fn has_it_in_hand(&self) -> bool {
        self.turning.is_some()
    }

    /// Begins what was asked for; the jig is put in at once.
    pub fn begin(&mut self, task: Task, stage: &mut Stage) {
        match task {
            Task::Turn => self.turning = Some((0, stage.plant.pose()[2])),
            Task::PutOnJig => stage.set_pose_at_rest([JIG_M, -JIG_M, JIG_RAD]),
        }
    }

    /// What the hand does in a tick.
    pub fn tick(&mut self, stage: &mut Stage) {
        let Some((ticks, start_rad)) = &mut self.turning else {
            return;
        };
        *ticks += 1;
        let now_s = f64::from(*ticks) * TICK_S;
        let plant = &mut stage.plant;
        if now_s > PUSH_S + TURN_S {
            self.turning = None;
            plant.set_external(External::default());
            return;
        }
        let turned = ((now_s - PUSH_S) / (TURN_S - 1.0)).clamp(0.0, 1.0);
        let pushed = (now_s / PUSH_S).min(1.0);
        let (pose, velocity) = (plant.pose(), plant.velocity());
        let to_rad = *start_rad + TURN_RAD * turned;
        let force_n =
            [0, 1].map(|k| HAND_N_M * (pushed * OUT_M[k] - pose[k]) - HAND_N_S_M * velocity[k]);
        let torque_n_m = WRIST_N_M_RAD * (to_rad - pose[2]) - WRIST_N_M_S_RAD * velocity[2];
        plant.set_external(External {
            force_n,
            torque_n_m,
            ..External::default()
        });
    }
}

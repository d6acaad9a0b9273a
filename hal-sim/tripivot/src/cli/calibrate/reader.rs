//! What reads the instrument: a command of the user's, or the simulated instrument beside a simulated machine.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::io::Write;
use std::process::{Command, Stdio};

use calibration::{Instrument, Seen};
use desk::calibrate::{Reader, Wanted, question, reading};
use hal_sim::machine::devices::WiringParameters;
use hal_sim::machine::instruments::Beside;

/// A command that is run in a shell for each reading.
pub(in super::super) struct Asked {
    pub(in super::super) command: String,
    pub(in super::super) instrument: Instrument,
}

impl Reader for Asked {
    fn read(&mut self, wanted: &Wanted) -> Result<Seen, String> {
        let failed = |error: std::io::Error| format!("--reader: {error}");
        let (shell, flag) = if cfg!(windows) {
            ("cmd", "/C")
        } else {
            ("sh", "-c")
        };
        let mut child = Command::new(shell)
            .args([flag, &self.command])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        if let Some(mut input) = child.stdin.take() {
            // A command that does not look at the pose may have ended by now.
            let _ = input.write_all(question(&self.instrument, wanted).as_bytes());
        }
        let output = child.wait_with_output().map_err(failed)?;
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        if !output.status.success() {
            return Err(format!("--reader ended with {}", output.status));
        }
        reading(&self.instrument, wanted.at, &text).ok_or_else(|| {
            format!("--reader answered '{text}', which is no reading of this instrument")
        })
    }
}

/// What ends of guides need.
pub(super) struct NoInstrument;

impl Reader for NoInstrument {
    fn read(&mut self, _: &Wanted) -> Result<Seen, String> {
        Err("there is no instrument to read".to_owned())
    }
}

/// The simulated instrument, which sees the true pose.
pub(in super::super) struct Simulated {
    pub(in super::super) instrument: Beside,
    pub(in super::super) true_pose: TruePose,
}

/// The platform's true pose in the frames of its controller, in which somebody sets instruments up: what a controller that was commissioned
/// calls pivot 1 is the ring that bridge 1 drives, and its guide lay along x in the jig.
pub(in super::super) struct TruePose {
    in_m: Box<dyn Fn() -> [f64; 3]>,
    /// By how much the controller's frame of the platform is turned in the platform.
    platform_rad: f64,
    /// By how much its frame of the base is turned in the base; known from the first pose on.
    base_rad: Cell<Option<f64>>,
}

impl TruePose {
    /// `in_m`: as the machine has it, m, m and rad.
    pub(in super::super) fn new(
        in_m: impl Fn() -> [f64; 3] + 'static,
        wiring: &WiringParameters,
    ) -> Self {
        Self {
            in_m: Box::new(in_m),
            platform_rad: TAU / 3.0 * wiring.ring_of_bridge(0) as f64,
            base_rad: Cell::new(None),
        }
    }

    /// m, m and rad, where the controller was sent to this theta, rad.
    pub(super) fn get(&self, commanded_rad: f64) -> [f64; 3] {
        /// Frames differ by whole ones of these.
        const STEP_RAD: f64 = TAU / 12.0;
        let [x, y, theta_rad] = (self.in_m)();
        let base_rad = self.base_rad.get().unwrap_or_else(|| {
            let off_rad = theta_rad + self.platform_rad - commanded_rad;
            STEP_RAD * (off_rad / STEP_RAD).round()
        });
        self.base_rad.set(Some(base_rad));
        let (sin, cos) = base_rad.sin_cos();
        let theta_rad = theta_rad + self.platform_rad - base_rad;
        [x * cos + y * sin, y * cos - x * sin, theta_rad]
    }
}

impl Reader for Simulated {
    fn read(&mut self, wanted: &Wanted) -> Result<Seen, String> {
        (self
            .instrument
            .read(wanted.at, self.true_pose.get(wanted.pose[2]), wanted.visit))
        .ok_or_else(|| {
            "the mark is not in the camera's picture, or the ball out of the gauges' reach"
                .to_owned()
        })
    }
}

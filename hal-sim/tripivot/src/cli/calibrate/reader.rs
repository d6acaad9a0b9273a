//! What reads the instrument: a command of the user's, or the simulated instrument beside a simulated machine.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::io::Write;
use std::process::{Command, Stdio};
use std::rc::Rc;

use calibration::plan::At;
use calibration::{Instrument, Kit, Seen};
use desk::calibrate::{Reader, Wanted};
use hal_sim::machine::devices::WiringParameters;
use hal_sim::machine::instruments::Beside;
use kinematics::Geometry;

const UM_PER_MM: f64 = 1e3;

/// A command that is run in a shell for each reading.
pub(super) struct Asked {
    pub(super) command: String,
    pub(super) instrument: Instrument,
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
            let _ = input.write_all(self.question(wanted).as_bytes());
        }
        let output = child.wait_with_output().map_err(failed)?;
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        if !output.status.success() {
            return Err(format!("--reader ended with {}", output.status));
        }
        let values: Option<Vec<f64>> = (text.split([' ', ',', '\t']))
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().ok().filter(|value: &f64| value.is_finite()))
            .collect();
        (values.and_then(|values| self.seen(wanted.at, &values))).ok_or_else(|| {
            format!("--reader answered '{text}', which is no reading of this instrument")
        })
    }
}

impl Asked {
    fn question(&self, wanted: &Wanted) -> String {
        let radius_mm = Geometry::REFERENCE.radius_mm;
        let [x, y, theta_rad] = wanted.pose;
        let mut values = vec![x * radius_mm, y * radius_mm, theta_rad.to_degrees()];
        if let At::Mark { mark, camera } = wanted.at {
            let drawn = [
                self.instrument.marks.get(mark),
                self.instrument.cameras.get(camera),
            ];
            let drawn = drawn.into_iter().flatten().flatten();
            values.extend(drawn.map(|value| value * radius_mm));
        }
        let words: Vec<String> = values.iter().map(|value| format!("{value:.9}")).collect();
        words.join(" ") + "\n"
    }

    fn seen(&self, at: At, values: &[f64]) -> Option<Seen> {
        let radii = |mm: f64| mm / Geometry::REFERENCE.radius_mm;
        match (self.instrument.kit, at, values) {
            (Kit::Xyt, _, &[x, y, theta]) => {
                Some(Seen::Pose([radii(x), radii(y), theta.to_radians()]))
            }
            (Kit::Xy, _, &[x, y]) => Some(Seen::Place([radii(x), radii(y)])),
            (Kit::Theta, _, &[theta]) => Some(Seen::Turn(theta.to_radians())),
            (Kit::Camera | Kit::Camera2 | Kit::Balls, At::Mark { mark, camera }, &[x_um, y_um]) => {
                let off = [radii(x_um / UM_PER_MM), radii(y_um / UM_PER_MM)];
                Some(Seen::Mark { mark, camera, off })
            }
            _ => None,
        }
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
pub(super) struct Simulated {
    pub(super) instrument: Beside,
    pub(super) true_pose: TruePose,
}

/// The platform's true pose in the frames of its controller, in which somebody sets instruments up: what a controller that was commissioned
/// calls pivot 1 is the ring that bridge 1 drives, and its guide lay along x in the jig.
pub(super) struct TruePose {
    in_m: Rc<Cell<[f64; 3]>>,
    /// By how much the controller's frame of the platform is turned in the platform.
    platform_rad: f64,
    /// By how much its frame of the base is turned in the base; known from the first pose on.
    base_rad: Cell<Option<f64>>,
}

impl TruePose {
    pub(super) fn new(in_m: Rc<Cell<[f64; 3]>>, wiring: &WiringParameters) -> Self {
        Self {
            in_m,
            platform_rad: TAU / 3.0 * wiring.ring_of_bridge(0) as f64,
            base_rad: Cell::new(None),
        }
    }

    /// m, m and rad, where the controller was sent to this theta, rad.
    pub(super) fn get(&self, commanded_rad: f64) -> [f64; 3] {
        /// Frames differ by whole ones of these.
        const STEP_RAD: f64 = TAU / 12.0;
        let [x, y, theta_rad] = self.in_m.get();
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

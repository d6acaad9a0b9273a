//! The mechanism's movements for the page's explanation: what the platform does when the pivots turn together, alone, and by
//! different amounts. Computed by the kinematics, so that the page models nothing.

use std::f64::consts::TAU;

use kinematics::{Geometry, Pose, direct, inverse};
use serde::Serialize;

/// Frames of a movement, which ends where it began.
const FRAMES: usize = 120;
/// Largest angle of the pivots' own movements, deg.
const SWING_DEG: f64 = 40.0;
/// Largest shift, mm.
const SHIFT_MM: f64 = 50.0;

/// Orientation at which guide 1 points along x, deg.
const JIG_DEG: f64 = 30.0;
/// How far out a person pushes the platform before it is turned, mm; the share of the time that this takes; how far it is turned, deg.
const OUT_MM: [f64; 2] = [32.0, 18.0];
const PUSHED: f64 = 0.3;
const QUARTER_DEG: f64 = 90.0;

/// See [`tasks_json`].
#[derive(Serialize)]
struct Tasks {
    turn: Vec<Frame>,
    jig: Vec<Frame>,
}

/// A movement, and what it shows.
#[derive(Serialize)]
struct Movement {
    name: &'static str,
    caption: &'static str,
    frames: Vec<Frame>,
}

/// The mechanism at an instant.
#[derive(Serialize)]
struct Frame {
    /// Mm, mm, deg.
    pose: [f64; 3],
    /// Deg.
    pivots: [f64; 3],
}

/// Where everything begins: the centre, not turned.
const HOME_DEG: [f64; 3] = [-30.0, 90.0, 210.0];

/// All movements as JSON.
pub(super) fn json() -> String {
    let movements = [
        Movement {
            name: "All together",
            caption: "All three pivots turn by the same angle: the platform turns by that angle and stays where it is. \
                      Round and round, as often as you like.",
            frames: of_pivots(|swing| [swing; 3]),
        },
        Movement {
            name: "One alone",
            caption: "Only pivot 1 turns: its guide is swung aside, and the platform is pushed along the other two. It \
                      shifts, and turns a little.",
            frames: of_pivots(|swing| [swing, 0.0, 0.0]),
        },
        Movement {
            name: "Shift in x",
            caption: "The pivots turn by different amounts that cancel: the platform shifts along x and does not turn.",
            frames: of_poses(|share| [SHIFT_MM * (TAU * share).sin(), 0.0, 0.0]),
        },
        Movement {
            name: "Shift in y",
            caption: "Other amounts, and it shifts along y. Pivot 2 stands still: its guide already points that way.",
            frames: of_poses(|share| [0.0, SHIFT_MM * (TAU * share).sin(), 0.0]),
        },
        Movement {
            name: "All at once",
            caption: "Added up, x, y and theta are set freely: here the centre runs round a circle while the platform \
                      turns once.",
            frames: of_poses(|share| {
                let angle = TAU * share;
                [
                    SHIFT_MM * (angle.cos() - 1.0) * 0.7,
                    SHIFT_MM * angle.sin() * 0.7,
                    360.0 * share,
                ]
            }),
        },
    ];
    serde_json::to_string(&movements).unwrap_or_default()
}

/// What commissioning asks a person for, as JSON: how the platform is turned by hand, and how it stands in its jig.
pub(super) fn tasks_json() -> String {
    let tasks = Tasks {
        turn: of_poses(|share| {
            let pushed = (share / PUSHED).min(1.0);
            let turned = ((share - PUSHED) / (1.0 - PUSHED)).max(0.0);
            [
                OUT_MM[0] * pushed,
                OUT_MM[1] * pushed,
                JIG_DEG + QUARTER_DEG * turned,
            ]
        }),
        jig: of_poses(|_| [0.0, 0.0, JIG_DEG]),
    };
    serde_json::to_string(&tasks).unwrap_or_default()
}

fn shares() -> impl Iterator<Item = f64> {
    (0..FRAMES).map(|frame| frame as f64 / FRAMES as f64)
}

/// Frames of pivots that leave home by these angles, given the swing of the instant; deg.
fn of_pivots(turned: impl Fn(f64) -> [f64; 3]) -> Vec<Frame> {
    let frame = |share: f64| {
        let turned = turned(SWING_DEG * (TAU * share).sin());
        let pivots = [0, 1, 2].map(|i| HOME_DEG[i] + turned[i]);
        let pose = direct::<f64>(&pivots.map(f64::to_radians)).ok()?;
        Some(Frame {
            pose: place(&pose),
            pivots,
        })
    };
    shares().filter_map(frame).collect()
}

/// Frames of poses: mm, mm, deg.
fn of_poses(pose_at: impl Fn(f64) -> [f64; 3]) -> Vec<Frame> {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    let frame = |share: f64| {
        let [x_mm, y_mm, theta_deg] = pose_at(share);
        let pose = Pose {
            x: x_mm / radius_mm,
            y: y_mm / radius_mm,
            theta: theta_deg.to_radians(),
        };
        let pivots = inverse(&pose).ok()?.pivots.map(f64::to_degrees);
        Some(Frame {
            pose: place(&pose),
            pivots,
        })
    };
    shares().filter_map(frame).collect()
}

fn place(pose: &Pose<f64>) -> [f64; 3] {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    [
        pose.x * radius_mm,
        pose.y * radius_mm,
        pose.theta.to_degrees(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pictures_of_the_tasks_are_what_their_words_say() {
        let tasks: serde_json::Value = serde_json::from_str(&tasks_json()).unwrap();
        let pivots: Vec<f64> = serde_json::from_value(tasks["jig"][0]["pivots"].clone()).unwrap();
        for (pivot, at_deg) in pivots.iter().zip([0.0, 120.0, 240.0]) {
            assert!((pivot - at_deg).abs() < 1e-9, "{pivots:?}");
        }
        let last = &tasks["turn"][FRAMES - 1]["pose"];
        let at = |k: usize| last[k].as_f64().unwrap();
        let out_mm = at(0).hypot(at(1));
        assert!((20.0..=50.0).contains(&out_mm), "2 to 5 cm: {out_mm}");
        assert!(at(2) > JIG_DEG + 85.0, "to the left by a quarter: {last}");
    }

    #[test]
    fn the_captions_are_true() {
        let together = of_pivots(|swing| [swing; 3]);
        assert_eq!(together.len(), FRAMES);
        for frame in &together {
            let [x, y, theta] = frame.pose;
            assert!(x.hypot(y) < 1e-9, "it stays where it is");
            assert!((theta - (frame.pivots[0] - HOME_DEG[0])).abs() < 1e-9);
        }
        let alone = &of_pivots(|swing| [swing, 0.0, 0.0])[FRAMES / 4];
        assert!(alone.pose[0].hypot(alone.pose[1]) > 10.0 && alone.pose[2].abs() > 1.0);
        for frame in of_poses(|share| [SHIFT_MM * (TAU * share).sin(), 0.0, 0.0]) {
            let turned: f64 = frame.pivots.iter().sum::<f64>() - HOME_DEG.iter().sum::<f64>();
            assert!(turned.abs() < 1.5, "they cancel: {turned}");
        }
        for frame in of_poses(|share| [0.0, SHIFT_MM * (TAU * share).sin(), 0.0]) {
            assert!(
                (frame.pivots[1] - HOME_DEG[1]).abs() < 1e-9,
                "pivot 2 stands still"
            );
        }
    }
}

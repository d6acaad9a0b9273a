//! The kinematics of built machines against poses and readings computed elsewhere, by a formula of another form.

mod built_machine;

use built_machine::{BuiltMachine, all, lines};
use kinematics::{Corrections, Series, corrected_direct, corrected_inverse};

fn corrections(machine: &BuiltMachine) -> Corrections<f64, Series<f64>> {
    Corrections::new(&machine.pivots, Series::new).expect("within the limits")
}

/// Largest errors over a machine's poses: rings and encoders (rad), and rho (track radii), whose closed form is without
/// curves.
fn worst_errors(machine: &BuiltMachine) -> [f64; 2] {
    let corrections = corrections(machine);
    let mut worst = [0.0_f64; 2];
    for row in &machine.rows {
        let solved = corrected_inverse(&row.pose, &corrections).expect("inside the track");
        for i in 0..3 {
            let errors = [
                solved.encoders[i] - row.encoders[i],
                solved.guides[i].rho() - row.rho[i],
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                assert!(!error.is_nan());
                *worst = worst.max(error.abs());
            }
        }
    }
    println!("{}: encoders, rho: {worst:?}", machine.name);
    worst
}

#[test]
fn lines_agree_to_1e_12() {
    let worst = worst_errors(&lines());
    assert!(worst.iter().all(|&error| error <= 1e-12), "{worst:?}");
}

/// What the one step onto a curved guide leaves.
#[test]
fn all_errors_agree_to_1e_11() {
    let [encoders, rho] = worst_errors(&all());
    assert!(encoders <= 1e-11, "{encoders}");
    // Runout and the step itself.
    assert!(rho <= 2e-4, "{rho}");
}

/// Largest errors of the centre (track radii) and theta (rad) after so many steps.
fn worst_pose_errors(machine: &BuiltMachine, steps: u32) -> [f64; 2] {
    let corrections = corrections(machine);
    let mut worst = [0.0_f64; 2];
    for row in &machine.rows {
        let pose = corrected_direct(&row.encoders, &corrections, steps).expect("a feasible pose");
        let centre = (pose.x - row.pose.x).hypot(pose.y - row.pose.y);
        worst[0] = worst[0].max(centre);
        worst[1] = worst[1].max((pose.theta - row.pose.theta).abs());
    }
    println!("{}, {steps} steps: centre, theta: {worst:?}", machine.name);
    worst
}

#[test]
fn direct_is_within_a_quarter_lsb_after_two_steps() {
    for machine in [lines(), all()] {
        let worst = worst_pose_errors(&machine, 2);
        assert!(worst.iter().all(|&error| error <= 2.3e-8), "{worst:?}");
    }
}

#[test]
fn direct_is_as_good_as_the_inverse_after_three_steps() {
    for (machine, most) in [(lines(), 1e-12), (all(), 1e-11)] {
        // Every step is needed: what one leaves is far from it.
        assert!(worst_pose_errors(&machine, 1)[0] > 1e-7);
        let worst = worst_pose_errors(&machine, 3);
        assert!(worst.iter().all(|&error| error <= most), "{worst:?}");
    }
}

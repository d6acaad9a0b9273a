//! Move and settle, and how quiet the stage is at rest, as tables: `cargo bench -p hal-sim --bench settle`.
//!
//! Random moves of 1 mm and more over the whole disk, theta with them, on the simulated stage with all calibrated imperfections,
//! friction with presliding and stiction among them. Times are counted from the tick that takes the command: to the profile's end,
//! to where every pivot comes to stay within the window of +-2 encoder LSB, by each reading (one that is noise counts) and by the mean of a
//! millisecond, as the controller judges it, and to where the controller says so, a dwell later.

mod moves;

use firmware::parameters::Parameters;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::Told;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};

/// A machine so far off the reference, and what the controller knows of it.
#[derive(Clone, Copy)]
struct Case {
    /// Without most of what a workshop leaves in a machine.
    is_kind: bool,
    mismatch_percent: f64,
    payload_kg: f64,
    told: Told,
}

const CASES: [Case; 14] = {
    use Told::{Everything, Machine, MachineAndRipple, Nothing, Reference};
    [
        Case::unkind(0.0, Reference),
        Case::unkind(5.0, Everything),
        Case::new(0.0, 0.0, Nothing),
        Case::new(20.0, 0.0, Nothing),
        Case::new(0.0, 0.0, Machine),
        Case::new(20.0, 0.0, Machine),
        Case::new(-20.0, 0.0, Machine),
        Case::new(35.0, 0.0, Machine),
        Case::new(20.0, 5.0, Machine),
        Case::new(35.0, 5.0, Machine),
        Case::new(20.0, 0.0, MachineAndRipple),
        Case::new(-20.0, 0.0, MachineAndRipple),
        Case::new(35.0, 0.0, MachineAndRipple),
        Case::new(35.0, 5.0, MachineAndRipple),
    ]
};

impl Case {
    const fn new(mismatch_percent: f64, payload_kg: f64, told: Told) -> Self {
        Self {
            is_kind: true,
            mismatch_percent,
            payload_kg,
            told,
        }
    }

    const fn unkind(payload_kg: f64, told: Told) -> Self {
        Self {
            is_kind: false,
            ..Self::new(0.0, payload_kg, told)
        }
    }

    fn words(&self) -> String {
        let machine = if self.is_kind {
            format!("kind, {} % off", self.mismatch_percent)
        } else {
            "reference stage".to_owned()
        };
        format!("{machine} | {} | {}", self.payload_kg, self.told)
    }

    fn stage_and_controller(&self) -> (StageParameters, Parameters) {
        let options = RunOptions {
            mismatch_percent: self.mismatch_percent,
            payload_kg: self.payload_kg,
            told: self.told,
            ..if self.is_kind {
                RunOptions::default()
            } else {
                RunOptions::reference()
            }
        };
        (stage_parameters(&options), controller_parameters(&options))
    }
}

fn main() {
    println!(
        "| plant | load, kg | told | settling, ms after the profile: median / 90 % / 99 % / worst | by the mean of 1 ms | of the profile: median / 90 % / 99 % / worst | within 10 % | settled told within 10 % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let quiet = CASES.map(|case| {
        let (stage, parameters) = case.stage_and_controller();
        let moves = moves::of(&stage, &parameters);
        println!(
            "| {} | {} | {:.1} % | {:.1} % |",
            case.words(),
            moves.settling(),
            100.0 * moves.within_a_tenth(),
            100.0 * moves.told_within_a_tenth()
        );
        moves.rest
    });
    println!();
    println!(
        "| plant at rest | load, kg | told | true position, nm rms | theta, nrad rms | pivots, LSB rms / peak | duty, % rms about its mean |"
    );
    println!("|---|---|---|---|---|---|---|");
    for (case, rest) in CASES.iter().zip(&quiet) {
        println!("| {} | {} |", case.words(), rest.cells());
    }
}

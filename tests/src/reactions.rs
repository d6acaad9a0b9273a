//! How each reaction to a fault brings the worst machine to rest: way, turn and time, from the tick in which the fault begins.
//!
//! 5 kg on the platform that the controller is told of, half of the reference stage's friction at the rings and none else, windings 100 K
//! hot, the bus and the bridges as their parts have them, and all masses a fifth more and motors a fifth weaker than the reference stage's, or
//! the other way round. Less load, cold windings and more friction leave more to brake with; they are not run. At the platform's largest speed
//! along a chord of the disk, and at its largest rotation, and both.

use crate::Bench;
use firmware::fault::{FaultKind, Reaction};
use firmware::parameters::Parameters;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::{FrictionParameters, Imperfections, PlantParameters};
use hal_sim::rig::run::{RunOptions, stage_parameters};
use hal_sim::rig::{Told, with_motion_fitted};

/// How far a guide's end lets the platform's centre go, mm.
const RIM_MM: f64 = 79.5;
/// Distances of the chords from the middle, mm; of the last one both ends are 17 mm from its middle, in which the largest speed is reached.
const CHORDS_MM: [f64; 4] = [0.0, 40.0, 70.0, 77.5];
/// Largest speed and rotation.
const SPEED_MM_S: f64 = 200.0;
const TURN_DEG_S: f64 = 360.0;
/// Slower than this a pivot is at rest, rad/s.
const AT_REST_RAD_S: f64 = 0.01;
/// Ticks between two looks at the way, and ticks after which nothing moves any more.
const LOOK_EVERY: u32 = 5;
const LONGEST: u32 = 100_000;

/// What begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A loop that is late: a controlled stop.
    Late,
    /// A supply that reads too low: braked by the bridges.
    Supply,
    /// A bridge that pulls its fault pin: left to coast.
    Bridge,
    /// The emergency stop.
    EmergencyStop,
}

impl Trouble {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Late, Self::Supply, Self::Bridge, Self::EmergencyStop];

    /// The word for its reaction.
    #[must_use]
    pub const fn reaction(self) -> &'static str {
        match self {
            Self::Late => "stop",
            Self::Supply => "brake",
            Self::Bridge => "coast",
            Self::EmergencyStop => "emergency stop",
        }
    }

    const fn kind(self) -> FaultKind {
        match self {
            Self::Late => FaultKind::LoopLate,
            Self::Supply => FaultKind::SupplyLow,
            Self::Bridge => FaultKind::BridgeFault,
            Self::EmergencyStop => FaultKind::EmergencyStop,
        }
    }

    fn begin(self, bench: &mut Bench) {
        let front = &mut bench.rig.front;
        match self {
            Self::Late => front.late = true,
            Self::Supply => front.stage.analog_inputs().supply_gain = 0.7,
            Self::Bridge => front.bridges[0].set_fault(true),
            Self::EmergencyStop => front.emergency_stop = true,
        }
    }
}

/// A motion out of which it comes, and whose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    chord: usize,
    /// Which way round, if at all.
    turns: i8,
    moves: bool,
    /// Of the heavier machine with the weaker motors.
    weak: bool,
}

impl Motion {
    /// All of them.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let kinds = [(0, true), (1, true), (-1, true), (1, false), (-1, false)];
        let each = |chord| {
            kinds.into_iter().flat_map(move |(turns, moves)| {
                [true, false].map(|weak| Self {
                    chord,
                    turns,
                    moves,
                    weak,
                })
            })
        };
        (0..CHORDS_MM.len()).flat_map(each).collect()
    }

    fn half_mm(self) -> f64 {
        (RIM_MM * RIM_MM - CHORDS_MM[self.chord].powi(2)).sqrt()
    }

    /// In words; there are no two with the same.
    #[must_use]
    pub fn words(self) -> String {
        let turns = match self.turns {
            0 => "",
            1 => " turning left",
            _ => " turning right",
        };
        let at = CHORDS_MM[self.chord];
        let moves = if self.moves { "moving" } else { "standing" };
        let motors = if self.weak { "weak" } else { "strong" };
        format!("{moves}{turns} {at} mm from the middle with {motors} motors")
    }

    /// The worst machine that has it.
    #[must_use]
    pub fn machine(self) -> StageParameters {
        worst_machine(self.weak)
    }

    /// A stage in the middle of it.
    ///
    /// # Panics
    /// When it does not come so far.
    #[must_use]
    pub fn under_way(self, stage: &StageParameters) -> Bench {
        let told = with_motion_fitted(&Told::Machine.parameters(&Parameters::REFERENCE, stage));
        let mut bench = Bench::told(stage, &told);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        let chord = CHORDS_MM[self.chord];
        let turn = f64::from(self.turns) * TURN_DEG_S;
        if self.moves {
            let (half, seconds) = (self.half_mm(), 2.0 * self.half_mm() / SPEED_MM_S);
            bench.say(&format!("MOV X {chord} Y {} W 0\n", -half));
            bench.settle();
            let to = format!("MOV X {chord} Y {half} W {}", turn * seconds);
            assert_eq!(bench.error_after(&to), "0");
            let middle = |bench: &Bench| bench.rig.front.stage.plant.pose()[1] >= 0.0;
            bench.run_until("in the middle", middle);
        } else {
            bench.say(&format!("MOV X {chord} Y 0 W 0\n"));
            bench.settle();
            // As fast as the pivots follow there.
            let slower = (0..10).map(|k| turn * (1.0 - 0.05 * f64::from(k)));
            let taken = slower
                .into_iter()
                .any(|turn| bench.error_after(&format!("JOG W {turn}")) == "0");
            assert!(taken, "{}", self.words());
            bench.run(8_000);
        }
        assert_eq!(bench.fault(), None, "{}", self.words());
        bench
    }
}

/// See the module.
#[must_use]
pub fn worst_machine(weak: bool) -> StageParameters {
    let options = RunOptions {
        mismatch_percent: if weak { 20.0 } else { -20.0 },
        payload_kg: 5.0,
        imperfections: Imperfections {
            bus: true,
            bridge_limits: true,
            winding_heat: true,
            ..Imperfections::CALIBRATED
        },
        ..RunOptions::default()
    };
    let stage = stage_parameters(&options);
    let plant = &stage.plant;
    let mut winding = plant.winding;
    winding.start_k = 100.0;
    StageParameters {
        plant: PlantParameters {
            ring_friction: FrictionParameters {
                coulomb: 0.5 * plant.ring_friction.coulomb,
                viscous: 0.5 * plant.ring_friction.viscous,
                ..plant.ring_friction
            },
            winding,
            ..*plant
        },
        ..stage
    }
}

/// Way of the platform's centre, its turn, and the time, from where a trouble begins to rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToRest {
    /// Way.
    pub way_mm: f64,
    /// Turn.
    pub turn_deg: f64,
    /// Time.
    pub ms: f64,
}

/// What comes of a trouble in a motion.
///
/// # Panics
/// When that is not its fault, or does not rest.
#[must_use]
pub fn to_rest(trouble: Trouble, motion: Motion) -> ToRest {
    let mut bench = motion.under_way(&motion.machine());
    let [mut x, mut y, from] = bench.rig.front.stage.plant.pose();
    let mut rest = ToRest::default();
    trouble.begin(&mut bench);
    for looks in 1..=LONGEST / LOOK_EVERY {
        bench.run(LOOK_EVERY);
        let plant = &bench.rig.front.stage.plant;
        let pose = plant.pose();
        rest.way_mm += (pose[0] - x).hypot(pose[1] - y) * 1e3;
        rest.turn_deg = rest.turn_deg.max((pose[2] - from).abs().to_degrees());
        [x, y, _] = pose;
        let rates = plant.pivot_rates_rad_s();
        if rates.iter().all(|rate| rate.abs() < AT_REST_RAD_S) {
            rest.ms = f64::from(looks * LOOK_EVERY) * 0.05;
            let kind = bench.fault_kind();
            assert_eq!(kind, Some(trouble.kind()), "{}", motion.words());
            return rest;
        }
    }
    panic!("{trouble:?} {}: no rest", motion.words());
}

/// The reactions that there are are all among them.
const _: () = {
    let [stop, brake, coast, _] = Trouble::ALL;
    assert!(matches!(stop.kind().reaction(), Reaction::Stop));
    assert!(matches!(brake.kind().reaction(), Reaction::Brake));
    assert!(matches!(coast.kind().reaction(), Reaction::Coast));
};

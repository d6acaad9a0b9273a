//! An encoder that is lost in motion: the other two and the model of the third bring the stage to rest on its path.
//!
//! `CASES=1000 cargo test -p tests --test lost_encoder -- --nocapture` prints how far it is off.

use firmware::mode::Mode;
use hal_sim::machine::devices::{EncoderFault, StageParameters};
use hal_sim::random::Random;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use std::f64::consts::TAU;
use tests::Bench;

const TURN: f64 = 4_294_967_296.0;
const RADIUS_MM: f64 = 100.0;
/// Where the guides end at the worst orientation, mm.
const GUIDES_END_MM: f64 = 84.0;
/// Losses that are tried unless `CASES` says otherwise.
const CASES: u32 = 30;

const LOST: [EncoderFault; 3] = [
    EncoderFault::StuckHigh,
    EncoderFault::ErrorBit,
    EncoderFault::Frozen,
];

/// How far the platform is from its setpoint: mm and deg.
fn off(bench: &Bench) -> [f64; 2] {
    let [x, y, theta] = bench.rig.front.stage.latched_pose();
    let [sx, sy, st] = bench.sample().setpoint.position.map(|units| units as f64);
    let xy = (x * 1e3 - sx / TURN * RADIUS_MM).hypot(y * 1e3 - sy / TURN * RADIUS_MM);
    [xy, (theta.to_degrees() - st / TURN * 360.0).abs()]
}

/// The worst of what was seen.
#[derive(Debug, Default)]
struct Worst {
    off: [f64; 2],
    from_centre_mm: f64,
    ticks: u32,
}

impl Worst {
    fn look(&mut self, bench: &Bench) {
        let now = off(bench);
        self.off = [self.off[0].max(now[0]), self.off[1].max(now[1])];
        let [x, y, _] = bench.rig.front.stage.latched_pose();
        self.from_centre_mm = self.from_centre_mm.max(x.hypot(y) * 1e3);
    }
}

fn lose_one(stage: &StageParameters, random: &mut Random, worst: &mut Worst) {
    let mut bench = Bench::new(stage);
    let (radius, angle) = (random.between(0.0, 79.0), random.between(0.0, TAU));
    bench.rig.front.stage.set_pose_at_rest([
        radius * 1e-3 * angle.cos(),
        radius * 1e-3 * angle.sin(),
        random.between(-3.0, 3.0),
    ]);
    assert_eq!(bench.error_after("FRF"), "0");
    let (radius, angle) = (random.between(0.0, 79.9), random.between(0.0, TAU));
    let line = format!(
        "MOV X {} Y {} W {}",
        radius * angle.cos(),
        radius * angle.sin(),
        random.between(-400.0, 400.0)
    );
    assert_eq!(bench.error_after(&line), "0");
    for _ in 0..random.index(12_000) {
        bench.tick();
    }
    if bench.mode() != Mode::Moving {
        return;
    }
    let fault = *random.pick(&LOST);
    let encoder = random.index(3);
    bench.rig.front.stage.encoders[encoder].set_fault(fault);
    let mut ticks = 0;
    while bench.mode() != Mode::Fault && ticks < 40_000 {
        bench.tick();
        ticks += 1;
        if bench.mode() == Mode::Stopping {
            worst.look(&bench);
        }
        if bench.mode() == Mode::Holding {
            // It came to rest by itself before the loss could be seen.
            return;
        }
    }
    let latched = bench.fault().expect("a fault");
    assert!(
        latched.kind.concerns_encoder(),
        "{line}, {fault:?}: {latched}"
    );
    assert_eq!(latched.pivot, Some(encoder as u8), "{line}: {latched}");
    worst.ticks = worst.ticks.max(ticks);
    // Braked, with what speed is left.
    for _ in 0..2_000 {
        bench.tick();
        worst.look(&bench);
    }
    let at_rest = bench.rig.front.stage.plant.pivot_rates_rad_s();
    assert!(
        at_rest.iter().all(|rate| rate.abs() < 6.8e-4),
        "{at_rest:?}"
    );
}

#[test]
fn two_encoders_and_the_model_bring_the_stage_to_rest_inside_its_limits() {
    let cases = std::env::var("CASES").map_or(CASES, |cases| cases.parse().expect("a number"));
    // What the cases that are always run come to, and a tenth more; others are printed, and have the guides' ends as their limit.
    for (mismatch_percent, most) in [(0.0, [0.0838, 0.0355]), (20.0, [2.85, 0.90])] {
        let stage = stage_parameters(&RunOptions {
            mismatch_percent,
            ..RunOptions::default()
        });
        let seed = 5;
        let mut random = Random::new(seed);
        let mut worst = Worst::default();
        for _ in 0..cases {
            lose_one(&stage, &mut random, &mut worst);
        }
        println!("{cases} cases from seed {seed}, mismatch {mismatch_percent} %: {worst:?}");
        assert!(
            cases != CASES || (worst.off[0] < most[0] && worst.off[1] < most[1]),
            "{worst:?}"
        );
        assert!(worst.from_centre_mm < GUIDES_END_MM, "{worst:?}");
    }
}

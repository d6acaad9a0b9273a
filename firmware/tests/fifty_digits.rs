//! The tick's position kinematics against more than 50 digits, at the very inputs that the tick holds: integers, which these
//! numbers hold exactly, turns and all. `exactness` has the same against doubles, for many more poses.
//!
//! `POSES=100000 cargo test --release -p firmware --test fifty_digits -- --nocapture` takes as many.

mod digits;

use digits::{Digits, Number};
use firmware::number::Fixed;
use kinematics::{Angle, Pose, direct, inverse};

/// The goal, a quarter of an encoder LSB; `exactness` pins what is reached more tightly.
const QUARTER_LSB: f64 = 2.3e-8;
/// What is reached, so that a loss of digits is seen long before the goal.
const PIVOT_RAD: f64 = 8.0e-9;
const CENTRE: f64 = 6.1e-9;
const THETA_RAD: f64 = 4.1e-9;
const _: () = assert!(PIVOT_RAD < QUARTER_LSB && CENTRE < QUARTER_LSB && THETA_RAD < QUARTER_LSB);

const TURNS: i64 = 10_000;
const USABLE_RADIUS: f64 = 0.8;
/// Units of angle in an encoder count of 26 bits.
const PER_COUNT: i64 = 64;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Anywhere on the usable disk, each tenth one at its edge, at any theta within the turns.
    fn pose(&mut self) -> Pose<Fixed> {
        let r = if self.bits().is_multiple_of(10) {
            USABLE_RADIUS
        } else {
            USABLE_RADIUS * self.share().sqrt()
        };
        let direction = self.share() * std::f64::consts::TAU;
        Pose {
            x: Fixed::from_f64(r * direction.cos()),
            y: Fixed::from_f64(r * direction.sin()),
            theta: Angle::from_units((self.bits() >> 1) as i64 % (TURNS << 33) - (TURNS << 32)),
        }
    }
}

fn length(fixed: Fixed) -> Number {
    Number::of(fixed.bits().into()) / Number::of(1 << Fixed::FRACTION_BITS)
}

/// Directions of the guides, -30, 90 and 210 deg from theta: twelfths of a turn, exactly.
fn guides(digits: &mut Digits, theta: Angle) -> [Number; 3] {
    [-1, 3, 7].map(|twelfths| {
        digits.radians(theta.units()) + digits.radians(twelfths << 32) / Number::of(12)
    })
}

/// Errors of the pivots' setpoints, rad.
fn pivot_errors(digits: &mut Digits, pose: &Pose<Fixed>) -> [f64; 3] {
    let pivots = inverse(pose).expect("inside the track").pivots;
    let (x, y) = (length(pose.x), length(pose.y));
    let guides = guides(digits, pose.theta);
    [0, 1, 2].map(|i| {
        let (sin, cos) = digits.sin_cos(&guides[i]);
        let offset = &y * &cos - &x * &sin;
        let exact = &guides[i] + &digits.asin(&offset);
        (digits.radians(pivots[i].units()) - exact).to_f64()
    })
}

type Complex = (Number, Number);

fn times(a: &Complex, b: &Complex) -> Complex {
    (&a.0 * &b.0 - &a.1 * &b.1, &a.0 * &b.1 + &a.1 * &b.0)
}

fn conjugate(a: &Complex) -> Complex {
    (a.0.clone(), -a.1.clone())
}

/// z1 + a z2 + b z3.
fn sum([one, two, three]: &[Complex; 3], a: &Complex, b: &Complex) -> Complex {
    let (two, three) = (times(two, a), times(three, b));
    (&one.0 + &(two.0 + three.0), &one.1 + &(two.1 + three.1))
}

/// Errors of the measured pose, in track radii and rad, at these readings.
fn pose_errors(digits: &mut Digits, pivots: &[Angle; 3]) -> (f64, f64) {
    let measured = direct::<Fixed>(pivots).expect("feasible pivots");
    let points = pivots.map(|pivot| {
        let angle = digits.radians(pivot.units());
        let (sin, cos) = digits.sin_cos(&angle);
        (cos, sin)
    });
    let half = || Number::of(1) / Number::of(2);
    let wide = || Number::of(3).sqrt() / Number::of(2);
    let (w, w_back) = ((-half(), wide()), (-half(), -wide()));
    let none = (Number::of(1), Number::of(0));
    let s0 = sum(&points, &none, &none);
    let s1 = sum(&points, &w_back, &w);
    let s2 = sum(&points, &w, &w_back);
    // u^2 conj(S2) = S1^2 conj(S2) / |S1|^2.
    let squared = &s1.0 * &s1.0 + &s1.1 * &s1.1;
    let turned = times(&times(&s1, &s1), &conjugate(&s2));
    let centre = |s: &Number, t: &Number| (s - &(t / &squared)) / Number::of(3);
    let x = (length(measured.x) - centre(&s0.0, &turned.0)).to_f64();
    let y = (length(measured.y) - centre(&s0.1, &turned.1)).to_f64();
    // What is left of S1 when it is turned back by the first guide's measured direction.
    let [guide, ..] = guides(digits, measured.theta);
    let (sin, cos) = digits.sin_cos(&guide);
    let left = times(&s1, &(cos, -sin));
    assert!(left.0.to_f64() > 0.0, "half a turn off");
    let theta = digits.atan(&(left.1 / left.0)).to_f64();
    (x.hypot(y), theta.abs())
}

fn poses() -> (u64, Random) {
    let count = std::env::var("POSES")
        .ok()
        .and_then(|text| text.parse().ok());
    let seed = 20_260_214;
    println!("seed {seed}");
    (count.unwrap_or(400), Random(seed))
}

#[test]
fn pivot_setpoints_are_exact_to_a_quarter_lsb() {
    let (count, mut random) = poses();
    let mut digits = Digits::new();
    let mut worst = 0.0_f64;
    for _ in 0..count {
        let pose = random.pose();
        for error in pivot_errors(&mut digits, &pose) {
            assert!(error.abs() < PIVOT_RAD, "{error:e} rad at {pose:?}");
            worst = worst.max(error.abs());
        }
    }
    println!("{count} poses, worst pivot error {worst:e} rad");
}

#[test]
fn measured_poses_are_exact_at_the_same_encoder_counts() {
    let (count, mut random) = poses();
    let mut digits = Digits::new();
    let (mut centre, mut theta) = (0.0_f64, 0.0_f64);
    for _ in 0..count {
        let pose = random.pose();
        let pivots = inverse(&pose).expect("inside the track").pivots;
        let counted = pivots.map(|pivot| Angle::from_units(pivot.units() / PER_COUNT * PER_COUNT));
        let errors = pose_errors(&mut digits, &counted);
        assert!(
            errors.0 < CENTRE && errors.1 < THETA_RAD,
            "{errors:?} at {pose:?}"
        );
        (centre, theta) = (centre.max(errors.0), theta.max(errors.1));
    }
    println!(
        "{count} poses, worst error of the centre {centre:e} track radii, of theta {theta:e} rad"
    );
}

#[test]
fn the_digits_agree_with_doubles_where_these_are_exact_enough() {
    let mut digits = Digits::new();
    for (units, sine) in [(1 << 30, 1.0), (1 << 32, 0.0), (-(1 << 30), -1.0)] {
        let angle = digits.radians(units + (TURNS << 32));
        assert!(
            (digits.sin_cos(&angle).0.to_f64() - sine).abs() < 1e-40,
            "{units}"
        );
    }
    let tenth = Number::of(1) / Number::of(10);
    assert_eq!(tenth.to_f64(), 0.1);
    assert!((digits.asin(&tenth).to_f64() - 0.1_f64.asin()).abs() < 2e-17);
    assert!((digits.atan(&-tenth).to_f64() + 0.1_f64.atan()).abs() < 2e-17);
}

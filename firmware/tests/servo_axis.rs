//! The servo of one pivot: duties that are right on average, no windup, and a loop that is stable on a simple plant.

mod proptest_settings;

use firmware::control::rest_mode::Stiffness;
use firmware::control::servo::{
    LoopSetpoint, PivotFeedback, PivotServo, PivotServoConfig, PivotSetpoint, ServoConfig,
};
use firmware::drivers::bridge::Duty;
use firmware::parameters::{Drive, Parameters};
use proptest::prelude::*;
use proptest_settings::settings;

/// 48 V in ADC counts.
const SUPPLY_COUNTS: f32 = 2_979.0;
const UNITS_PER_RAD: f64 = 4_294_967_296.0 / std::f64::consts::TAU;
/// Volts at the bridge for a newton metre at the ring: R / (Kt N).
const VOLT_PER_N_M: f32 = 2.1 / 3.0;

/// The reference servo on bridges without dead time.
fn config() -> PivotServoConfig {
    servos().pivots[0]
}

fn servos() -> ServoConfig {
    ServoConfig::new(&Parameters {
        drives: Parameters::REFERENCE.drives.map(|drive| Drive {
            dead_time_s: 0.0,
            ..drive
        }),
        ..Parameters::REFERENCE
    })
}

/// The full loop at a supply, ADC counts.
fn full_loop(supply_counts: f32) -> LoopSetpoint {
    LoopSetpoint {
        counts_per_volt: servos().counts_per_volt(supply_counts),
        stiffness: Stiffness::FULL,
    }
}

type Asking = (PivotSetpoint, PivotFeedback);

fn asking(torque_n_m: f32, error_rad: f64) -> Asking {
    (
        PivotSetpoint {
            platform_torque: torque_n_m,
            ..PivotSetpoint::default()
        },
        PivotFeedback {
            error: (error_rad * UNITS_PER_RAD) as i32,
            ..PivotFeedback::default()
        },
    )
}

/// One tick of a servo, its setpoint before it.
fn step(
    servo: &mut PivotServo,
    config: &PivotServoConfig,
    (setpoint, measured): &Asking,
    common: &LoopSetpoint,
) -> Duty {
    servo.feed_forward(config, setpoint);
    servo.step(config, measured, common)
}

proptest! {
    #![proptest_config(settings(60))]

    /// Whole counts, but their mean over 10,000 ticks is the voltage that was wanted, to a ten-thousandth of a count.
    #[test]
    fn duty_is_right_on_average(torque_n_m in -20.0..20.0_f32) {
        let config = config();
        let full = full_loop(SUPPLY_COUNTS);
        let mut servo = PivotServo::default();
        let mut duty = || step(&mut servo, &config, &asking(torque_n_m, 0.0), &full).0;
        // The first tick sees the torque jump, and looks ahead.
        duty();
        let mut sum = 0i64;
        let (mut least, mut most) = (i16::MAX, i16::MIN);
        for _ in 0..10_000 {
            let now = duty();
            sum += i64::from(now);
            (least, most) = (least.min(now), most.max(now));
        }
        let wanted = f64::from(torque_n_m * VOLT_PER_N_M * full.counts_per_volt);
        let mean = sum as f64 / 10_000.0;
        prop_assert!((mean - wanted).abs() < 8e-5 + 3.5e-7 * wanted.abs(), "{mean} for {wanted}");
        prop_assert!(most - least <= 1, "{least} to {most}");
    }

    #[test]
    fn full_is_never_passed(torque_n_m in -1e3..1e3_f32, error_rad in -1e-2..1e-2_f64) {
        let config = config();
        let full = full_loop(SUPPLY_COUNTS);
        let mut servo = PivotServo::default();
        for _ in 0..200 {
            let Duty(counts) = step(&mut servo, &config, &asking(torque_n_m, error_rad), &full);
            // 98 % of 4,200.
            prop_assert!(counts.abs() <= 4_116, "{counts}");
        }
    }
}

#[test]
fn saturation_does_not_wind_up() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    for sign in [1.0, -1.0] {
        let mut servo = PivotServo::default();
        for _ in 0..20_000 {
            let Duty(counts) = step(&mut servo, &config, &asking(0.0, sign * 0.01), &full);
            assert_eq!(f64::from(counts), -sign * 4_116.0);
        }
        // The error is gone: one tick sees it go, then nothing is left.
        step(&mut servo, &config, &asking(0.0, 0.0), &full);
        let Duty(counts) = step(&mut servo, &config, &asking(0.0, 0.0), &full);
        assert_eq!(counts, 0, "counts left");
    }
}

#[test]
fn an_error_that_stays_is_collected_below_saturation() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    let mut servo = PivotServo::default();
    // 1 urad: 400 / s of it for 1 s times 14,000 V/rad is 5.6 V, where proportional action gives 16 mV.
    for _ in 0..20_000 {
        step(&mut servo, &config, &asking(0.0, 1e-6), &full);
    }
    let Duty(counts) = step(&mut servo, &config, &asking(0.0, 1e-6), &full);
    let volts = f32::from(counts) / full.counts_per_volt;
    assert!((volts + 5.6).abs() < 0.026, "{volts} V");
    // A fresh start forgets it.
    servo.restart();
    assert_eq!(step(&mut servo, &config, &asking(0.0, 0.0), &full), Duty(0));
}

#[test]
fn duty_follows_the_supply() {
    let config = config();
    let first = |supply: f32| {
        let mut servo = PivotServo::default();
        step(&mut servo, &config, &asking(0.5, 0.0), &full_loop(supply)).0
    };
    let (full, half) = (first(SUPPLY_COUNTS), first(SUPPLY_COUNTS / 2.0));
    assert!(full > 0 && (half - 2 * full).abs() <= 1, "{full} {half}");
    assert_eq!(first(0.0), 0, "no supply, no drive");
}

#[test]
fn dead_time_is_made_up_for_in_the_direction_of_the_current() {
    let with = ServoConfig::new(&Parameters::REFERENCE).pivots[0];
    let without = config();
    let full = full_loop(SUPPLY_COUNTS);
    for torque_n_m in [6.0, -6.0] {
        // The mean: a duty is a whole number.
        let settled = |config: &PivotServoConfig| {
            let mut servo = PivotServo::default();
            let duties =
                (0..2_000).map(|_| step(&mut servo, config, &asking(torque_n_m, 0.0), &full).0);
            duties.skip(1_000).map(f32::from).sum::<f32>() / 1e3
        };
        // 200 ns of 25 us: 33.6 counts of 4,200.
        let more = (settled(&with) - settled(&without)) * torque_n_m.signum();
        assert!((more - 33.6).abs() <= 0.0022, "{more} counts");
    }
}

/// A ring with the platform's share behind a voltage-driven motor, no friction: the loop brings it to rest at the setpoint.
#[test]
fn the_loop_is_stable_on_a_ring() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    let mut servo = PivotServo::default();
    let (mut angle, mut rate, mut current) = (100e-6, 0.0, 0.0);
    let mut pending = 0.0;
    let step_s = 50e-6 / 8.0;
    let mut late = 0.0_f64;
    for tick in 0..4_000 {
        let duty = step(&mut servo, &config, &asking(0.0, angle), &full);
        for part in 0..8 {
            // The duty acts half a period late.
            if part == 4 {
                pending = f64::from(duty.0) / 4_200.0 * 48.0;
            }
            current += (pending - 2.1 * current - 3.0 * rate) / 0.7e-3 * step_s;
            rate += 3.0 * current / 0.035 * step_s;
            angle += rate * step_s;
        }
        if tick > 1_000 {
            late = late.max(angle.abs());
        }
    }
    // 50 ms later it is within a tenth of an encoder LSB.
    assert!(late < 7.7e-9, "{late:e} rad");
}

/// A number gone wrong somewhere above must not become full drive.
#[test]
fn what_is_no_number_asks_for_no_drive() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    let with = |setpoint| (setpoint, asking(1.0, 1e-5).1);
    for broken in [
        with(PivotSetpoint {
            rate: f32::NAN,
            ..PivotSetpoint::default()
        }),
        with(PivotSetpoint {
            acceleration: f32::NAN,
            ..PivotSetpoint::default()
        }),
        asking(f32::NAN, 1e-5),
    ] {
        let mut servo = PivotServo::default();
        step(&mut servo, &config, &asking(1.0, 1e-5), &full);
        for _ in 0..3 {
            let duty = step(&mut servo, &config, &broken, &full).0;
            assert_eq!(duty, 0, "{broken:?}");
        }
    }
}

/// The change of a torque is led by what the drive takes to follow: 72 us, and 0.7 mH over 2.1 ohm. By as much of what was learnt.
#[test]
fn what_was_learnt_leads_as_the_model_does() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    let lead = (72e-6 + 0.7e-3 / 2.1) * 20e3;
    let mut learnt = PivotServo::default();
    for _ in 0..4_000 {
        // It comes 1 urad short of what 6 N m should do.
        step(&mut learnt, &config, &asking(6.0, -1e-6), &full);
        learnt.learn(&config);
    }
    let mut torques = Vec::new();
    for mut servo in [PivotServo::default(), learnt] {
        servo.restart();
        let [first, then] = [0, 1].map(|_| step(&mut servo, &config, &asking(4.0, 0.0), &full).0);
        let ratio = f64::from(first) / f64::from(then);
        assert!((ratio / (1.0 + lead) - 1.0).abs() < 2.41e-3, "{ratio}");
        torques.push(then);
    }
    assert!(torques[1] > torques[0] + 10, "{torques:?}");
}

/// The voltage that learning adds for what the integral collects: as the square of the torque, 1 at 6 N m, and never more than 350 1/s
/// of the velocity gain, which with the reference's gains is the integral's own.
#[test]
fn what_learning_adds_is_bounded_whatever_the_torque() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    for (torque_n_m, expected) in [(3.0, 0.25), (5.4, 0.81), (12.0, 1.0), (30.0, 1.0)] {
        let mut servo = PivotServo::default();
        for _ in 0..10 {
            step(&mut servo, &config, &asking(torque_n_m, -1e-4), &full);
        }
        servo.skip_learning();
        let before = servo.integral_volts();
        step(&mut servo, &config, &asking(torque_n_m, -1e-4), &full);
        servo.learn(&config);
        let collected = servo.integral_volts() - before;
        let added = servo.learnt().weights[1] * torque_n_m / collected;
        println!("{torque_n_m} N m: {added}");
        assert!((added - expected).abs() < 1e-3, "{torque_n_m} N m: {added}");
    }
}

/// The rate and the current's size say that the motor constant is off; servo off and on does not take that away.
#[test]
fn a_restart_keeps_what_the_current_has_told() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    let mut servo = PivotServo::default();
    for _ in 0..2_000 {
        let (mut setpoint, mut measured) = asking(2.0, 0.0);
        setpoint.rate = 5.0;
        measured.current_counts = 400;
        step(&mut servo, &config, &(setpoint, measured), &full);
        servo.learn(&config);
    }
    let learnt = *servo.learnt();
    assert!(learnt.motor_constant_excess.abs() > 0.02, "{learnt:?}");
    servo.restart();
    assert_eq!(*servo.learnt(), learnt);
}

/// What a table of iterative learning holds at its end goes over to the integral: not a count of the duty changes, and nothing is learnt.
#[test]
fn what_is_taken_over_is_no_step() {
    let config = config();
    let full = full_loop(SUPPLY_COUNTS);
    let mut servo = PivotServo::default();
    let with = |added_volts| {
        let (setpoint, mut measured) = asking(1.0, 0.0);
        measured.added_volts = added_volts;
        (setpoint, measured)
    };
    step(&mut servo, &config, &with(2.0), &full);
    let Duty(before) = step(&mut servo, &config, &with(2.0), &full);
    servo.take_over(&config, 2.0);
    for _ in 0..10 {
        let Duty(after) = step(&mut servo, &config, &with(0.0), &full);
        assert!(after.abs_diff(before) <= 1, "{before} {after}");
        servo.learn(&config);
    }
    assert_eq!(servo.learnt().weights, [0.0; 3]);
}

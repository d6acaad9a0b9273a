//! What shapes the loop, against independent computations in double precision: filters by their transfer functions, the carried inertia
//! by the kinetic energy, the ripple's voltage by the winding's equation.

mod proptest_settings;

use firmware::control::servo::{FilterConfig, Filters, RippleConfig, ServoConfig, carried_inertia};
use firmware::parameters::{
    FeedbackFilters, HARMONICS, Harmonic, Lead, Notch, Parameters, Platform,
};
use kinematics::{Angle, Pose, Twist, inverse, pivot_rates};
use proptest::prelude::*;
use proptest_settings::settings;
use std::f64::consts::{PI, TAU};

const RATE_HZ: f64 = 20_000.0;

/// A complex number.
type Complex = [f64; 2];

fn product([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn quotient(a: Complex, [c, d]: Complex) -> Complex {
    let square = c * c + d * d;
    product(a, [c / square, -d / square])
}

/// Where the bilinear transform puts a frequency, over where it puts another.
fn warped(hz: f64) -> f64 {
    (PI * hz / RATE_HZ).tan()
}

/// `((s/w)^2 + g b s/w + 1) / ((s/w)^2 + b s/w + 1)`, b the width over the centre.
fn notch(notch: &Notch, hz: f64) -> Complex {
    let x = warped(hz) / warped(notch.frequency_hz);
    let b = notch.width_hz / notch.frequency_hz;
    quotient([1.0 - x * x, notch.gain * b * x], [1.0 - x * x, b * x])
}

fn lead(lead: &Lead, hz: f64) -> Complex {
    quotient(
        [1.0, warped(hz) / warped(lead.from_hz)],
        [1.0, warped(hz) / warped(lead.to_hz)],
    )
}

/// Gain and phase of the filters at a frequency, of the tick's own code.
fn measured(filters: &FeedbackFilters, hz: f64) -> Complex {
    let config = FilterConfig::new(filters, RATE_HZ);
    let mut state = Filters::default();
    let (mut re, mut im) = (0.0, 0.0);
    // A second settles the narrowest; then whole periods.
    let ticks = 20_000_u32;
    for tick in 0..2 * ticks {
        let phase = TAU * hz / RATE_HZ * f64::from(tick);
        let out = f64::from(state.step(&config, phase.sin() as f32));
        if tick >= ticks {
            re += out * phase.sin();
            im += out * phase.cos();
        }
    }
    [re, im].map(|sum| sum * 2.0 / f64::from(ticks))
}

proptest! {
    #![proptest_config(settings(200))]

    #[test]
    fn filters_have_their_transfer_functions(
        centres in (100.0..4_000.0_f64, 100.0..4_000.0_f64),
        widths in (20.0..1_000.0_f64, 20.0..1_000.0_f64),
        gains in (0.0..1.0_f64, 0.0..1.0_f64),
        from_hz in 100.0..1_000.0_f64,
        above in 1.5..8.0_f64,
        hz in 1_u32..8_000,
    ) {
        let filters = FeedbackFilters {
            notches: [
                Notch { frequency_hz: centres.0, width_hz: widths.0, gain: gains.0 },
                Notch { frequency_hz: centres.1, width_hz: widths.1, gain: gains.1 },
            ],
            lead: Lead { from_hz, to_hz: from_hz * above },
        };
        let hz = f64::from(hz);
        let [first, second] = &filters.notches;
        let exact = product(product(notch(first, hz), notch(second, hz)), lead(&filters.lead, hz));
        let got = measured(&filters, hz);
        let off = (got[0] - exact[0]).hypot(got[1] - exact[1]);
        prop_assert!(off < 6e-4, "{hz} Hz: {got:?} for {exact:?}");
    }

    #[test]
    fn the_carried_inertia_is_twice_the_energy_of_a_pivot_at_1_rad_s(
        radius in 0.0..0.8_f64,
        direction in -PI..PI,
        theta in -PI..PI,
        payload_kg in 0.0..10.0_f64,
        centre_mm in (-60.0..60.0_f64, -60.0..60.0_f64),
        pivot in 0_usize..3,
    ) {
        let mut parameters = Parameters::REFERENCE;
        parameters.platform.payload_kg = payload_kg;
        parameters.platform.payload_inertia_kg_m2 = payload_kg * 1e-3;
        parameters.platform.payload_centre_mm = [centre_mm.0, centre_mm.1];
        let pose = Pose { x: radius * direction.cos(), y: radius * direction.sin(), theta };
        let guides = inverse(&pose).expect("inside the disk").guides;
        // The Jacobian's columns, and the twist (track radii and rad) that turns one pivot alone.
        let column = |x, y, theta| pivot_rates(&guides, &Twist { x, y, theta });
        let columns = [column(1.0, 0.0, 0.0), column(0.0, 1.0, 0.0), column(0.0, 0.0, 1.0)];
        let twist = solved(&columns, pivot);
        let exact = 2.0 * energy(&parameters.platform, theta, twist);
        let body = ServoConfig::new(&parameters).body;
        let lengths = [0, 1, 2].map(|i| guides[i].rho() as f32);
        let cosines = [0, 1, 2].map(|i| guides[i].cosine as f32);
        let got = f64::from(carried_inertia(&body, &lengths, &cosines, pivot));
        prop_assert!((got - exact).abs() < 1.2e-6 * exact.max(0.01), "{got} for {exact}");
    }

    #[test]
    fn the_ripples_voltage_drives_the_current_against_it(
        periods in 1_u32..3_000,
        amplitude_n_m in 0.001..0.2_f64,
        phase_deg in -360.0..360.0_f64,
        turns in -1_000.0..1_000.0_f64,
        rate in -10.0..10.0_f64,
    ) {
        let drive = Parameters::REFERENCE.drives[0];
        let latency_s = Parameters::REFERENCE.servo.latency_s;
        let mut harmonics = [Harmonic { periods: 0.0, amplitude_n_m: 0.0, phase_deg: 0.0 }; HARMONICS];
        harmonics[2] = Harmonic { periods: f64::from(periods), amplitude_n_m, phase_deg };
        let config = RippleConfig::new(&harmonics, &drive, latency_s);
        let got = f64::from(config.volts(Angle::from_units((turns * 4_294_967_296.0) as i64), rate as f32));
        // R i + L di/dt at the angle at which it acts, the derivative by a difference.
        let current = |time_s: f64| {
            let angle = turns * TAU + rate * (time_s + latency_s);
            let torque = amplitude_n_m * (f64::from(periods) * angle + phase_deg.to_radians()).sin();
            -torque / (drive.torque_constant_n_m_a * drive.gear_ratio)
        };
        const STEP_S: f64 = 1e-7;
        let slope = (current(STEP_S) - current(-STEP_S)) / (2.0 * STEP_S);
        let exact = drive.resistance_ohm * current(0.0) + drive.inductance_h * slope;
        let scale = amplitude_n_m * (1.0 + rate.abs() * f64::from(periods) / 3_000.0);
        prop_assert!((got - exact).abs() < 2e-5 * scale, "{got} for {exact}");
    }
}

/// The combination of the columns that is 1 at `row` and 0 elsewhere, by Cramer's rule.
fn solved(columns: &[[f64; 3]; 3], row: usize) -> [f64; 3] {
    let unit = [0, 1, 2].map(|i| f64::from(u8::from(i == row)));
    let whole = determinant(columns);
    [0, 1, 2].map(|k| {
        let mut replaced = *columns;
        replaced[k] = unit;
        determinant(&replaced) / whole
    })
}

fn determinant([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Kinetic energy, J, of platform and payload for a twist in track radii and rad a second.
fn energy(platform: &Platform, theta: f64, [x, y, turning]: [f64; 3]) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let [a, b] = platform.payload_centre_mm.map(|mm| mm * 1e-3);
    let arm = [a * cos - b * sin, a * sin + b * cos];
    let [x, y] = [x * 0.1, y * 0.1];
    let payload = (x - turning * arm[1]).powi(2) + (y + turning * arm[0]).powi(2);
    0.5 * (platform.mass_kg * (x * x + y * y)
        + platform.payload_kg * payload
        + (platform.inertia_kg_m2 + platform.payload_inertia_kg_m2) * turning * turning)
}

/// Off means off: the value itself, to the bit.
#[test]
fn without_filters_nothing_changes() {
    let config = FilterConfig::new(&FeedbackFilters::NONE, RATE_HZ);
    let mut state = Filters::default();
    for value in [1.0_f32, -2.5e-7, 47.3, 0.0] {
        assert_eq!(state.step(&config, value).to_bits(), value.to_bits());
    }
}

/// A share that was in force does not stay when it is switched off.
#[test]
fn gains_that_are_not_scheduled_are_those_that_were_set() {
    let mut parameters = Parameters::REFERENCE;
    let share = |parameters: &Parameters| {
        ServoConfig::new(parameters).scheduled_share(&[1.0; 3], &[1.0; 3], 0)
    };
    parameters.servo.scheduled_inertia_kg_m2 = 0.1;
    assert!(share(&parameters) < 0.5);
    parameters.servo.scheduled_inertia_kg_m2 = 0.0;
    assert_eq!(share(&parameters), 1.0);
}

mod machine;
use commissioning::chain::*;
use commissioning::drive_model::Electrical;
use commissioning::tuning::*;
use machine::*;
#[test]
fn look() {
    let el = [Electrical { resistance_ohm: 2.1, inductance_h: 0.7e-3, motor_constant: 3.0, dead_time_v: 0.38, deviations: [0.0; 4] }; 3];
    for (mass, inertia, moment, x) in [(0.03, 0.02, 0.0, 0.0), (0.03, 0.02, 0.0, 0.76), (0.08, 0.02 + 0.00625 + 5.0 * 0.0004, 5.0 * 0.02 * 0.1, 0.0)] {
        let chain = Chain { motor_inertia: 0.012, ring_inertia: 0.008, stiffness: 7.46e5, damping: 3.2, viscous: 0.05, guide_stiffness: 1e8, guide_damping: 0.0, along_stiffness: 0.0, along_damping: 0.0,
            load: Load { mass, inertia, moment: [moment, 0.0] } };
        let place = Place::new(x, 0.0).unwrap();
        println!("{:?}", chain.resonances_hz(&place));
        let plant = Plant::from_model(&el, &chain, &place, &TIMING);
        let notch = |part: f64| Notch { frequency_hz: 1500.0 * part, width_hz: 450.0, gain: 0.3 };
        let shaped = |kv: f64, kp: f64, ki: f64| PivotGains { velocity_v_s_rad: kv, position_1_s: kp, integral_v_rad: kv * ki, notches: [notch(0.95), notch(1.12)], lead: Lead { from_hz: 2.1 / 0.7e-3 / std::f64::consts::TAU, to_hz: 3000.0 } };
        for (name, g, sch) in [("as it comes", PivotGains { velocity_v_s_rad: 40.0, position_1_s: 400.0, integral_v_rad: 14000.0, notches: [Notch::NONE; 2], lead: Lead::NONE }, 0.0),
            ("shaped", shaped(43.0, 650.0, 720.0), 0.0358), ("load", shaped(33.0, 520.0, 560.0), 0.0358)] {
            let gains = Gains { pivots: [g; 3], scheduled_inertia_kg_m2: sch };
            let m = margins(&plant, &gains, 50e-6);
            let s = sensitivity(&plant, &gains, 50e-6);
            let own = s.iter().zip(&plant.hz).map(|(s, hz)| (s[(0, 0)].norm(), *hz)).fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
            let at30 = s[plant.hz.iter().position(|&hz| hz >= 30.0).unwrap()][(0, 0)].norm();
            println!("{name} {x} {mass}: {m:.3?} own {own:.2?} {at30:.4}");
        }
        let t = std::time::Instant::now();
        let tuned = tune(&[plant], &el, &chain.resonances_hz(&place), 0.0, &TIMING, &Limits::USUAL);
        println!("{:?} {tuned:.3?}", t.elapsed());
    }
}

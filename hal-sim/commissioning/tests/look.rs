mod machine;
use commissioning::frequency_response::frequency_response;
use commissioning::drive_model::*;
use commissioning::chain::*;
use machine::*;
#[test]
fn look() {
    for seed in [1_u64, 2, 3, 4] {
        let m = unknown(seed);
        let t = std::time::Instant::now();
        let (runs, bench) = excite(&m, &PLAN);
        println!("sim {:?}", t.elapsed());
        let lines = frequency_response(&runs, &TIMING).unwrap();
        let p = &m.plant;
        let warm = bench.stage.plant.windings_warmer_k();
        let t = std::time::Instant::now();
        let guess = Guess(Chain { motor_inertia: 0.012, ring_inertia: 0.008, stiffness: 7.46e5, damping: 3.2, viscous: 0.05, guide_stiffness: 3e5, guide_damping: 1.7, along_stiffness: 1000.0, along_damping: 0.8,
            load: Load { mass: 0.05, inertia: 0.025, moment: [0.0, 0.0] } });
        let model = drive_model(&runs, &lines, &TIMING, &Known { knee_a: 0.043, guess, to_hz: 2500.0 }).unwrap();
        let el = model.electrical;
        println!("electrical {:?}", t.elapsed());
        for i in 0..3 {
            let gs = m.analog.supply_gain; let gi = m.analog.current_gain[i];
            let r = p.resistance_ohm * (1.0 + 0.0039 * warm[i]) * gs / gi;
            let l = p.inductance_h * gs / gi;
            let k = 50.0 * p.torque_constant_n_m_a * gs;
            let e = el[i];
            println!("R {:+.2}% L {:+.2}% K {:+.2}% dead {:.3} dev {:?}", 100.0 * (e.resistance_ohm / r - 1.0), 100.0 * (e.inductance_h / l - 1.0), 100.0 * (e.motor_constant / k - 1.0), e.dead_time_v, e.deviations.map(|d| (d * 1e5).round() / 1e5));
        }
        let pl = &p.payload;
        let g = m.analog.supply_gain * m.analog.current_gain.iter().sum::<f64>() / 3.0;
        let (sx, sy) = (pl.mass_kg * pl.eccentricity_m * 0.1 * pl.direction_rad.cos(), pl.mass_kg * pl.eccentricity_m * 0.1 * pl.direction_rad.sin());
        let truth = Chain { motor_inertia: p.motor_inertia_kg_m2, ring_inertia: p.ring_inertia_kg_m2, stiffness: p.transmission_stiffness_n_m_rad, damping: p.transmission_damping_n_m_s_rad, viscous: p.ring_friction.viscous,
            guide_stiffness: p.guide_stiffness_n_m * 0.01, guide_damping: p.guide_damping_n_s_m * 0.01, along_stiffness: p.guide_friction.coulomb / 20e-6 * 0.01, along_damping: 0.77,
            load: Load { mass: 0.01 * (p.platform_mass_kg + pl.mass_kg), inertia: p.platform_inertia_kg_m2 + pl.inertia_kg_m2 + pl.mass_kg * pl.eccentricity_m.powi(2), moment: [sx, sy] } };
        let f = model.mechanical;
        println!("fit {:?}; residual {} ", t.elapsed(), f.residual);
        println!("truth {truth:?}\nfound {:?}", f.chain);
        println!("deviations {:?}", f.deviations.iter().map(|d| (d*1e4).round()/1e4).collect::<Vec<_>>());
        let (a, b) = (truth.inertia(&Place::centre()), f.chain.inertia(&Place::centre()));
        println!("J11 {:+.2}% trans+rot; drive J {:+.2}% m {:+.2}% I {:+.2}% gain {:+.2}", 100.0*(b[(0,0)]/a[(0,0)]/g-1.0), 100.0*((f.chain.motor_inertia+f.chain.ring_inertia)/(truth.motor_inertia+truth.ring_inertia)/g-1.0), 100.0*(f.chain.load.mass/truth.load.mass/g-1.0), 100.0*(f.chain.load.inertia/truth.load.inertia/g-1.0), 100.0*(g-1.0));
        println!("res truth {:.0?}\n    found {:.0?}", truth.resonances_hz(&Place::centre()), f.chain.resonances_hz(&Place::centre()));
    }
}

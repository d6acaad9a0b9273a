//! What a fit takes, by instrument: `cargo bench -p hal-sim --bench fit`. The goal is 2 s for 600 visits and 240 unknowns.

use std::time::Instant;

use calibration::plan::stops;
use calibration::{Instrument, Kit, MACHINE_NUMBERS, Noise, fit};
use hal_sim::machine::instruments::{survey, workshop};
use hal_sim::random::Random;

const RADIUS_M: f64 = 0.1;
const VISITS: usize = 600;
/// Machines, one after the other: what takes a fit longest is how often it begins again without outliers.
const MACHINES: u64 = 5;

fn main() {
    println!("| kit | visits | rows | unknowns | s, median of {MACHINES} machines | worst |");
    println!("|---|---|---|---|---|---|");
    for kit in [Kit::Xyt, Kit::Xy, Kit::Camera2, Kit::Ends] {
        let noise = Noise {
            length: 50e-9 / RADIUS_M,
            angle_rad: 1e-6,
            encoder_rad: Noise::ENCODER_RAD,
        };
        let instrument = Instrument::new(kit, noise);
        let stops = stops(&instrument, 0, VISITS);
        let mut unknowns = 0;
        let mut seconds: Vec<f64> = (1..=MACHINES)
            .map(|seed| {
                let random = &mut Random::new(1000 + seed);
                let machine = workshop::machine(seed);
                let visits = survey(&machine, &instrument, &stops, random).expect("in the disk");
                let start = Instant::now();
                let fit = fit(&instrument, &visits).expect("a fit");
                unknowns = MACHINE_NUMBERS + fit.unknowns.len();
                start.elapsed().as_secs_f64()
            })
            .collect();
        seconds.sort_by(f64::total_cmp);
        let (median, worst) = (seconds[seconds.len() / 2], seconds[seconds.len() - 1]);
        let rows = VISITS * kit.rows();
        println!("| {kit} | {VISITS} | {rows} | {unknowns} | {median:.2} | {worst:.2} |");
    }
}

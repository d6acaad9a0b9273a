//! What calibration leaves of a machine's errors, as a table: `cargo bench -p hal-sim --bench calibration`.
//!
//! Machines are drawn from seeds, measured by simulated instruments and fitted. Then poses all over the disk and all orientations are
//! commanded with the fitted numbers, and the true poses compared with what was asked for, frames and scale taken out. `MACHINES=50`
//! is the form that is published; without it there are 5. `ONLY=xyt` keeps the rows whose names contain that.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;
use std::time::Instant;

use calibration::frames::{Pair, Size, without_frames};
use calibration::position::readings_rad;
use calibration::spread::over_disk;
use calibration::{Accuracy, Fit, Instrument, Kit, Machine, Noise, Visit, fit};
use hal_sim::machine::instruments::camera::Camera;
use hal_sim::machine::instruments::interferometer::Interferometer;
use hal_sim::machine::instruments::target::Target;
use hal_sim::machine::instruments::{QuasiStatic, workshop};
use hal_sim::random::Random;

const RADIUS_M: f64 = 0.1;
const DISK: f64 = 0.8;

struct Row {
    kit: Kit,
    noise_nm: f64,
    noise_urad: f64,
    visits: usize,
}

const fn row(kit: Kit, noise_nm: f64, noise_urad: f64, visits: usize) -> Row {
    Row {
        kit,
        noise_nm,
        noise_urad,
        visits,
    }
}

const ROWS: [Row; 7] = [
    row(Kit::Xyt, 5.0, 0.1, 60),
    row(Kit::Xyt, 50.0, 1.0, 200),
    row(Kit::Xyt, 50.0, 1.0, 600),
    row(Kit::Xyt, 500.0, 10.0, 200),
    row(Kit::Camera2, 50.0, 0.0, 600),
    row(Kit::Camera2, 500.0, 0.0, 600),
    row(Kit::Xy, 50.0, 0.0, 200),
];

struct Outcome {
    size: Size,
    ratio: f64,
    chi2: f64,
    held_out: f64,
    seconds: f64,
}

fn main() {
    let machines =
        std::env::var("MACHINES").map_or(5, |text| text.parse().expect("a number of machines"));
    let only = std::env::var("ONLY").unwrap_or_default();
    println!(
        "{machines} machines a row. Errors of true poses over the whole disk and all orientations, frames and scale out."
    );
    println!();
    println!(
        "| kit | noise | visits | xy, nm rms: median / 90 % / worst | xy, nm max: median / worst | theta, urad rms: median / 90 % / worst | verified over predicted: least / median / most | chi^2 | of visits held out | fit, s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for row in &ROWS {
        if row.kit.name().contains(&only) {
            print_row(row, &outcomes(row, machines));
        }
    }
}

fn outcomes(row: &Row, machines: usize) -> Vec<Outcome> {
    let next = AtomicUsize::new(0);
    let outcomes = Mutex::new(Vec::new());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= machines {
                        break;
                    }
                    let outcome = outcome(row, seed as u64 + 1);
                    outcomes.lock().expect("no thread has failed").push(outcome);
                }
            });
        }
    });
    outcomes.into_inner().expect("no thread has failed")
}

fn outcome(row: &Row, seed: u64) -> Outcome {
    let machine = workshop::machine(seed);
    let noise = Noise {
        length: row.noise_nm * 1e-9 / RADIUS_M,
        angle_rad: row.noise_urad * 1e-6,
        encoder_rad: Noise::ENCODER_RAD,
    };
    let instrument = Instrument::new(row.kit, noise);
    let visits = measure(&machine, &instrument, row.visits, &mut Random::new(1000 + seed));
    let start = Instant::now();
    let fit = fit(&instrument, &visits).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
    let seconds = start.elapsed().as_secs_f64();
    let predicted = Accuracy::new(&fit.machine, &fit.factor, &instrument.sizes())
        .expect("a factor of full rank");
    let size = without_frames(&commanded(&machine, &fit.machine)).size();
    let Fit {
        chi2,
        chi2_held_out,
        ..
    } = fit;
    Outcome {
        size,
        ratio: size.place_rms / predicted.place_rms,
        chi2,
        held_out: chi2_held_out,
        seconds,
    }
}

fn measure(
    machine: &QuasiStatic,
    instrument: &Instrument,
    visits: usize,
    random: &mut Random,
) -> Vec<Visit> {
    let noise = instrument.noise;
    let in_m = |[x, y, theta]: [f64; 3]| [x * RADIUS_M, y * RADIUS_M, theta];
    let poses = over_disk(DISK).map(in_m).take(visits);
    let possible = "inside the disk";
    match instrument.kit {
        Kit::Xyt | Kit::Theta => {
            let beams = Interferometer::set_up(noise, random);
            (poses.map(|pose| beams.visit(machine, pose, random).expect(possible))).collect()
        }
        Kit::Xy => {
            let target = Target::set_up(noise, random);
            (poses.map(|pose| target.visit(machine, pose, random).expect(possible))).collect()
        }
        Kit::Camera | Kit::Camera2 => {
            let camera = Camera::set_up(instrument, RADIUS_M, random);
            let mut list = Vec::new();
            while list.len() < visits {
                let mark = random.index(instrument.marks.len());
                let place = random.index(instrument.cameras.len());
                let theta = random.between(-3.14, 3.14);
                let (sin, cos) = theta.sin_cos();
                let [[x, y], [cx, cy]] = [instrument.marks[mark], instrument.cameras[place]];
                let centre = [cx - cos * x + sin * y, cy - sin * x - cos * y];
                if centre[0].hypot(centre[1]) < DISK {
                    list.push(camera.visit(machine, (mark, place), theta, random).expect(possible));
                }
            }
            list
        }
    }
}

/// Poses that a controller with the fitted numbers would command, and where the true machine goes.
fn commanded(truth: &QuasiStatic, fitted: &Machine) -> Vec<Pair> {
    (over_disk(DISK).skip(5000).take(2000))
        .map(|asked| {
            let readings = readings_rad(fitted, &asked).expect("inside the disk");
            let [x, y, theta] = truth.pose(readings).expect("near by");
            Pair {
                asked,
                reached: [x / RADIUS_M, y / RADIUS_M, theta],
            }
        })
        .collect()
}

fn print_row(row: &Row, outcomes: &[Outcome]) {
    let sorted = |value: &dyn Fn(&Outcome) -> f64| {
        let mut values: Vec<f64> = outcomes.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
        [at(0.0), at(0.5), at(0.9), at(1.0)]
    };
    let nm = 1e9 * RADIUS_M;
    let [_, xy, xy_90, xy_worst] = sorted(&|outcome| outcome.size.place_rms * nm);
    let [_, max, _, max_worst] = sorted(&|outcome| outcome.size.place_max * nm);
    let [_, turn, turn_90, turn_worst] = sorted(&|outcome| outcome.size.turn_rms_rad * 1e6);
    let [least, ratio, _, most] = sorted(&|outcome| outcome.ratio);
    let [_, chi2, ..] = sorted(&|outcome| outcome.chi2);
    let [_, held_out, ..] = sorted(&|outcome| outcome.held_out);
    let [_, seconds, ..] = sorted(&|outcome| outcome.seconds);
    println!(
        "| {} | {} nm, {} urad | {} | {xy:.1} / {xy_90:.1} / {xy_worst:.1} | {max:.0} / {max_worst:.0} | {turn:.3} / {turn_90:.3} / {turn_worst:.3} | {least:.2} / {ratio:.2} / {most:.2} | {chi2:.2} | {held_out:.2} | {seconds:.2} |",
        row.kit, row.noise_nm, row.noise_urad, row.visits
    );
}

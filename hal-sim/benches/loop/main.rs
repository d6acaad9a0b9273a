//! The loop as it is measured, and what a push does, as tables: `cargo bench -p hal-sim --bench loop`.
//!
//! The stage turns slowly, so that friction is what it is in motion. A sine is added to what an encoder reads, frequency by frequency;
//! what the following error makes of it is the sensitivity S, and the loop is L = 1 / S - 1: a property of the simulated machine
//! and the program, without any equation of the plant. Crossover is the highest frequency at which |L| is 1, Ms the largest |S|.
//! A push is a torque of 1 N m on a ring of a stage at rest, with the full loop and after rest mode.
//!
//! Then Ms of each pivot over the disk, with and without a load. The body couples the three loops: what a sine on one encoder makes of all
//! three errors is a column of a matrix, whose largest singular value is what the worst combination of the three encoders' sines is raised
//! by. The diagonal alone would miss a combination that no single pivot shows.

mod case;
mod matrix;
mod sine;

use case::{Case, SHAPED, SHAPED_FOR_LOAD, Tuning};
use matrix::Peak;
use parallel::{cores, of_all};

/// The largest radius at which the reference motion works.
const RIM_MM: f64 = 76.0;
/// Places on the rim.
const RIM_PLACES: u32 = 5;

fn main() {
    let case = |words, payload_kg, x_mm, resonance_hz, tuning| Case {
        words,
        payload_kg,
        place_mm: [x_mm, 0.0],
        resonance_hz,
        tuning,
    };
    let kind = Tuning::Kind;
    let cases = [
        case("as it comes, centre", 0.0, 0.0, 1_500.0, kind),
        case("as it comes, 76 mm out", 0.0, RIM_MM, 1_500.0, kind),
        case("as it comes, 5 kg told, centre", 5.0, 0.0, 1_500.0, kind),
        case(
            "as it comes, 5 kg told, 76 mm out",
            5.0,
            RIM_MM,
            1_500.0,
            kind,
        ),
        case("shaped, centre", 0.0, 0.0, 1_500.0, SHAPED),
        case("shaped, 76 mm out", 0.0, RIM_MM, 1_500.0, SHAPED),
        case(
            "shaped, 5 kg told, centre",
            5.0,
            0.0,
            1_500.0,
            SHAPED_FOR_LOAD,
        ),
        case(
            "shaped, 5 kg told, 76 mm out",
            5.0,
            RIM_MM,
            1_500.0,
            SHAPED_FOR_LOAD,
        ),
        case(
            "resonance at 600 Hz, notch, half the gain",
            0.0,
            0.0,
            600.0,
            Tuning::Soft,
        ),
        case("reference stage, centre", 0.0, 0.0, 1_500.0, Tuning::Stage),
        case(
            "reference stage, 76 mm out",
            0.0,
            RIM_MM,
            1_500.0,
            Tuning::Stage,
        ),
    ];
    println!(
        "| loop | crossover of pivot 1, Hz | Ms at, Hz | S at 30 Hz | push of 1 N m, LSB, back within ms | the same in rest mode |"
    );
    println!("|---|---|---|---|---|---|");
    for row in of_all(&cases, cores(), Case::row) {
        println!("{row}");
    }
    println!();
    print_over_the_disk();
}

/// Ms of each pivot, place by place, and the worst of each loop.
fn print_over_the_disk() {
    let loops = [
        ("as it comes", 0.0, Tuning::Kind),
        ("as it comes, 5 kg told", 5.0, Tuning::Kind),
        ("told, firmer", 0.0, Tuning::Firmer),
        ("told, firmer, 5 kg", 5.0, Tuning::Firmer),
        ("shaped", 0.0, SHAPED),
        ("shaped, 5 kg told", 5.0, SHAPED_FOR_LOAD),
        ("reference stage", 0.0, Tuning::Stage),
    ];
    let rim = (0..RIM_PLACES).map(|k| 360.0 / f64::from(RIM_PLACES) * f64::from(k));
    let places: Vec<Option<f64>> = std::iter::once(None).chain(rim.map(Some)).collect();
    let cases: Vec<Case> = (loops.iter())
        .flat_map(|&(words, payload_kg, tuning)| {
            places.iter().map(move |place| Case {
                words,
                payload_kg,
                place_mm: place.map_or([0.0; 2], |angle_deg| {
                    let (sin, cos) = angle_deg.to_radians().sin_cos();
                    [RIM_MM * cos, RIM_MM * sin]
                }),
                resonance_hz: 1_500.0,
                tuning,
            })
        })
        .collect();
    let peaks = of_all(&cases, cores(), Case::peaks);
    println!(
        "| loop | place | Ms of pivot 1 at, Hz | of pivot 2 | of pivot 3 | all three encoders together |"
    );
    println!("|---|---|---|---|---|---|");
    let told = |peak: &Peak| format!("{:.2} at {:.0}", peak.size, peak.hz);
    let word = |place: &Option<f64>| {
        place.map_or("centre".to_owned(), |angle_deg| {
            format!("{RIM_MM} mm out at {angle_deg} deg")
        })
    };
    for (case, (place, peaks)) in cases.iter().zip(places.iter().cycle().zip(&peaks)) {
        let peaks = peaks.each_ref().map(told).join(" | ");
        println!("| {} | {} | {peaks} |", case.words, word(place));
    }
    println!();
    for (of, (words, ..)) in peaks.chunks(places.len()).zip(loops) {
        let largest = |whose: std::ops::Range<usize>| {
            let of_places = of.iter().zip(&places);
            of_places
                .flat_map(|(peaks, place)| {
                    (peaks.iter().enumerate())
                        .filter(|(i, _)| whose.contains(i))
                        .map(move |(i, peak)| (i, peak, place))
                })
                .max_by(|a, b| a.1.size.total_cmp(&b.1.size))
                .expect("there are places")
        };
        let (pivot, one, place) = largest(0..3);
        let (_, all, all_place) = largest(3..4);
        println!(
            "{words}: worst of a pivot {}, pivot {}, {}; of all together {}, {}",
            told(one),
            pivot + 1,
            word(place),
            told(all),
            word(all_place)
        );
    }
}

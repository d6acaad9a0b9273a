//! The report of a calibration, what `apply` refuses by the measurement itself, and the whole of it on an unknown machine.

mod calibrate_command;

use calibrate_command::{RADIUS_MM, assert_refused, calibrate, folder, is_done};
use std::fs;
use std::path::Path;

use calibration::plan::Stop;
use calibration::table::{note, to_text};
use calibration::{Instrument, Kit, Noise, Seen, Visit, plan};
use desk::calibrate::with_references;
use hal_sim::machine::instruments::{survey, workshop};
use hal_sim::random::Random;

const NM: f64 = RADIUS_MM * 1e6;

/// What an interferometer reads of a machine at rest, a pose every 0.6 s, and what something does to each reading.
fn measured(folder: &Path, name: &str, seed: u64, spoil: impl Fn(usize, f64, &mut Visit)) {
    let noise = Noise {
        length: 50.0 / NM,
        angle_rad: 1e-6,
        encoder_rad: Noise::ENCODER_RAD,
    };
    let instrument = Instrument::new(Kit::Xyt, noise);
    let stops: Vec<Stop> = with_references(&plan(&instrument, 200).unwrap().stops);
    let truth = workshop::machine(seed);
    let visits = survey(&truth, &instrument, &stops, &mut Random::new(9)).unwrap();
    let mut text = to_text(&instrument, &[], RADIUS_MM);
    for (visit, mut measured) in visits.into_iter().enumerate() {
        let share = visit as f64 / stops.len() as f64;
        spoil(visit, share, &mut measured);
        let is_reference = visit > 0 && stops[visit] == stops[0];
        let row = to_text(&instrument, &[measured], RADIUS_MM);
        let row = row.lines().nth(1).unwrap();
        text += &format!("{}\n{row}\n", note(visit, is_reference, 0.6 * visit as f64));
    }
    fs::write(folder.join(format!("{name}.csv")), text).unwrap();
}

fn fit(folder: &Path, name: &str) -> String {
    let (table, file) = (format!("{name}.csv"), format!("{name}.toml"));
    let noise = ["--noise", "50nm", "--noise-theta", "1urad"];
    let more = ["--serial", "SIM", "--out", &file, "--temperature", "20.5"];
    is_done(&calibrate(
        folder,
        &[&["fit", &table], &noise[..], &more].concat(),
    ))
}

fn spoil_x(measured: &mut Visit, off_nm: f64) {
    if let Seen::Pose([x, ..]) = &mut measured.seen {
        *x += off_nm / NM;
    }
}

#[test]
fn a_report_tells_all_of_it_and_of_this_calibration_alone() {
    let folder = folder("report-page");
    measured(&folder, "own", 3, |_, _, _| ());
    measured(&folder, "others", 4, |_, _, _| ());
    let told = fit(&folder, "own");
    assert!(told.contains("no more than the noise explains"), "{told}");
    is_done(&calibrate(
        &folder,
        &["report", "own.toml", "--measured", "own.csv"],
    ));
    let page = fs::read_to_string(folder.join("calibration.html")).unwrap();
    for part in [
        "<h1>Calibration of SIM</h1>",
        "20.5 deg C",
        "Errors of the machine before, by the fit",
        "What is expected to be left",
        "Not verified",
        "What is left of theta, urad",
        "harmonics of its ring",
        "The reference pose while was measured, nm",
        "Yours to choose, and no errors: base frame",
        "guide offset, um",
        "encoder cosine 12, urad",
    ] {
        assert!(page.contains(part), "'{part}' is not in the page");
    }
    // Alone: nothing is fetched.
    assert!(!page.contains("src=") && !page.contains("href="));
    assert!(!page.contains("NaN") && !page.contains("inf "));
    assert_refused(
        &calibrate(&folder, &["report", "own.toml", "--measured", "others.csv"]),
        1,
        "the calibration is not the fit of this measurement",
    );
    let verified = ["report", "own.toml", "--measured", "own.csv", "--verified"];
    assert_refused(
        &calibrate(&folder, &[&verified[..], &["own.csv"]].concat()),
        2,
        "no verification as",
    );
}

#[test]
fn what_drifted_and_what_does_not_hold_is_not_applied() {
    let folder = folder("report-apply");
    // 0.6 um in two minutes, as a machine does that becomes warmer by some tenths of a K.
    measured(&folder, "drifted", 3, |_, share, visit| {
        spoil_x(visit, 600.0 * share)
    });
    // Three standard deviations on those that the fit holds out, and on no others.
    measured(&folder, "held", 3, |visit, _, measured| {
        if [6, 13, 19].contains(&(visit % 20)) {
            let side = if visit % 3 == 0 { 150.0 } else { -150.0 };
            spoil_x(measured, side);
        }
    });
    measured(&folder, "own", 3, |_, _, _| ());
    let apply = |name: &str| {
        let (file, table) = (format!("{name}.toml"), format!("{name}.csv"));
        calibrate(&folder, &["apply", &file, "--measured", &table, "--kind"])
    };
    let told = fit(&folder, "drifted");
    println!("{told}");
    assert!(
        told.contains("more than the noise explains: something"),
        "{told}"
    );
    assert_refused(&apply("drifted"), 1, "the reference pose has moved by");
    let told = fit(&folder, "held");
    println!("{told}");
    assert_refused(
        &apply("held"),
        1,
        "poses that were held out of its fit miss by",
    );
    fit(&folder, "own");
    is_done(&apply("own"));
}

/// An unknown machine from its first start to a calibration, in full dynamics.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn an_unknown_machine_calibrates_itself() {
    let folder = folder("report-demo");
    let told = is_done(&calibrate(
        &folder,
        &["demo", "--poses", "200", "--out", "out"],
    ));
    println!("{told}");
    for file in [
        "report.html",
        "error-maps.png",
        "calibration.toml",
        "measured.csv",
    ] {
        assert!(folder.join("out").join(file).exists(), "{file}");
    }
    let page = fs::read_to_string(folder.join("out/report.html")).unwrap();
    assert!(page.contains("Before calibration: ") && page.contains("Seen, with it"));
    let number = |line: &str| -> f64 {
        let line = told
            .lines()
            .find(|told| told.starts_with(line))
            .expect(line);
        line[24..]
            .split([' ', ','])
            .next()
            .unwrap()
            .parse()
            .unwrap()
    };
    let (before_um, after_um) = (number("true, as drawn"), number("true, calibrated"));
    // 82.5 and 0.157 were measured.
    assert!(
        before_um > 74.0 && after_um < 0.173,
        "{before_um} {after_um}"
    );
    let ratio = number("x and y, over predicted");
    assert!((0.7..=1.4).contains(&ratio), "{ratio}");
}

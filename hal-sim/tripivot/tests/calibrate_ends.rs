//! Ends of guides, touched by a machine that moves: `tripivot calibrate measure --kit ends`.

mod calibrate_command;

use calibrate_command::{RADIUS_MM, assert_refused, calibrate, folder, is_done};
use calibration::position::position;
use calibration::table::Table;
use calibration::{DRAWN, Noise, Seen};
use std::fs;

/// What contacts scatter by, um rms, on a machine whose guides are as drawn and end where they are drawn: measured, and a tenth more.
const MOST_SCATTER_UM: f64 = 0.99;
const POSES: &str = "12";
/// As the command is told it, track radii; none of it is in what is judged.
const NOISE: Noise = Noise {
    length: 20e-6,
    angle_rad: 40e-6,
    encoder_rad: Noise::ENCODER_RAD,
};

#[test]
fn ends_are_touched_where_they_are() {
    let folder = folder("ends");
    let measure = |more: &[&str]| {
        let arguments = ["measure", "--kind", "--kit", "ends", "--noise", "2um"];
        let all = [
            &arguments[..],
            &["--poses", POSES, "--out", "measured.csv"],
            more,
        ]
        .concat();
        calibrate(&folder, &all)
    };
    assert_refused(&measure(&["--reader", "true"]), 2, "no instrument is read");
    is_done(&measure(&[]));
    let text = fs::read_to_string(folder.join("measured.csv")).expect("it was written");
    let table = Table::from_text(&text, RADIUS_MM).expect("a measurement");
    assert_eq!(table.visits.len(), 13);
    let ends = table.instrument(NOISE).ends;
    let off_um = table.visits.iter().map(|visit| {
        let Seen::End { end } = visit.seen else {
            panic!("{visit:?}")
        };
        let (guide, place) = ends[end];
        let at = position(&DRAWN, &visit.readings_rad).expect("in reach");
        (at.contacts[guide].rho - place) * RADIUS_MM * 1e3
    });
    let off_um: Vec<f64> = off_um.collect();
    let rms_um = (off_um.iter().map(|off| off * off).sum::<f64>() / off_um.len() as f64).sqrt();
    println!("{rms_um:.2} um rms of {off_um:.2?}");
    assert!(rms_um < MOST_SCATTER_UM);
}

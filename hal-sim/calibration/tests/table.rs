//! Measured visits to a table and back.

use calibration::table::{Table, TableError, to_text};
use calibration::{Instrument, Kit, Noise, Seen, Visit};

const NOISE: Noise = Noise {
    length: 5e-7,
    angle_rad: 1e-6,
    encoder_rad: Noise::ENCODER_RAD,
};
const RADIUS_MM: f64 = 100.0;

fn close(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14)
}

#[test]
fn visits_come_back_from_their_table() {
    let mark = |mark, camera| Seen::Mark {
        mark,
        camera,
        off: [1e-6, -2e-6],
    };
    for (kit, seen) in [
        (
            Kit::Xyt,
            vec![Seen::Pose([0.1, -0.2, 0.3]), Seen::Pose([0.4, 0.5, -0.6])],
        ),
        (Kit::Xy, vec![Seen::Place([0.1, -0.2])]),
        (Kit::Theta, vec![Seen::Turn(1.25)]),
        (Kit::Camera, vec![mark(3, 0), mark(17, 0), mark(3, 0)]),
        (Kit::Camera2, vec![mark(3, 1), mark(17, 0), mark(3, 0)]),
        (Kit::Balls, vec![mark(2, 1), mark(0, 0), mark(2, 0)]),
        (Kit::Ends, vec![Seen::End { end: 4 }, Seen::End { end: 1 }]),
    ] {
        let instrument = Instrument::new(kit, NOISE);
        let visits: Vec<Visit> = (seen.into_iter())
            .map(|seen| Visit {
                readings_rad: [-0.5, 1.5, 3.5],
                seen,
            })
            .collect();
        let text = format!("# by night\n\n{}", to_text(&instrument, &visits, RADIUS_MM));
        let table = Table::from_text(&text, RADIUS_MM).expect("a table");
        assert_eq!(table.kit, kit);
        // Behind a comment, an empty line and the names.
        assert_eq!(table.lines[0], 4);
        let back = table.instrument(NOISE);
        assert_eq!(table.visits.len(), visits.len());
        for (there, here) in table.visits.iter().zip(&visits) {
            assert!(close(&there.readings_rad, &here.readings_rad));
            assert!(close(there.seen.values(), here.seen.values()), "{there:?}");
            match (there.seen, here.seen) {
                (
                    Seen::Mark { mark, camera, .. },
                    Seen::Mark {
                        mark: true_mark,
                        camera: true_camera,
                        ..
                    },
                ) => {
                    assert!(close(&back.marks[mark], &instrument.marks[true_mark]));
                    assert!(close(
                        &back.cameras[camera],
                        &instrument.cameras[true_camera]
                    ));
                }
                (Seen::End { end }, Seen::End { end: true_end }) => {
                    let ([there, here], place) =
                        ([back.ends[end], instrument.ends[true_end]], 1e-14);
                    assert!(
                        there.0 == here.0 && (there.1 - here.1).abs() < place,
                        "{there:?}"
                    );
                }
                _ => {}
            }
        }
    }
}

#[test]
fn a_guide_is_one_of_three() {
    let text = "m1_deg,m2_deg,m3_deg,guide,end_mm\n1,2,3,4,16\n";
    let error = Table::from_text(text, RADIUS_MM).expect_err("no such guide");
    let expected = TableError::Guide {
        line: 2,
        text: "4".to_owned(),
    };
    assert_eq!(error, expected);
}

//! What an instrument cannot tell, and what good poses are worth.

use calibration::frames::{Pair, without_frames};
use calibration::freedom::Freedom;
use calibration::spread::over_disk;
use calibration::{Instrument, Kit, Noise, plan};

const NOISE: Noise = Noise {
    length: 5e-7,
    angle_rad: 1e-6,
    encoder_rad: Noise::ENCODER_RAD,
};
const FRAMES: [Freedom; 6] = [
    Freedom::BaseX,
    Freedom::BaseY,
    Freedom::BaseTurn,
    Freedom::PlatformX,
    Freedom::PlatformY,
    Freedom::PlatformTurn,
];

/// As the singular values of another program's model say.
#[test]
fn freedoms_are_those_of_each_kit() {
    let with = |more: &[Freedom]| [&FRAMES[..], more].concat();
    let choices = with(&[Freedom::Scale]);
    let plate = with(&[Freedom::Scale, Freedom::PlateShear, Freedom::PlateAspect]);
    for (kit, count, named) in [
        (Kit::Xyt, 6, with(&[])),
        (Kit::Xy, 6, with(&[])),
        (Kit::Theta, 11, choices.clone()),
        (Kit::Camera, 9, plate),
        (Kit::Camera2, 7, choices.clone()),
        (Kit::Balls, 7, choices.clone()),
        (Kit::Ends, 7, choices),
    ] {
        let plan = plan(&Instrument::new(kit, NOISE), 20).expect("finite numbers");
        assert_eq!(plan.freedoms.count, count, "{kit}: {:?}", plan.freedoms);
        assert_eq!(plan.freedoms.named, named, "{kit}");
    }
}

#[test]
fn planned_poses_are_worth_more_than_as_many_others() {
    let fine = Noise {
        length: 5e-8,
        angle_rad: 1e-7,
        ..NOISE
    };
    let instrument = Instrument::new(Kit::Xyt, fine);
    let planned = plan(&instrument, 60).expect("finite numbers");
    assert_eq!(planned.stops.len(), 60);
    // 13.8 nm on a track of 100 mm, as a study by another program predicted.
    let xy_nm = planned.accuracy.place_rms * 1e8;
    assert!((12.0..16.0).contains(&xy_nm), "{xy_nm}");
    // The most telling come first: a plan of 60 begins with that of 30.
    let half = plan(&instrument, 30).expect("finite numbers");
    assert_eq!(half.stops, planned.stops[..30]);
    assert!(half.accuracy.place_rms > 2.0 * planned.accuracy.place_rms);
    // The worst place is near the rim, and worse than the mean.
    assert!(planned.accuracy.worst_place_rms > planned.accuracy.place_rms);
}

#[test]
fn only_frames_and_scale_are_taken_out_of_errors() {
    let (sin, cos) = 0.02_f64.sin_cos();
    let pair = |asked: [f64; 3], off: f64| {
        let [x, y, theta] = asked;
        let (target_sin, target_cos) = theta.sin_cos();
        let (x, y) = (
            x + 0.003 * target_cos + 0.001 * target_sin,
            y + 0.003 * target_sin - 0.001 * target_cos,
        );
        Pair {
            asked,
            reached: [
                0.004 + 1.001 * (cos * x - sin * y),
                off - 0.002 + 1.001 * (sin * x + cos * y),
                theta + 0.02 - 0.01 + 7.0 * core::f64::consts::TAU + off,
            ],
        }
    };
    let poses = || over_disk(0.8).take(500);
    let size = without_frames(&poses().map(|pose| pair(pose, 0.0)).collect::<Vec<_>>()).size();
    assert!(
        size.place_max < 1e-12 && size.turn_rms_rad < 1e-12,
        "{size:?}"
    );
    // An error that goes once around with four times theta is none of them.
    let size = without_frames(
        &poses()
            .map(|pose| pair(pose, 1e-6 * (4.0 * pose[2]).sin()))
            .collect::<Vec<_>>(),
    )
    .size();
    let rms = 1e-6 * 0.5_f64.sqrt();
    assert!((size.place_rms / rms - 1.0).abs() < 0.03, "{size:?}");
    assert!((size.turn_rms_rad / rms - 1.0).abs() < 0.03, "{size:?}");
}

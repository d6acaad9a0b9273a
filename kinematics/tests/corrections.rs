//! What is refused of a built machine: numbers out of their limits, and poses and readings that are none of it.

use kinematics::{
    Corrections, DirectError, InverseError, PivotCoefficients, Pose, Series, check_coefficients,
    corrected_direct, corrected_inverse, inverse,
};

fn machine(pivots: &[PivotCoefficients; 3]) -> Corrections<f64, Series<f64>> {
    Corrections::new(pivots, Series::new).expect("within the limits")
}

#[test]
fn impossible_poses_and_readings_are_errors() {
    let mut built = PivotCoefficients::IDEAL;
    built.guide_offset = 0.01;
    let machine = machine(&[built; 3]);
    let at = |x, y| Pose { x, y, theta: 0.0 };
    let error = |pose| corrected_inverse(&pose, &machine).expect_err("no pose");
    assert_eq!(error(at(f64::NAN, 0.0)), InverseError::NotFinite);
    assert_eq!(error(at(0.0, 1.0)), InverseError::OutsideTrack);
    // Inside the track, but guide 2 passes outside of its ring.
    assert_eq!(error(at(-0.995, 0.0)), InverseError::OutsideTrack);
    assert!(inverse(&at(-0.995, 0.0)).is_ok());
    let encoders = |encoders: [f64; 3]| corrected_direct::<f64, _>(&encoders, &machine, 2);
    assert_eq!(
        encoders([f64::INFINITY, 0.0, 0.0]),
        Err(DirectError::NotFinite)
    );
    assert_eq!(encoders([0.0; 3]), Err(DirectError::Singular));
    // Of the drawn machine they are readings just inside the track; of this one of none.
    let rim = inverse(&at(-0.999, 0.0)).expect("inside the track").pivots;
    assert_eq!(encoders(rim), Err(DirectError::OutsideTrack));
}

#[test]
fn numbers_out_of_their_limits_are_named() {
    type Set = fn(&mut PivotCoefficients, f64);
    let cases: [(&str, f64, Set); 8] = [
        ("encoder_zero_rad", 3.2, |c, v| c.encoder_zero_rad = v),
        ("radius_error", 0.021, |c, v| c.radius_error = v),
        ("ring_centre", 0.021, |c, v| c.ring_centre[1] = v),
        ("guide_error_rad", 0.021, |c, v| c.guide_error_rad = v),
        ("guide_offset", 0.021, |c, v| c.guide_offset = v),
        ("encoder_rad", 2.1e-3, |c, v| c.encoder_rad[11][1] = v),
        ("runout", 2.1e-3, |c, v| c.runout[4][0] = v),
        ("straightness", 2.1e-3, |c, v| c.straightness[7] = v),
    ];
    for (name, beyond, set) in cases {
        for (value, fits) in [
            (beyond, false),
            (-beyond, false),
            (f64::NAN, false),
            (0.9 * beyond, true),
        ] {
            let mut pivots = [PivotCoefficients::IDEAL; 3];
            set(&mut pivots[2], value);
            match check_coefficients(&pivots) {
                Ok(()) => assert!(fits, "{name} {value}"),
                Err(error) => {
                    assert!(!fits, "{error}");
                    assert_eq!((error.pivot, error.name), (3, name));
                    assert!(Corrections::<f64, _>::new(&pivots, Series::<f64>::new).is_err());
                }
            }
        }
    }
}

/// One number of 48 at a time makes a machine that is not as drawn.
#[test]
fn no_number_is_zero_by_mistake() {
    let zero = [PivotCoefficients::IDEAL; 3];
    assert!(machine(&zero).are_zero());
    let differs = |set: fn(&mut PivotCoefficients)| {
        let mut pivots = zero;
        set(&mut pivots[1]);
        !machine(&pivots).are_zero()
    };
    assert!(differs(|c| c.encoder_zero_rad = 1e-6));
    assert!(differs(|c| c.radius_error = 1e-6));
    assert!(differs(|c| c.ring_centre[0] = 1e-6));
    assert!(differs(|c| c.guide_error_rad = 1e-6));
    assert!(differs(|c| c.guide_offset = 1e-6));
    assert!(differs(|c| c.encoder_rad[11][0] = 1e-6));
    assert!(differs(|c| c.runout[0][1] = 1e-6));
    assert!(differs(|c| c.straightness[0] = 1e-6));
}

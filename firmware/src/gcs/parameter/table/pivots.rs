//! Parameters that each pivot has of its own. One identifier means all three, and one each means one: the second digit from the right.

use super::super::descriptor::{GetOfPivot, Kind, Parameter, SetOfPivot, ValueSource};
use super::{DRIVE, Group, LEARNT_GROUP, RIPPLE_GROUP, SERVO, SUBDIVISION_GROUP};
use crate::parameters::{Drive, FeedbackFilters, Gains, GearError, Learnt, Ripple, Subdivision};

/// What a pivot has.
pub(super) struct OfPivot {
    group: Group,
    kind: Kind,
    id: u32,
    text: &'static str,
    unit: &'static str,
    range: [f64; 2],
    get: GetOfPivot,
    set: SetOfPivot,
}

/// Pivots.
const PIVOTS: usize = 3;

/// The parameters of all pivots together, then those of pivot 1, 2 and 3.
pub(super) const fn of_pivots<const N: usize>(list: &[OfPivot]) -> [Parameter; N] {
    let mut all = [list[0].parameter(None); N];
    let mut place = 0;
    while place < N {
        let (whose, one) = (place / list.len(), &list[place % list.len()]);
        all[place] = one.parameter(if whose == 0 { None } else { Some(whose - 1) });
        place += 1;
    }
    assert!(N == (PIVOTS + 1) * list.len());
    all
}

impl OfPivot {
    const fn parameter(&self, pivot: Option<usize>) -> Parameter {
        let (id, source) = match pivot {
            None => (self.id, ValueSource::AllPivots(self.get, self.set)),
            Some(i) => (
                self.id + 0x10 * (i as u32 + 1),
                ValueSource::Pivot(i, self.get, self.set),
            ),
        };
        Parameter {
            id,
            kind: self.kind,
            ..self
                .group
                .float(id, self.text, self.unit, self.range, source)
        }
    }
}

const fn of_pivot(
    group: Group,
    id: u32,
    text: &'static str,
    unit: &'static str,
    range: [f64; 2],
    (get, set): (GetOfPivot, SetOfPivot),
) -> OfPivot {
    OfPivot {
        group,
        kind: Kind::Float,
        id,
        text,
        unit,
        range,
        get,
        set,
    }
}

impl OfPivot {
    /// A whole number.
    const fn whole(self) -> Self {
        Self {
            kind: Kind::Int,
            ..self
        }
    }
}

/// A field of what a pivot has. An index that no pivot has is none of the table's.
macro_rules! at {
    ($($list:ident).+ [$owner:ty] $($field:tt)+) => {
        (
            |p, pivot| p.$($list).+.get(pivot).map_or(0.0, |of_pivot: &$owner| of_pivot.$($field)+),
            |p, pivot, value| {
                if let Some(of_pivot) = p.$($list).+.get_mut(pivot) {
                    of_pivot.$($field)+ = value;
                }
            },
        )
    };
}

#[rustfmt::skip]
pub(super) const GAINS: &[OfPivot] = &[
    of_pivot(SERVO, 0x5450_0300, "position gain", "1/s", [0.0, 2_000.0], at!(servo.gains[Gains] position_1_s)),
    of_pivot(SERVO, 0x5450_0301, "velocity gain", "V s/rad", [0.0, 500.0], at!(servo.gains[Gains] velocity_v_s_rad)),
    of_pivot(SERVO, 0x5450_0302, "integral gain", "V/rad", [0.0, 200_000.0], at!(servo.gains[Gains] integral_v_rad)),
    of_pivot(SERVO, 0x5450_0340, "centre of notch 1, 0 for none", "Hz", [0.0, 9_000.0], at!(servo.filters[FeedbackFilters] notches[0].frequency_hz)),
    of_pivot(SERVO, 0x5450_0341, "width of notch 1", "Hz", [1.0, 9_000.0], at!(servo.filters[FeedbackFilters] notches[0].width_hz)),
    of_pivot(SERVO, 0x5450_0342, "gain of notch 1 at its centre", "", [0.0, 1.0], at!(servo.filters[FeedbackFilters] notches[0].gain)),
    of_pivot(SERVO, 0x5450_0343, "centre of notch 2, 0 for none", "Hz", [0.0, 9_000.0], at!(servo.filters[FeedbackFilters] notches[1].frequency_hz)),
    of_pivot(SERVO, 0x5450_0344, "width of notch 2", "Hz", [1.0, 9_000.0], at!(servo.filters[FeedbackFilters] notches[1].width_hz)),
    of_pivot(SERVO, 0x5450_0345, "gain of notch 2 at its centre", "", [0.0, 1.0], at!(servo.filters[FeedbackFilters] notches[1].gain)),
    of_pivot(SERVO, 0x5450_0346, "frequency from which a lead raises the gain, 0 for none", "Hz", [0.0, 9_000.0], at!(servo.filters[FeedbackFilters] lead.from_hz)),
    of_pivot(SERVO, 0x5450_0347, "frequency up to which it does", "Hz", [10.0, 9_000.0], at!(servo.filters[FeedbackFilters] lead.to_hz)),
];

#[rustfmt::skip]
pub(super) const DRIVES: &[OfPivot] = &[
    of_pivot(DRIVE, 0x5450_0800, "torque constant of a motor", "N m/A", [1e-3, 2.0], at!(drives[Drive] torque_constant_n_m_a)),
    of_pivot(DRIVE, 0x5450_0801, "motor turns per ring turn", "", [1.0, 1_000.0], at!(drives[Drive] gear_ratio)),
    of_pivot(DRIVE, 0x5450_0802, "winding resistance", "ohm", [0.05, 100.0], at!(drives[Drive] resistance_ohm)),
    of_pivot(DRIVE, 0x5450_0803, "winding inductance", "H", [1e-6, 0.1], at!(drives[Drive] inductance_h)),
    of_pivot(DRIVE, 0x5450_0804, "dead time of a leg", "s", [0.0, 2e-6], at!(drives[Drive] dead_time_s)),
    of_pivot(DRIVE, 0x5450_0805, "current from which the whole dead time counts", "A", [1e-3, 10.0], at!(drives[Drive] dead_time_knee_a)),
    of_pivot(DRIVE, 0x5450_0807, "inertia of a ring with its drive", "kg m^2", [1e-5, 2.0], at!(drives[Drive] inertia_kg_m2)),
    of_pivot(DRIVE, 0x5450_0808, "viscous friction of a ring", "N m s/rad", [0.0, 5.0], at!(drives[Drive] viscous_n_m_s)),
    of_pivot(DRIVE, 0x5450_0809, "Coulomb friction of a ring", "N m", [0.0, 5.0], at!(drives[Drive] coulomb_n_m)),
    of_pivot(DRIVE, 0x5450_080A, "presliding of a ring", "rad", [1e-6, 0.1], at!(drives[Drive] presliding_rad)),
    of_pivot(DRIVE, 0x5450_0840, "what of the inertia is the motor's with its side of the gear", "kg m^2", [1e-6, 2.0], at!(drives[Drive] motor_inertia_kg_m2)),
];

#[rustfmt::skip]
pub(super) const RIPPLE: &[OfPivot] = &[
    of_pivot(RIPPLE_GROUP, 0x5450_0A00, "periods of ripple 1 in a turn of the ring", "", [0.0, 100_000.0], at!(servo.ripple[Ripple] harmonics[0].periods)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A01, "amplitude of ripple 1, 0 for none", "N m", [0.0, 5.0], at!(servo.ripple[Ripple] harmonics[0].amplitude_n_m)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A02, "phase of ripple 1 at pivot angle 0, of a sine", "deg", [-360.0, 360.0], at!(servo.ripple[Ripple] harmonics[0].phase_deg)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A03, "periods of ripple 2 in a turn of the ring", "", [0.0, 100_000.0], at!(servo.ripple[Ripple] harmonics[1].periods)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A04, "amplitude of ripple 2, 0 for none", "N m", [0.0, 5.0], at!(servo.ripple[Ripple] harmonics[1].amplitude_n_m)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A05, "phase of ripple 2 at pivot angle 0, of a sine", "deg", [-360.0, 360.0], at!(servo.ripple[Ripple] harmonics[1].phase_deg)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A06, "periods of ripple 3 in a turn of the ring", "", [0.0, 100_000.0], at!(servo.ripple[Ripple] harmonics[2].periods)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A07, "amplitude of ripple 3, 0 for none", "N m", [0.0, 5.0], at!(servo.ripple[Ripple] harmonics[2].amplitude_n_m)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A08, "phase of ripple 3 at pivot angle 0, of a sine", "deg", [-360.0, 360.0], at!(servo.ripple[Ripple] harmonics[2].phase_deg)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A09, "periods of ripple 4 in a turn of the ring", "", [0.0, 100_000.0], at!(servo.ripple[Ripple] harmonics[3].periods)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A0A, "amplitude of ripple 4, 0 for none", "N m", [0.0, 5.0], at!(servo.ripple[Ripple] harmonics[3].amplitude_n_m)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A0B, "phase of ripple 4 at pivot angle 0, of a sine", "deg", [-360.0, 360.0], at!(servo.ripple[Ripple] harmonics[3].phase_deg)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A0C, "cyclic error of the gear once a turn of the motor, 0 for none; in place of one of the ripples", "urad", [0.0, 5_000.0], at!(servo.gear_errors[GearError] amplitude_urad)),
    of_pivot(RIPPLE_GROUP, 0x5450_0A0D, "phase of the cyclic error at pivot angle 0, of a sine", "deg", [-360.0, 360.0], at!(servo.gear_errors[GearError] phase_deg)),
];

#[rustfmt::skip]
pub(super) const LEARNT: &[OfPivot] = &[
    of_pivot(LEARNT_GROUP, 0x5450_0B00, "learnt voltage for the rate, besides the model's", "V s/rad", [-20.0, 20.0], at!(learnt[Learnt] rate_v_s_rad)),
    of_pivot(LEARNT_GROUP, 0x5450_0B01, "learnt voltage for the torque, besides the model's", "V/(N m)", [-20.0, 20.0], at!(learnt[Learnt] torque_v_n_m)),
    of_pivot(LEARNT_GROUP, 0x5450_0B02, "learnt voltage against friction, besides the model's", "V", [-30.0, 30.0], at!(learnt[Learnt] friction_v)),
    of_pivot(LEARNT_GROUP, 0x5450_0B03, "what the motor constant at the ring is more than the model has it, by the measured current", "V s/rad", [-50.0, 50.0], at!(learnt[Learnt] motor_constant_v_s_rad)),
];

/// The same of a whole number.
macro_rules! whole {
    ($number:ty: $list:ident [$owner:ty] $($field:tt)+) => {
        (
            |p, pivot| p.$list.get(pivot).map_or(0.0, |of_pivot: &$owner| f64::from(of_pivot.$($field)+)),
            |p, pivot, value| {
                if let Some(of_pivot) = p.$list.get_mut(pivot) {
                    of_pivot.$($field)+ = value as $number;
                }
            },
        )
    };
}

#[rustfmt::skip]
pub(super) const SUBDIVISION: &[OfPivot] = &[
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E00, "periods of an encoder's scale in a turn, 0 for unknown", "", [0.0, 100_000.0], whole!(u32: subdivision[Subdivision] periods)).whole(),
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E01, "amplitude of an encoder's error with 1 sine in a period of its scale, 0 for none", "nrad", [0.0, 10_000.0], whole!(u16: subdivision[Subdivision] harmonics[0].amplitude_nrad)).whole(),
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E02, "phase of that error at reading 0, of a sine", "0.1 deg", [-3_600.0, 3_600.0], whole!(i16: subdivision[Subdivision] harmonics[0].phase_tenths_deg)).whole(),
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E03, "amplitude of an encoder's error with 2 sines in a period of its scale, 0 for none", "nrad", [0.0, 10_000.0], whole!(u16: subdivision[Subdivision] harmonics[1].amplitude_nrad)).whole(),
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E04, "phase of that error at reading 0, of a sine", "0.1 deg", [-3_600.0, 3_600.0], whole!(i16: subdivision[Subdivision] harmonics[1].phase_tenths_deg)).whole(),
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E05, "amplitude of an encoder's error with 3 sines in a period of its scale, 0 for none", "nrad", [0.0, 10_000.0], whole!(u16: subdivision[Subdivision] harmonics[2].amplitude_nrad)).whole(),
    of_pivot(SUBDIVISION_GROUP, 0x5450_0E06, "phase of that error at reading 0, of a sine", "0.1 deg", [-3_600.0, 3_600.0], whole!(i16: subdivision[Subdivision] harmonics[2].phase_tenths_deg)).whole(),
];

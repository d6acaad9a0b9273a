//! Poses spread evenly over the disk and all orientations: no random number, and the same ones everywhere.

use core::f64::consts::TAU;

/// 1 / g, 1 / g^2 and 1 / g^3 with `g^4 = g + 1`: multiples of these, without their whole parts, fill a cube evenly.
const STEPS: [f64; 3] = [
    0.819_172_513_396_164_4,
    0.671_043_606_703_789_3,
    0.549_700_477_901_970_5,
];

/// One place of the sequence in the unit cube.
#[must_use]
pub fn in_cube(index: usize) -> [f64; 3] {
    STEPS.map(|step| (0.5 + (1 + index) as f64 * step).fract())
}

/// Poses over the disk of a radius, track radii, and one turn.
pub fn over_disk(radius: f64) -> impl Iterator<Item = [f64; 3]> {
    (0..).map(move |index| {
        let [area, around, turn] = in_cube(index);
        let (sin, cos) = (around * TAU).sin_cos();
        let r = radius * area.sqrt();
        [r * cos, r * sin, (turn - 0.5) * TAU]
    })
}

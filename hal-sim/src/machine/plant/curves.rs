//! Run-out of rings and straightness of guides, of several at once: each number is what it would be alone, and none waits for another.

/// The part of rho over which the straightness is a sum of Legendre polynomials: from the middle, over the track radius.
const STRAIGHTNESS_SPAN: f64 = 0.8;

/// A function of one variable at one place, and its first two derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Curve {
    pub value: f64,
    pub slope: f64,
    pub curvature: f64,
}

/// Run-outs by the rings' angles, of which these are sine and cosine, m. Sizes are cosines and sines of twice the angle and more.
pub(super) fn runout<const N: usize, const HARMONICS: usize>(
    sizes_m: [&[[f64; 2]; HARMONICS]; N],
    angles: [(f64, f64); N],
) -> [Curve; N] {
    let mut curves = [Curve::default(); N];
    let mut turned = angles;
    for (term, harmonic) in (0..HARMONICS).zip(2_u32..) {
        let times = f64::from(harmonic);
        for lane in 0..N {
            let (sin, cos) = angles[lane];
            let (last_sin, last_cos) = turned[lane];
            let this_sin = last_sin * cos + last_cos * sin;
            let this_cos = last_cos * cos - last_sin * sin;
            turned[lane] = (this_sin, this_cos);
            let [in_phase, across] = sizes_m[lane][term];
            let value = in_phase * this_cos + across * this_sin;
            let curve = &mut curves[lane];
            curve.value += value;
            curve.slope += times * (across * this_cos - in_phase * this_sin);
            curve.curvature -= times * times * value;
        }
    }
    curves
}

/// Straightness of guides by the places on them, m. Sizes are those of the second Legendre polynomial and more.
pub(super) fn straightness<const N: usize, const TERMS: usize>(
    sizes_m: [&[f64; TERMS]; N],
    places_m: [f64; N],
    track_radius_m: f64,
) -> [Curve; N] {
    let per_m = 1.0 / (STRAIGHTNESS_SPAN * track_radius_m);
    let x = places_m.map(|rho_m| (rho_m - track_radius_m) * per_m);
    let mut curves = [Curve::default(); N];
    // Bonnet's recursion, and P'(n+1) = P'(n-1) + (2 n + 1) P(n), from the first two polynomials.
    let mut last = [[1.0, 0.0, 0.0]; N];
    let mut this = x.map(|x| [x, 1.0, 0.0]);
    for (term, n) in (0..TERMS).zip(1_u32..) {
        let n = f64::from(n);
        let odd = 2.0 * n + 1.0;
        for lane in 0..N {
            let (before, now) = (last[lane], this[lane]);
            let next = [
                (odd * x[lane] * now[0] - n * before[0]) / (n + 1.0),
                before[1] + odd * now[0],
                before[2] + odd * now[1],
            ];
            let (size_m, curve) = (sizes_m[lane][term], &mut curves[lane]);
            curve.value += size_m * next[0];
            curve.slope += size_m * next[1] * per_m;
            curve.curvature += size_m * next[2] * per_m * per_m;
            (last[lane], this[lane]) = (now, next);
        }
    }
    curves
}

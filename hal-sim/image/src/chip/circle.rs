//! The circle that streams follow: it begins and ends where the stage is, from rest to rest.

const RADIUS_MM: f64 = 0.2;

/// X and Y from where it begins, mm, at a share of its time.
pub(super) fn offset_mm(time: f64) -> [f64; 2] {
    // A quintic: what began at full speed would be refused.
    let way = time.powi(3) * (10.0 + time * (6.0 * time - 15.0));
    let (sine, cosine) = (std::f64::consts::TAU * way).sin_cos();
    [RADIUS_MM * (1.0 - cosine), RADIUS_MM * sine]
}

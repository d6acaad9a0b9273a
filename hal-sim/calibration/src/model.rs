//! A pivot against its guide on a built machine, with derivatives by everything that could be known better.
//!
//! With the ring's true angle psi, radius `R = 1 + dR + r(psi)` and the letters of [`PivotCoefficients`]:
//!
//! ```text
//! f = n . (P - C) - d0 - S(rho) = 0,   rho = u . (P - C),   P = a + R (cos psi, sin psi)
//! v = n - S' u                                    across the guide where the pivot is
//! df = v . dP - v . dC - (rho + S' n . (P - C)) (dtheta + de) - dd0 - dS
//! dP = da + (dR + dr) (cos psi, sin psi) + P' dpsi,   P' = r' (cos psi, sin psi) + R (-sin psi, cos psi)
//! m = psi + z + E(psi),   so   dpsi = -(dz + dE) / (1 + E')   at a given reading m
//! ```

use core::f64::consts::FRAC_PI_6;

use kinematics::{COEFFICIENTS, PivotCoefficients};
use nalgebra::Vector2;

use crate::numbers::{ENCODER, GUIDE_ERROR, GUIDE_OFFSET, RUNOUT, STRAIGHTNESS};

/// Directions of the guides in the platform, rad.
pub const GUIDES_RAD: [f64; 3] = [-FRAC_PI_6, 3.0 * FRAC_PI_6, 7.0 * FRAC_PI_6];
/// Straightness is a sum of Legendre polynomials over this part of rho to either side of 1.
const STRAIGHTNESS_SPAN: f64 = 0.8;
/// Steps from a reading to the ring's angle: the first is off by the square of an error of some mrad, each next squares that.
const READING_STEPS: usize = 4;

/// A ring at an angle.
#[derive(Clone, Copy, Debug)]
pub struct Ring {
    /// psi, rad.
    pub angle_rad: f64,
    /// Cosine and sine of one to twelve times psi.
    waves: [[f64; 2]; 12],
    /// E, rad, and E'.
    encoder_rad: f64,
    encoder_slope: f64,
    /// P, and its derivative by psi.
    place: Vector2<f64>,
    by_angle: Vector2<f64>,
}

impl Ring {
    /// The ring at its true angle.
    #[must_use]
    pub fn at(pivot: &PivotCoefficients, angle_rad: f64) -> Self {
        let waves = waves(angle_rad);
        let [cos, sin] = waves[0];
        let (encoder_rad, encoder_slope) = series(&pivot.encoder_rad, &waves, 1.0);
        let (runout, runout_slope) = series(&pivot.runout, &waves[1..], 2.0);
        let radius = 1.0 + pivot.radius_error + runout;
        let (outwards, onwards) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
        Self {
            angle_rad,
            waves,
            encoder_rad,
            encoder_slope,
            place: Vector2::from(pivot.ring_centre) + radius * outwards,
            by_angle: runout_slope * outwards + radius * onwards,
        }
    }

    /// The ring at a reading of its encoder, rad.
    #[must_use]
    pub fn read(pivot: &PivotCoefficients, reading_rad: f64) -> Self {
        let mut ring = Self::at(pivot, reading_rad - pivot.encoder_zero_rad);
        for _ in 0..READING_STEPS {
            let missing_rad = reading_rad - ring.reading_rad(pivot);
            ring = Self::at(
                pivot,
                ring.angle_rad + missing_rad / (1.0 + ring.encoder_slope),
            );
        }
        ring
    }

    /// Derivatives of the pivot's place in a direction by its numbers at a given reading; the guide's are 0.
    fn by_numbers(&self, direction: Vector2<f64>) -> [f64; COEFFICIENTS] {
        let mut by = [0.0; COEFFICIENTS];
        let [cos, sin] = self.waves[0];
        let by_radius = direction.x * cos + direction.y * sin;
        let by_zero = -direction.dot(&self.by_angle) / (1.0 + self.encoder_slope);
        let ring = [by_zero, by_radius, direction.x, direction.y];
        for (place, value) in by.iter_mut().zip(ring) {
            *place = value;
        }
        let waves = self.waves.as_flattened();
        for (place, wave) in by[ENCODER..RUNOUT].iter_mut().zip(waves) {
            *place = by_zero * wave;
        }
        for (place, wave) in by[RUNOUT..STRAIGHTNESS].iter_mut().zip(&waves[2..]) {
            *place = by_radius * wave;
        }
        by
    }

    /// What its encoder reads, rad.
    #[must_use]
    pub fn reading_rad(&self, pivot: &PivotCoefficients) -> f64 {
        self.angle_rad + pivot.encoder_zero_rad + self.encoder_rad
    }
}

/// A pivot against its guide at a pose.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// f: how far the pivot is off the guide's line, to its left.
    pub gap: f64,
    /// rho: the place on the guide.
    pub rho: f64,
    /// u, and the pivot's distance to the left of the platform's centre.
    along: Vector2<f64>,
    side: f64,
    across: Vector2<f64>,
    by_turn: f64,
    polynomials: [f64; 8],
}

impl Contact {
    /// Guide 0, 1 or 2 of a platform at x, y and theta.
    #[must_use]
    pub fn new(guide: usize, pivot: &PivotCoefficients, ring: &Ring, pose: &[f64; 3]) -> Self {
        let [x, y, theta_rad] = *pose;
        let direction_rad = theta_rad + GUIDES_RAD[guide] + pivot.guide_error_rad;
        let (sin, cos) = direction_rad.sin_cos();
        let (u, n) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
        let from_centre = ring.place - Vector2::new(x, y);
        let (rho, side) = (u.dot(&from_centre), n.dot(&from_centre));
        let (polynomials, slopes) = legendre((rho - 1.0) / STRAIGHTNESS_SPAN);
        let straightness = dot(&pivot.straightness, &polynomials);
        let slope = dot(&pivot.straightness, &slopes) / STRAIGHTNESS_SPAN;
        Self {
            gap: side - pivot.guide_offset - straightness,
            rho,
            along: u,
            side,
            across: n - slope * u,
            by_turn: -rho - slope * side,
            polynomials,
        }
    }

    /// Derivatives of the gap by x, y and theta.
    #[must_use]
    pub fn by_pose(&self) -> [f64; 3] {
        [-self.across.x, -self.across.y, self.by_turn]
    }

    /// Derivative of the gap by the ring's angle.
    #[must_use]
    pub fn by_angle(&self, ring: &Ring) -> f64 {
        self.across.dot(&ring.by_angle)
    }

    /// Derivative of the gap by the encoder's reading.
    #[must_use]
    pub fn by_reading(&self, ring: &Ring) -> f64 {
        self.by_angle(ring) / (1.0 + ring.encoder_slope)
    }

    /// Derivatives of the gap by the pivot's numbers at a given reading, in the order of [`crate::numbers`].
    #[must_use]
    pub fn by_numbers(&self, ring: &Ring) -> [f64; COEFFICIENTS] {
        let mut by = ring.by_numbers(self.across);
        by[GUIDE_ERROR] = self.by_turn;
        by[GUIDE_OFFSET] = -1.0;
        for (place, polynomial) in by[STRAIGHTNESS..].iter_mut().zip(self.polynomials) {
            *place = -polynomial;
        }
        by
    }

    /// Derivatives of rho by x, y and theta.
    #[must_use]
    pub fn rho_by_pose(&self) -> [f64; 3] {
        [-self.along.x, -self.along.y, self.side]
    }

    /// Derivatives of rho by the pivot's numbers at a given reading and pose.
    #[must_use]
    pub fn rho_by_numbers(&self, ring: &Ring) -> [f64; COEFFICIENTS] {
        let mut by = ring.by_numbers(self.along);
        by[GUIDE_ERROR] = self.side;
        by
    }
}

/// Cosine and sine of one to twelve times an angle.
fn waves(angle_rad: f64) -> [[f64; 2]; 12] {
    let (sin, cos) = angle_rad.sin_cos();
    let mut last = [1.0, 0.0];
    [(); 12].map(|()| {
        let [c, s] = last;
        last = [c * cos - s * sin, s * cos + c * sin];
        last
    })
}

/// A Fourier series that begins at a harmonic, and its slope.
fn series(sizes: &[[f64; 2]], waves: &[[f64; 2]], first: f64) -> (f64, f64) {
    let (mut value, mut slope, mut harmonic) = (0.0, 0.0, first);
    for (&[a, b], &[cos, sin]) in sizes.iter().zip(waves) {
        value += a * cos + b * sin;
        slope += harmonic * (b * cos - a * sin);
        harmonic += 1.0;
    }
    (value, slope)
}

/// Legendre polynomials of degree 2 to 9, and their slopes.
fn legendre(x: f64) -> ([f64; 8], [f64; 8]) {
    let (mut values, mut slopes) = ([0.0; 8], [0.0; 8]);
    let (mut below, mut last) = ([1.0, 0.0], [x, 1.0]);
    let mut n = 1.0;
    for (value, slope) in values.iter_mut().zip(&mut slopes) {
        // Bonnet's recursion, and P'(n+1) = P'(n-1) + (2 n + 1) P(n).
        *value = ((2.0 * n + 1.0) * x * last[0] - n * below[0]) / (n + 1.0);
        *slope = below[1] + (2.0 * n + 1.0) * last[0];
        (below, last) = (last, [*value, *slope]);
        n += 1.0;
    }
    (values, slopes)
}

fn dot(a: &[f64; 8], b: &[f64; 8]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

//! What a built machine's pivots, rings and guides are off the drawing.

/// Numbers of one pivot.
pub const COEFFICIENTS: usize = 48;

/// What one pivot, its ring, its encoder and its guide are off the drawing. Lengths are in track radii, angles in rad; all zero is the
/// drawing. With psi the ring's true angle, t the guide's true direction, and rho the place on the guide:
///
/// ```text
/// P = a + (1 + dR + r(psi)) (cos psi, sin psi)    the pivot on its ring
/// t = theta + g + e                               the guide's direction, g = -30, 90, 210 deg
/// u = (cos t, sin t),  n = (-sin t, cos t)
/// rho = u . (P - C),   n . (P - C) = d0 + S(rho)  the pivot lies on the guide's line
/// m = psi + z + E(psi)                            what the encoder reads
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct PivotCoefficients {
    /// z: what the encoder reads at the ring's angle 0, rad.
    pub encoder_zero_rad: f64,
    /// dR: radius of the pivot less the track radius.
    pub radius_error: f64,
    /// a: centre of the ring in the base frame.
    pub ring_centre: [f64; 2],
    /// e: error of the guide's direction in the platform, rad.
    pub guide_error_rad: f64,
    /// d0: distance of the guide's line from the platform's centre, to its left.
    pub guide_offset: f64,
    /// E, rad: cosine and sine of one to twelve times the ring's angle.
    pub encoder_rad: [[f64; 2]; 12],
    /// r: cosine and sine of twice to six times the ring's angle.
    pub runout: [[f64; 2]; 5],
    /// S: Legendre polynomials 2 to 9 of (rho - 1) / 0.8.
    pub straightness: [f64; 8],
}

impl PivotCoefficients {
    /// As drawn.
    pub const IDEAL: Self = Self {
        encoder_zero_rad: 0.0,
        radius_error: 0.0,
        ring_centre: [0.0; 2],
        guide_error_rad: 0.0,
        guide_offset: 0.0,
        encoder_rad: [[0.0; 2]; 12],
        runout: [[0.0; 2]; 5],
        straightness: [0.0; 8],
    };

    /// The numbers of a pivot, in the order of their fields.
    #[must_use]
    pub fn to_list(&self) -> [f64; COEFFICIENTS] {
        let mut list = [0.0; COEFFICIENTS];
        let [x, y] = self.ring_centre;
        let lines = [
            self.encoder_zero_rad,
            self.radius_error,
            x,
            y,
            self.guide_error_rad,
            self.guide_offset,
        ];
        let curves = (self.encoder_rad.as_flattened().iter())
            .chain(self.runout.as_flattened())
            .chain(&self.straightness);
        for (place, &number) in list.iter_mut().zip(lines.iter().chain(curves)) {
            *place = number;
        }
        list
    }

    /// A pivot of these numbers.
    #[must_use]
    pub fn from_list(list: &[f64; COEFFICIENTS]) -> Self {
        let mut pivot = Self::IDEAL;
        let [
            zero_rad,
            radius_error,
            x,
            y,
            guide_error_rad,
            guide_offset,
            curves @ ..,
        ] = list;
        pivot.encoder_zero_rad = *zero_rad;
        pivot.radius_error = *radius_error;
        pivot.ring_centre = [*x, *y];
        pivot.guide_error_rad = *guide_error_rad;
        pivot.guide_offset = *guide_offset;
        let places = (pivot.encoder_rad.as_flattened_mut().iter_mut())
            .chain(pivot.runout.as_flattened_mut())
            .chain(&mut pivot.straightness);
        for (place, &number) in places.zip(curves) {
            *place = number;
        }
        pivot
    }
}

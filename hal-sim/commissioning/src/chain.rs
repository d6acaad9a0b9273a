//! The machine as it answers to small motions: three motors, three rings, one platform, springs between.
//!
//! ```text
//!  torque --> motor --[ transmission ]-- ring --[ across the guide ]-- platform
//!                                                   (all three rings on the same)
//! ```
//!
//! All is seen at the rings, in rad: a platform's place in track radii, masses times the radius squared. With the ring angles phi, the
//! place q, J the pivots' Jacobian ([`kinematics::jacobian()`]) and c the cosines between pivots and guides:
//!
//! ```text
//! Jm pm''  = T - z (pm - p)                                 z = k + c s: the transmission
//! Jr p''   = z (pm - p) - b p' - g c^2 (p - J q)            g = k + c s: across a guide
//! M  q''   = J^T g c^2 (p - J q) - h q                      h: what carriages that do not slide hold along the guides
//! ```

use kinematics::{Guide, guides_along_axes, jacobian};
use nalgebra::{Complex, Matrix3, SMatrix, SVector, Vector3};
use std::f64::consts::TAU;

/// Dynamic stiffness of the motor on its spring, over the spring's, under which the motor's angle does not follow from the ring's.
const LEAST_APART: f64 = 0.25;

/// How far springs and dampers may be from what they were found as, as logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertainty {
    /// Of the transmission's springs.
    pub stiffness: f64,
    /// Of its dampers.
    pub damping: f64,
    /// Of the springs across the guides.
    pub guide_stiffness: f64,
    /// Of their dampers.
    pub guide_damping: f64,
}

/// Radius of a load of which only the mass is told, m.
pub const CYLINDER_M: f64 = 0.05;

/// Inertia of such a load about its axis, kg m^2.
#[must_use]
pub fn cylinder_kg_m2(mass_kg: f64) -> f64 {
    0.5 * mass_kg * CYLINDER_M * CYLINDER_M
}

/// What is carried, about the platform's centre; lengths in track radii, masses times the track radius squared: kg m^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Mass.
    pub mass: f64,
    /// Moment of inertia about the centre.
    pub inertia: f64,
    /// Mass times its centre, along the platform's axes.
    pub moment: [f64; 2],
}

/// Numbers of the mechanics, all drives alike. SI, seen at the ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    /// Motor with its side of the gear, kg m^2.
    pub motor_inertia: f64,
    /// Ring with its side of the gear, kg m^2.
    pub ring_inertia: f64,
    /// Transmission, N m/rad.
    pub stiffness: f64,
    /// Transmission, N m s/rad.
    pub damping: f64,
    /// Friction of a ring that grows with the rate, N m s/rad.
    pub viscous: f64,
    /// Across a guide, times the track radius squared, N m/rad.
    pub guide_stiffness: f64,
    /// The same, N m s/rad.
    pub guide_damping: f64,
    /// Of a carriage along its guide while it does not slide, times the track radius squared, N m/rad.
    pub along_stiffness: f64,
    /// The same, N m s/rad.
    pub along_damping: f64,
    /// Platform and payload.
    pub load: Load,
}

/// Where the platform is.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    guides: [Guide<f64>; 3],
    jacobian: Matrix3<f64>,
}

impl Place {
    /// With the centre at (x, y) along the platform's own axes, in track radii; `None`: not inside the track.
    #[must_use]
    pub fn new(x: f64, y: f64) -> Option<Self> {
        let guides = guides_along_axes(x, y, f64::sqrt)?;
        Some(Self {
            guides,
            jacobian: jacobian(&guides),
        })
    }

    /// In the middle.
    #[must_use]
    pub fn centre() -> Self {
        Self::new(0.0, 0.0).expect("it is inside")
    }
}

impl Load {
    /// Mass matrix for (x, y, theta) along the platform's axes.
    #[must_use]
    pub fn mass_matrix(&self) -> Matrix3<f64> {
        let ([x, y], m) = (self.moment, self.mass);
        Matrix3::new(m, 0.0, -y, 0.0, m, x, -y, x, self.inertia)
    }

    /// What it is at the rings, kg m^2.
    #[must_use]
    pub fn at_rings(&self, place: &Place) -> Matrix3<f64> {
        let inverse = place
            .jacobian
            .try_inverse()
            .unwrap_or_else(|| Matrix3::repeat(f64::NAN));
        inverse.transpose() * self.mass_matrix() * inverse
    }
}

/// Angles of rings and motors for a torque of 1 N m at each motor, rad.
#[derive(Clone, Copy, Debug)]
pub struct Compliance {
    /// Of the rings.
    pub ring: Matrix3<Complex<f64>>,
    /// Of the motors.
    pub motor: Matrix3<Complex<f64>>,
}

impl Chain {
    /// What the rings move where they stand, kg m^2, while nothing gives way: motors, rings and platform.
    #[must_use]
    pub fn inertia(&self, place: &Place) -> Matrix3<f64> {
        let drives = Matrix3::identity() * (self.motor_inertia + self.ring_inertia);
        drives + self.load.at_rings(place)
    }

    /// The same with a transmission that gives way and damps so much more, over what it does: play that is crossed gives way as well, and flanks
    /// that meet lose what they had.
    #[must_use]
    pub fn with_play(&self, gives: f64, damps: f64) -> Self {
        Self {
            stiffness: self.stiffness / (1.0 + gives),
            damping: self.damping * (1.0 + damps),
            ..*self
        }
    }

    /// With so many kg more on the platform's centre: a cylinder of [`CYLINDER_M`].
    #[must_use]
    pub fn carrying(&self, more_kg: f64, radius_m: f64) -> Self {
        Self {
            load: Load {
                mass: self.load.mass + more_kg * radius_m * radius_m,
                inertia: self.load.inertia + cylinder_kg_m2(more_kg),
                ..self.load
            },
            ..*self
        }
    }

    /// With carriages that slide: they hold nothing along their guides. A loop has to be stable then, too, and without a spring to the ground each plant
    /// is an integrator.
    #[must_use]
    pub fn sliding(&self) -> Self {
        Self {
            along_stiffness: 0.0,
            along_damping: 0.0,
            ..*self
        }
    }

    /// What a machine that was found with this uncertainty may be as well: springs off either way, and dampers weaker.
    #[must_use]
    pub fn as_it_may_be(&self, off: &Uncertainty) -> [Self; 2] {
        [-1.0, 1.0].map(|side| Self {
            stiffness: (side * off.stiffness).exp() * self.stiffness,
            damping: (-off.damping).exp() * self.damping,
            guide_stiffness: (side * off.guide_stiffness).exp() * self.guide_stiffness,
            guide_damping: (-off.guide_damping).exp() * self.guide_damping,
            ..*self
        })
    }

    /// Rate of a motor that gives a torque while its ring turns at a rate: the transmission winds up between them. `None` beside the
    /// frequency at which the motor swings on the transmission by itself, where it does not follow.
    #[must_use]
    pub fn motor_rate(
        &self,
        hz: f64,
        ring_rate: Complex<f64>,
        torque: Complex<f64>,
    ) -> Option<Complex<f64>> {
        let s = Complex::new(0.0, TAU * hz);
        let spring = self.stiffness + self.damping * s;
        let motor = spring + self.motor_inertia * s * s;
        (motor.norm() > LEAST_APART * spring.norm())
            .then(|| (spring * ring_rate + torque * s) / motor)
    }

    /// Angles for torques at the motors.
    #[must_use]
    pub fn compliance(&self, hz: f64, place: &Place) -> Compliance {
        let s = Complex::new(0.0, TAU * hz);
        let nothing = Matrix3::repeat(Complex::new(f64::NAN, f64::NAN));
        let j = place.jacobian.map(Complex::from);
        let across = self.guide_stiffness + self.guide_damping * s;
        let levers = Matrix3::from_diagonal(&Vector3::from(
            place
                .guides
                .map(|guide| across * guide.cosine * guide.cosine),
        ));
        let mut body =
            self.load.mass_matrix().map(Complex::from) * (s * s) + j.transpose() * levers * j;
        let along = self.along_stiffness + self.along_damping * s;
        for guide in &place.guides {
            // What the place on the guide changes by with x, y and theta.
            let row = Vector3::new(-guide.cos, -guide.sin, guide.offset).map(Complex::from);
            body += row * row.transpose() * along;
        }
        let Some(carried) = body.try_inverse() else {
            return Compliance {
                ring: nothing,
                motor: nothing,
            };
        };
        let spring = self.stiffness + self.damping * s;
        let motor = self.motor_inertia * s * s + spring;
        let ring_alone =
            self.ring_inertia * s * s + self.viscous * s + spring - spring * spring / motor;
        let rings = Matrix3::identity() * ring_alone + levers
            - levers * j * carried * j.transpose() * levers;
        let Some(inverse) = rings.try_inverse() else {
            return Compliance {
                ring: nothing,
                motor: nothing,
            };
        };
        let ring = inverse * (spring / motor);
        Compliance {
            ring,
            motor: (Matrix3::identity() + ring * spring) / motor,
        }
    }

    /// Frequencies at which it swings by itself, Hz, the lowest first; motions that nothing holds are left out.
    #[must_use]
    pub fn resonances_hz(&self, place: &Place) -> Vec<f64> {
        let [mut mass, mut stiffness] = [SMatrix::<f64, 9, 9>::zeros(); 2];
        let mut spring = |row: SVector<f64, 9>, k: f64| stiffness += row * row.transpose() * k;
        for i in 0..3 {
            mass[(i, i)] = self.motor_inertia;
            mass[(3 + i, 3 + i)] = self.ring_inertia;
            let mut twist = SVector::zeros();
            (twist[i], twist[3 + i]) = (1.0, -1.0);
            spring(twist, self.stiffness);
            let mut gap = SVector::zeros();
            gap[3 + i] = place.guides[i].cosine;
            for k in 0..3 {
                gap[6 + k] = -place.guides[i].cosine * place.jacobian[(i, k)];
            }
            spring(gap, self.guide_stiffness);
        }
        mass.fixed_view_mut::<3, 3>(6, 6)
            .copy_from(&self.load.mass_matrix());
        let Some(root) = mass.cholesky() else {
            return Vec::new();
        };
        let Some(inverse) = root.l().try_inverse() else {
            return Vec::new();
        };
        let mut squares: Vec<f64> = (inverse * stiffness * inverse.transpose())
            .symmetric_eigenvalues()
            .iter()
            .copied()
            .collect();
        squares.sort_by(f64::total_cmp);
        squares
            .into_iter()
            .skip(3)
            .map(|square| square.max(0.0).sqrt() / TAU)
            .collect()
    }
}

//! A machine at rest: where its rings and encoders are at a pose, and where its platform is at readings of the encoders.
//!
//! What it does not repeat is drawn at each visit. Guides that give way lose motion: at rest friction F of the carriages, of either sign, holds
//! against guides of stiffness k. With the gaps' derivatives G by the pose and those of the carriages' places R, the platform is off by
//! `(G^T G)^-1 R^T (+-F) / k`.

use kinematics::{Scalar, direct};
use nalgebra::{Matrix3, Vector3};

use crate::machine::plant::{AXES, Geometry, OffGuide, PlantParameters};
use crate::random::Random;

/// What an encoder reads beside the ring's angle. All zero is the drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderErrors {
    /// Its reading at the ring's angle 0, rad.
    pub zero_rad: f64,
    /// Cosine and sine of one to twelve times the ring's angle, rad.
    pub harmonics_rad: [[f64; 2]; 12],
}

impl EncoderErrors {
    /// As drawn.
    pub const IDEAL: Self = Self {
        zero_rad: 0.0,
        harmonics_rad: [[0.0; 2]; 12],
    };

    /// What is read beside the ring's angle, and how it grows with that.
    fn at(&self, ring_rad: f64) -> (f64, f64) {
        let (mut error_rad, mut slope, mut times) = (self.zero_rad, 0.0, 0.0);
        for [cosine_rad, sine_rad] in self.harmonics_rad {
            times += 1.0;
            let (sin, cos) = <f64 as Scalar>::sin_cos(times * ring_rad);
            error_rad += cosine_rad * cos + sine_rad * sin;
            slope += times * (sine_rad * cos - cosine_rad * sin);
        }
        (error_rad, slope)
    }
}

/// What a machine does not repeat.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Unrepeated {
    /// Friction of the carriages over the stiffness of the guides, m.
    pub lost_m: f64,
    /// What else the encoders do not show or show wrongly, one standard deviation at each, rad.
    pub readings_rad: f64,
}

/// A machine at rest.
#[derive(Clone, Copy, Debug)]
pub struct QuasiStatic {
    geometry: Geometry,
    encoders: [EncoderErrors; AXES],
    track_radius_m: f64,
    unrepeated: Unrepeated,
}

impl QuasiStatic {
    /// With the geometry of a plant, whether or not the plant has it switched on.
    #[must_use]
    pub fn new(plant: &PlantParameters, encoders: [EncoderErrors; AXES]) -> Self {
        let mut plant = *plant;
        plant.imperfections.geometry = true;
        Self {
            geometry: Geometry::new(&plant),
            encoders,
            track_radius_m: plant.track_radius_m,
            unrepeated: Unrepeated::default(),
        }
    }

    /// The same machine, which does not repeat.
    #[must_use]
    pub const fn with_unrepeated(self, unrepeated: Unrepeated) -> Self {
        Self { unrepeated, ..self }
    }

    /// What the encoders read where the platform has come to a pose (m, m, rad) from any side.
    ///
    /// # Errors
    /// [`OffGuide`]: a pivot does not reach its guide.
    pub fn visited_rad(
        &self,
        pose: [f64; 3],
        random: &mut Random,
    ) -> Result<[f64; AXES], OffGuide> {
        if self.unrepeated == Unrepeated::default() {
            return self.readings_rad(pose);
        }
        let off = self.lost(pose, random)?;
        let readings_rad = self.readings_rad([0, 1, 2].map(|k| pose[k] - off[k]))?;
        let size_rad = self.unrepeated.readings_rad;
        Ok(readings_rad.map(|reading_rad| reading_rad + size_rad * random.normal()))
    }

    /// The pose (m, m, rad) to which readings of the encoders bring the platform from any side.
    ///
    /// # Errors
    /// As [`Self::pose`].
    pub fn reached(
        &self,
        readings_rad: [f64; AXES],
        random: &mut Random,
    ) -> Result<[f64; 3], OffGuide> {
        if self.unrepeated == Unrepeated::default() {
            return self.pose(readings_rad);
        }
        let size_rad = self.unrepeated.readings_rad;
        let pose = self.pose(readings_rad.map(|m| m + size_rad * random.normal()))?;
        let off = self.lost(pose, random)?;
        Ok([0, 1, 2].map(|k| pose[k] + off[k]))
    }

    /// By how much friction of the carriages holds the platform off a pose, each guide's in either direction.
    fn lost(&self, pose: [f64; 3], random: &mut Random) -> Result<[f64; 3], OffGuide> {
        let pose = Vector3::from(pose);
        let guides = self
            .geometry
            .guides(&pose, &self.geometry.rings_rad(&pose)?);
        let gaps = Matrix3::from_columns(&guides.map(|guide| guide.gap_by_pose()));
        let stiffness = gaps * gaps.transpose();
        let pull: Vector3<f64> = (guides.iter())
            .map(|guide| {
                let sign = if random.once_in(2) { 1.0 } else { -1.0 };
                guide.rho_by_pose() * sign
            })
            .sum();
        let inverse = stiffness.try_inverse().ok_or(OffGuide { guide: 0 })?;
        Ok((inverse * pull * self.unrepeated.lost_m).into())
    }

    /// Radius of the track, m.
    #[must_use]
    pub const fn track_radius_m(&self) -> f64 {
        self.track_radius_m
    }

    /// Readings of the encoders at a pose (m, m, rad), rad, multi-turn, without noise.
    ///
    /// # Errors
    /// [`OffGuide`]: a pivot does not reach its guide.
    pub fn readings_rad(&self, pose: [f64; 3]) -> Result<[f64; AXES], OffGuide> {
        let rings_rad = self.geometry.rings_rad(&Vector3::from(pose))?;
        Ok([0, 1, 2].map(|i| rings_rad[i] + self.encoders[i].at(rings_rad[i]).0))
    }

    /// Place of a pivot on its guide at a pose (m, m, rad), m, and its derivatives by the pose.
    ///
    /// # Errors
    /// [`OffGuide`]: a pivot does not reach its guide.
    pub fn place_on_guide(
        &self,
        guide: usize,
        pose: [f64; 3],
    ) -> Result<(f64, [f64; 3]), OffGuide> {
        let pose = Vector3::from(pose);
        let rings_rad = self.geometry.rings_rad(&pose)?;
        let state = &self.geometry.guides(&pose, &rings_rad)[guide];
        Ok((state.rho_m, state.rho_by_pose().into()))
    }

    /// The pose (m, m, rad) that the machine takes where its encoders read this, rad.
    ///
    /// # Errors
    /// [`OffGuide`]: there is none, or Newton's method does not find it.
    pub fn pose(&self, readings_rad: [f64; AXES]) -> Result<[f64; 3], OffGuide> {
        const STEPS: usize = 10;
        let ring_rad = [0, 1, 2].map(|i| {
            let mut ring_rad = readings_rad[i];
            for _ in 0..STEPS {
                let (error_rad, slope) = self.encoders[i].at(ring_rad);
                ring_rad += (readings_rad[i] - error_rad - ring_rad) / (1.0 + slope);
            }
            ring_rad
        });
        let lost = OffGuide { guide: 0 };
        let drawn = direct::<f64>(&ring_rad).map_err(|_| lost)?;
        let ring_rad = Vector3::from(ring_rad);
        let radius_m = self.track_radius_m;
        let mut pose = Vector3::new(drawn.x * radius_m, drawn.y * radius_m, drawn.theta);
        for _ in 0..STEPS {
            let guides = self.geometry.guides(&pose, &ring_rad);
            let slopes = Matrix3::from_columns(&guides.map(|guide| guide.gap_by_pose()));
            let inverse = slopes.transpose().try_inverse().ok_or(lost)?;
            pose -= inverse * Vector3::from(guides.map(|guide| guide.gap_m));
        }
        Ok(pose.into())
    }
}

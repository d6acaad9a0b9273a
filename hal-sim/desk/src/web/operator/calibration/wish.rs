//! What a page asks for, in its own numbers.

use calibration::{Instrument, Kit, Noise};
use serde::Deserialize;

use crate::calibrate::{NOISES, POSES, noise};

const M_PER_NM: f64 = 1e-9;
const RAD_PER_URAD: f64 = 1e-6;
/// See the module.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::web) struct Wish {
    pub kit: String,
    /// Standard deviation of a length.
    pub noise_nm: f64,
    /// Of theta; by that of lengths where nobody says it.
    pub noise_urad: Option<f64>,
    pub poses: usize,
}

impl Wish {
    /// The instrument that it speaks of.
    pub fn instrument(&self) -> Result<Instrument, String> {
        let kit: Kit = self
            .kit
            .parse()
            .map_err(|_| format!("'{}' is no instrument", self.kit))?;
        let length_m = self.noise_nm * M_PER_NM;
        if !NOISES.contains(&length_m) {
            return Err("the noise of a length is to be 0.1 nm to 1 mm".to_owned());
        }
        let angle_rad = self.noise_urad.map(|noise| noise * RAD_PER_URAD);
        if !angle_rad.is_none_or(|noise| NOISES.contains(&noise)) {
            return Err("the noise of theta is to be 0.0001 to 1000 urad".to_owned());
        }
        if !POSES.contains(&self.poses) {
            let (least, most) = POSES.into_inner();
            return Err(format!(
                "so many poses are to be measured: {least} to {most}"
            ));
        }
        Ok(Instrument::new(kit, noise(length_m, angle_rad)))
    }

    /// The same in front of a machine that does not repeat to so much, rad.
    pub fn before_scatter(&self, encoder_rad: f64) -> Result<Instrument, String> {
        let Instrument { kit, noise, .. } = self.instrument()?;
        Ok(Instrument::new(
            kit,
            Noise {
                encoder_rad,
                ..noise
            },
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_wish_is_named() {
        let wish = Wish {
            kit: "xyt".to_owned(),
            noise_nm: 50.0,
            noise_urad: None,
            poses: 200,
        };
        let instrument = wish.instrument().expect("a wish");
        assert!((instrument.noise.length - 5e-7).abs() < 1e-15);
        assert!((instrument.noise.angle_rad - 1e-6).abs() < 1e-15);
        type Change = fn(&mut Wish);
        let bad: [(&str, Change); 6] = [
            ("instrument", |wish| wish.kit.clear()),
            ("length", |wish| wish.noise_nm = 0.0),
            ("length", |wish| wish.noise_nm = f64::NAN),
            ("theta", |wish| wish.noise_urad = Some(1e4)),
            ("poses", |wish| wish.poses = 11),
            ("poses", |wish| wish.poses = 3001),
        ];
        for (what, change) in bad {
            let mut wish = wish.clone();
            change(&mut wish);
            let refused = wish.instrument().expect_err(what);
            assert!(refused.contains(what), "{refused}");
        }
    }
}

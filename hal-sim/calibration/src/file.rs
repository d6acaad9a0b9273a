//! A fitted machine as a text file: every number with its unit in its name, and how it came about.

use crc::{CRC_32_ISO_HDLC, Crc};
use kinematics::PivotCoefficients;
use serde::{Deserialize, Serialize};

use crate::Machine;
use crate::kit::{Kit, Noise};

static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
/// Begins the last line.
const CHECKSUM: &str = "# CRC-32 of the lines above: ";

/// What a file tells.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// How it came about.
    pub made: Made,
    /// The pivots.
    pub pivots: [Pivot; 3],
}

/// How a calibration came about.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Made {
    /// The machine, in its owner's words.
    pub serial: String,
    /// Day of the fit, as in 2026-11-23.
    pub date: String,
    /// Temperature at which was measured, deg C, if it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_c: Option<f64>,
    /// Track radius of the drawing, mm.
    pub track_radius_mm: f64,
    /// The instrument.
    pub kit: Kit,
    /// Its noise in x and y, nm.
    pub noise_nm: f64,
    /// Its noise in theta, urad.
    pub noise_urad: f64,
    /// What the machine itself does not repeat, nm on the track at each pivot; 0 where the noise explains all that is left.
    #[serde(default)]
    pub scatter_nm: f64,
    /// Measured poses.
    pub visits: usize,
    /// How many of them were left out.
    pub outliers: usize,
    /// Square misses over what noise and scatter make of them, a row.
    pub chi2: f64,
    /// The same of those that were held out.
    pub chi2_held_out: f64,
    /// What is expected to be left, over the disk and all orientations: x and y together, nm rms.
    pub expected_xy_nm: f64,
    /// The same where it is largest.
    pub expected_worst_xy_nm: f64,
    /// The same of theta, urad rms.
    pub expected_theta_urad: f64,
}

/// The numbers of one pivot; see [`PivotCoefficients`] for what they mean.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pivot {
    /// z.
    pub encoder_zero_rad: f64,
    /// dR.
    pub radius_error_mm: f64,
    /// a.
    pub ring_centre_mm: [f64; 2],
    /// e.
    pub guide_error_rad: f64,
    /// d0.
    pub guide_offset_mm: f64,
    /// E: cosine and sine of one to twelve times the ring's angle.
    pub encoder_rad: [[f64; 2]; 12],
    /// r: cosine and sine of twice to six times the ring's angle.
    pub runout_mm: [[f64; 2]; 5],
    /// S: Legendre polynomials 2 to 9.
    pub straightness_mm: [f64; 8],
}

/// Why a file is no calibration.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum FileError {
    /// It is no TOML, or not of these keys.
    #[error("line {line}: {reason}")]
    Syntax {
        /// From 1.
        line: usize,
        /// What is wrong there.
        reason: String,
    },
    /// No machine has that.
    #[error("{key} = {value}: must be from {least} to {most}")]
    Absurd {
        /// Which number, from the top, with dots between.
        key: String,
        /// What stands there.
        value: f64,
        /// What it may be.
        least: f64,
        /// What it may be.
        most: f64,
    },
    /// Its end is missing.
    #[error("no checksum in its last line: its end is missing")]
    NoChecksum,
    /// Something in it is not what was written.
    #[error(
        "it has the checksum {found:08x}, and {told:08x} is in its last line: it has been changed since it was written"
    )]
    Changed {
        /// Of what stands there.
        found: u32,
        /// Of what was written.
        told: u32,
    },
}

impl Pivot {
    fn new(pivot: &PivotCoefficients, radius_mm: f64) -> Self {
        let mm = |length: f64| length * radius_mm;
        Self {
            encoder_zero_rad: pivot.encoder_zero_rad,
            radius_error_mm: mm(pivot.radius_error),
            ring_centre_mm: pivot.ring_centre.map(mm),
            guide_error_rad: pivot.guide_error_rad,
            guide_offset_mm: mm(pivot.guide_offset),
            encoder_rad: pivot.encoder_rad,
            runout_mm: pivot.runout.map(|pair| pair.map(mm)),
            straightness_mm: pivot.straightness.map(mm),
        }
    }

    fn coefficients(&self, radius_mm: f64) -> PivotCoefficients {
        let radii = |mm: f64| mm / radius_mm;
        PivotCoefficients {
            encoder_zero_rad: self.encoder_zero_rad,
            radius_error: radii(self.radius_error_mm),
            ring_centre: self.ring_centre_mm.map(radii),
            guide_error_rad: self.guide_error_rad,
            guide_offset: radii(self.guide_offset_mm),
            encoder_rad: self.encoder_rad,
            runout: self.runout_mm.map(|pair| pair.map(radii)),
            straightness: self.straightness_mm.map(radii),
        }
    }

    /// Its numbers by name, and how large each can be, in their own order.
    pub fn numbers(&self) -> impl Iterator<Item = (&'static str, f64, f64)> {
        let all = |name, most, values: &[f64]| {
            let values = values.iter();
            values.map(|&value| (name, value, most)).collect::<Vec<_>>()
        };
        [
            all("encoder_zero_rad", 7.0, &[self.encoder_zero_rad]),
            all("radius_error_mm", 2.0, &[self.radius_error_mm]),
            all("ring_centre_mm", 2.0, &self.ring_centre_mm),
            all("guide_error_rad", 0.1, &[self.guide_error_rad]),
            all("guide_offset_mm", 5.0, &[self.guide_offset_mm]),
            all("encoder_rad", 0.01, self.encoder_rad.as_flattened()),
            all("runout_mm", 0.1, self.runout_mm.as_flattened()),
            all("straightness_mm", 0.1, &self.straightness_mm),
        ]
        .into_iter()
        .flatten()
    }
}

impl Made {
    /// The instrument's noise, as it was said.
    #[must_use]
    pub fn instrument_noise(&self) -> Noise {
        Noise {
            length: self.radii(self.noise_nm),
            angle_rad: self.noise_urad * 1e-6,
            encoder_rad: Noise::ENCODER_RAD,
        }
    }

    /// The same with the machine's scatter in it.
    #[must_use]
    pub fn noise(&self) -> Noise {
        Noise {
            encoder_rad: Noise::ENCODER_RAD.hypot(self.radii(self.scatter_nm)),
            ..self.instrument_noise()
        }
    }

    fn radii(&self, nm: f64) -> f64 {
        nm * 1e-6 / self.track_radius_mm
    }
}

impl Calibration {
    /// Of a machine, in track radii of what was made.
    #[must_use]
    pub fn new(made: Made, machine: &Machine) -> Self {
        let pivots = [0, 1, 2].map(|i| Pivot::new(&machine[i], made.track_radius_mm));
        Self { made, pivots }
    }

    /// The machine, in track radii.
    #[must_use]
    pub fn machine(&self) -> Machine {
        (self.pivots).map(|pivot| pivot.coefficients(self.made.track_radius_mm))
    }

    /// As text.
    #[must_use]
    pub fn to_text(&self) -> String {
        let head = "# What a built machine is off its drawing, for `tripivot --calibration FILE`. Every number has its unit in its name.\n\n";
        let text = match toml::to_string(self) {
            Ok(text) => head.to_owned() + &text,
            // Numbers, words and tables of them, all of which TOML has.
            Err(error) => format!("{head}# {error}\n"),
        };
        with_checksum(&text)
    }

    /// From text.
    ///
    /// # Errors
    /// [`FileError`]: names what is wrong and where.
    pub fn from_text(text: &str) -> Result<Self, FileError> {
        let calibration: Self = toml::from_str(text).map_err(|error| FileError::Syntax {
            line: error.span().map_or(1, |span| line_of(text, span.start)),
            reason: error.message().replace('\n', " "),
        })?;
        let radius_mm = calibration.made.track_radius_mm;
        within("made.track_radius_mm", radius_mm, 10.0, 1000.0)?;
        for (i, pivot) in calibration.pivots.iter().enumerate() {
            for (name, value, most) in pivot.numbers() {
                within(&format!("pivots.{i}.{name}"), value, -most, most)?;
            }
        }
        let (above, told) = text.rsplit_once(CHECKSUM).ok_or(FileError::NoChecksum)?;
        let told = u32::from_str_radix(told.trim_end(), 16).map_err(|_| FileError::NoChecksum)?;
        let found = checksum(above);
        if found != told {
            return Err(FileError::Changed { found, told });
        }
        Ok(calibration)
    }
}

/// A text with its checksum in a last line, without which no file is taken.
#[must_use]
pub fn with_checksum(text: &str) -> String {
    format!("{text}{CHECKSUM}{:08x}\n", checksum(text))
}

/// Of all lines, however they are ended.
fn checksum(text: &str) -> u32 {
    let mut digest = CRC.digest();
    for line in text.lines() {
        digest.update(line.as_bytes());
        digest.update(b"\n");
    }
    digest.finalize()
}

fn within(key: &str, value: f64, least: f64, most: f64) -> Result<(), FileError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(FileError::Absurd {
        key: key.to_owned(),
        value,
        least,
        most,
    })
}

/// The line of a byte, from 1.
fn line_of(text: &str, at: usize) -> usize {
    1 + text.bytes().take(at).filter(|&byte| byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers;
    use kinematics::COEFFICIENTS;

    fn calibration() -> Calibration {
        let list: [f64; COEFFICIENTS] =
            core::array::from_fn(|number| 0.3 * numbers::size(number) * (number as f64).sin());
        Calibration::new(
            Made {
                serial: "bench 7".to_owned(),
                date: "2026-11-23".to_owned(),
                temperature_c: Some(20.5),
                track_radius_mm: 100.0,
                kit: Kit::Camera2,
                noise_nm: 50.0,
                noise_urad: 1.0,
                scatter_nm: 120.0,
                visits: 600,
                outliers: 2,
                chi2: 1.01,
                chi2_held_out: 0.98,
                expected_xy_nm: 30.0,
                expected_worst_xy_nm: 50.0,
                expected_theta_urad: 0.25,
            },
            &[numbers::from_list(&list); 3],
        )
    }

    #[test]
    fn a_calibration_comes_back_from_its_text() {
        let calibration = calibration();
        let back = Calibration::from_text(&calibration.to_text()).expect("a calibration");
        assert_eq!(back, calibration);
        for (there, number) in (numbers::to_list(&back.machine()[2]).into_iter()).zip(0..) {
            let here = 0.3 * numbers::size(number) * (number as f64).sin();
            // mm and back are two roundings.
            assert!((there - here).abs() <= 4.0 * f64::EPSILON * here.abs());
        }
        assert!(calibration.to_text().contains("guide_offset_mm = "));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let text = calibration().to_text();
        let error = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            Calibration::from_text(&text.replacen(from, to, 1))
                .expect_err(to)
                .to_string()
        };
        let unknown = error("guide_error_rad", "guide_error_deg");
        assert!(unknown.starts_with("line "), "{unknown}");
        assert!(unknown.contains("guide_error_deg"), "{unknown}");
        assert!(error("kit = \"camera2\"", "kit = \"sextant\"").contains("sextant"));
        assert_eq!(
            error("track_radius_mm = 100.0", "track_radius_mm = -1.0"),
            "made.track_radius_mm = -1: must be from 10 to 1000"
        );
        assert_eq!(
            error("encoder_zero_rad = 0.0", "encoder_zero_rad = nan"),
            "pivots.0.encoder_zero_rad = NaN: must be from -7 to 7"
        );
        assert!(error("[made]", "[made").starts_with("line 3: "));
    }

    #[test]
    fn a_changed_digit_is_found() {
        let text = calibration().to_text();
        let radius = (text
            .lines()
            .find(|line| line.starts_with("radius_error_mm")))
        .unwrap();
        let digit = radius
            .find(|letter: char| ('1'..='8').contains(&letter))
            .unwrap();
        let mut changed = radius.to_owned();
        changed.replace_range(digit..=digit, "9");
        let error = |text: &str| Calibration::from_text(text).unwrap_err();
        let changed = error(&text.replacen(radius, &changed, 1));
        assert!(matches!(changed, FileError::Changed { .. }), "{changed}");
        let (above, _) = text.rsplit_once(CHECKSUM).unwrap();
        assert_eq!(error(above), FileError::NoChecksum);
        assert!(Calibration::from_text(&text.replace('\n', "\r\n")).is_ok());
    }
}

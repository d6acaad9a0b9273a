//! The calibration file of the published poses: one object of 144 numbers, in track radii and rad.

use std::collections::BTreeMap;
use std::fmt;

use kinematics::PivotCoefficients;
use serde::Deserializer;
use serde::de::{Error, MapAccess, Visitor};

/// Numbers by their keys.
struct Numbers(BTreeMap<String, f64>);

/// The coefficients of the three pivots, or what is wrong with the text, a JSON document. Keys end in the pivot's
/// number, 0 to 2: z, dR, ax, ay, e and d; Ec and Es 1 to 12, rc and rs 2 to 6, S 2 to 9.
pub(super) fn pivots(text: &str) -> Result<[PivotCoefficients; 3], String> {
    let mut parser = serde_json::Deserializer::from_str(text);
    let read = parser.deserialize_map(NumbersVisitor);
    let mut numbers = read.map_err(|error| error.to_string())?;
    parser.end().map_err(|error| error.to_string())?;
    let pivots = [
        numbers.take_pivot(0)?,
        numbers.take_pivot(1)?,
        numbers.take_pivot(2)?,
    ];
    match numbers.0.into_keys().next() {
        Some(key) => Err(format!("unknown key '{key}'")),
        None => Ok(pivots),
    }
}

impl Numbers {
    fn take(&mut self, key: &str) -> Result<f64, String> {
        (self.0.remove(key)).ok_or_else(|| format!("'{key}' is missing"))
    }

    fn take_pivot(&mut self, i: usize) -> Result<PivotCoefficients, String> {
        let mut built = PivotCoefficients {
            encoder_zero_rad: self.take(&format!("z{i}"))?,
            radius_error: self.take(&format!("dR{i}"))?,
            ring_centre: [self.take(&format!("ax{i}"))?, self.take(&format!("ay{i}"))?],
            guide_error_rad: self.take(&format!("e{i}"))?,
            guide_offset: self.take(&format!("d{i}"))?,
            ..PivotCoefficients::IDEAL
        };
        for ([cosine, sine], k) in built.encoder_rad.iter_mut().zip(1..) {
            *cosine = self.take(&format!("Ec{k}_{i}"))?;
            *sine = self.take(&format!("Es{k}_{i}"))?;
        }
        for ([cosine, sine], k) in built.runout.iter_mut().zip(2..) {
            *cosine = self.take(&format!("rc{k}_{i}"))?;
            *sine = self.take(&format!("rs{k}_{i}"))?;
        }
        for (size, k) in built.straightness.iter_mut().zip(2..) {
            *size = self.take(&format!("S{k}_{i}"))?;
        }
        Ok(built)
    }
}

/// Takes numbers, each key once: a map of the library would keep the last.
struct NumbersVisitor;

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = Numbers;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of numbers")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Numbers, A::Error> {
        let mut numbers = BTreeMap::new();
        while let Some((key, number)) = entries.next_entry::<String, f64>()? {
            if numbers.contains_key(&key) {
                return Err(A::Error::custom(format_args!("key '{key}' is there twice")));
            }
            numbers.insert(key, number);
        }
        Ok(Numbers(numbers))
    }
}

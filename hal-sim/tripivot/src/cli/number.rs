//! Numbers on the command line: what is none is called so, and what is out of its range is told the range.

use std::fmt::Display;
use std::ops::RangeInclusive;

/// Said of text that is no number at all.
const NO_NUMBER: &str = "not a number";

/// Any number, also infinite or NaN: what it stands for decides.
pub(super) fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| NO_NUMBER.to_owned())
}

/// Largest length, mm, and angle, deg: beyond it too few digits are left to mean anything.
const LARGEST: f64 = 1e9;

/// A length, mm, or an angle, deg.
pub(super) fn coordinate(text: &str) -> Result<f64, String> {
    match number(text)? {
        value if value.is_finite() && value.abs() > LARGEST => Err(not_within(&-LARGEST, &LARGEST)),
        value => Ok(value),
    }
}

/// A number from the first to the last of `range`.
pub(super) fn within(range: RangeInclusive<f64>) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let value = number(text)?;
        if value.is_nan() {
            return Err(NO_NUMBER.to_owned());
        }
        if range.contains(&value) {
            Ok(value)
        } else {
            Err(not_within(range.start(), range.end()))
        }
    }
}

/// A whole number from the first to the last of `range`.
pub(super) fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: Copy + Display + PartialOrd + TryFrom<i128>,
{
    move |text| {
        // Wider than every type that is asked for: a number out of range is still a number.
        let value = text.parse::<i128>().map_err(|_| match number(text) {
            Ok(value) if value.is_finite() && value.fract() != 0.0 => {
                "not a whole number".to_owned()
            }
            Ok(value) if !value.is_nan() => not_within(range.start(), range.end()),
            _ => NO_NUMBER.to_owned(),
        })?;
        match T::try_from(value) {
            Ok(value) if range.contains(&value) => Ok(value),
            _ => Err(not_within(range.start(), range.end())),
        }
    }
}

fn not_within(first: &impl Display, last: &impl Display) -> String {
    format!("not from {first} to {last}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_from_what_is_none() {
        assert_eq!(number("-1e3"), Ok(-1000.0));
        assert_eq!(number("1,5"), Err("not a number".to_owned()));
        assert_eq!(number(""), Err("not a number".to_owned()));
    }

    #[test]
    fn a_range_has_both_its_ends() {
        let within = within(-80.0..=80.0);
        assert_eq!(within("-80"), Ok(-80.0));
        assert_eq!(within("80"), Ok(80.0));
        for out in ["-200", "80.001", "inf"] {
            assert_eq!(within(out), Err("not from -80 to 80".to_owned()), "{out}");
        }
        for none in ["eighty", "NaN", "1 2"] {
            assert_eq!(within(none), Err("not a number".to_owned()), "{none}");
        }
    }

    #[test]
    fn whole_numbers_are_whole() {
        let whole = whole(0..=u64::MAX);
        assert_eq!(whole("18446744073709551615"), Ok(u64::MAX));
        let range = "not from 0 to 18446744073709551615".to_owned();
        for out in ["-1", "18446744073709551616", "1e40", "-inf"] {
            assert_eq!(whole(out), Err(range.clone()), "{out}");
        }
        assert_eq!(whole("1.5"), Err("not a whole number".to_owned()));
        for none in ["one", "NaN", "0x10"] {
            assert_eq!(whole(none), Err("not a number".to_owned()), "{none}");
        }
    }
}

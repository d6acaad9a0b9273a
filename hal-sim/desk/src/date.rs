//! Today's date, for what is written into files.

use std::time::{SystemTime, UNIX_EPOCH};

/// Today in UTC, as in 2026-11-23.
#[must_use]
pub fn today() -> String {
    date(day_of_today())
}

/// Days since a date in that form; `None` where it is none, or is to come.
#[must_use]
pub fn age_days(text: &str) -> Option<u64> {
    let mut parts = text.split('-').map(str::parse::<u64>);
    let (Some(Ok(year)), Some(Ok(month)), Some(Ok(of_month)), None) =
        (parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return None;
    };
    if !(1970..=9999).contains(&year) {
        return None;
    }
    // A date is that of one day, at most two from where months of 30.6 days put it.
    let near = (year - 1970) * 1461 / 4 + month.checked_sub(1)? * 306 / 10 + of_month;
    let written = format!("{year}-{month:02}-{of_month:02}");
    let day = (near.saturating_sub(4)..near + 4).find(|&day| date(day) == written)?;
    day_of_today().checked_sub(day)
}

fn day_of_today() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap_or_default().as_secs() / 86_400
}

/// Year, month and day of a day since 1970-01-01 (H. Hinnant, "chrono-compatible low-level date algorithms").
fn date(day: u64) -> String {
    let from_march_0 = day + 719_468;
    let era = from_march_0 / 146_097;
    let of_era = from_march_0 % 146_097;
    let year_of_era = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = (month_from_march + 2) % 12 + 1;
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::{age_days, date, day_of_today, today};

    #[test]
    fn days_have_their_dates() {
        for (day, text) in [
            (0, "1970-01-01"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (20_453, "2025-12-31"),
            (20_454, "2026-01-01"),
        ] {
            assert_eq!(date(day), text);
        }
    }

    #[test]
    fn the_age_of_a_date_is_in_days() {
        assert_eq!(age_days(&today()), Some(0));
        for back in 0..=day_of_today() {
            assert_eq!(age_days(&date(day_of_today() - back)), Some(back));
        }
        let tomorrow = date(day_of_today() + 1);
        for none in [
            &*tomorrow,
            "",
            "2026",
            "2026-02-30",
            "2026-00-01",
            "2026-1-1-1",
            "last week",
        ] {
            assert_eq!(age_days(none), None, "{none}");
        }
    }
}

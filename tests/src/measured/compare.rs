//! Figures beside those of the page.

/// How far a figure may be off the page's, as a share of it.
pub const TOLERANCE: f64 = 0.1;

/// What differs between the figures of the page and fresh ones: other words, or a number that is off by more than [`TOLERANCE`].
#[must_use]
pub fn differences(page: &str, fresh: &str) -> Vec<String> {
    let (page, fresh): (Vec<_>, Vec<_>) = (page.lines().collect(), fresh.lines().collect());
    if page.len() != fresh.len() {
        return vec![format!(
            "{} lines in the page, {} now",
            page.len(),
            fresh.len()
        )];
    }
    (page.into_iter().zip(fresh))
        .filter(|(page, fresh)| !is_near(page, fresh))
        .map(|(page, fresh)| format!("in the page: {page}\n        now: {fresh}"))
        .collect()
}

/// What differs between the cost table of the page and `kept`, the rows of `firmware/figures.csv` that count instructions.
#[must_use]
pub fn cost_differences(page: &str, kept: &str) -> Vec<String> {
    (kept.lines().filter_map(cost_row))
        .filter_map(|(part, figures)| {
            let row = page
                .lines()
                .find_map(|line| line.strip_prefix(part)?.strip_prefix(' '));
            let Some(row) = row else {
                return Some(format!("{part} is not in the page"));
            };
            let numbers: Vec<_> = row.split_whitespace().filter_map(number).collect();
            let is_in = (numbers.windows(2))
                .any(|pair| (figures.iter().zip(pair)).all(|(kept, &page)| is_close(*kept, page)));
            (!is_in).then(|| format!("{part}: {figures:?} kept, {row} in the page"))
        })
        .collect()
}

/// Name, mean and worst of a row of instructions.
fn cost_row(row: &str) -> Option<(&str, [f64; 2])> {
    let (part, figures) = row.split_once(",instructions,")?;
    let (mean, worst) = figures.split_once(',')?;
    Some((
        part.trim_matches('"'),
        [mean.parse().ok()?, worst.parse().ok()?],
    ))
}

fn is_near(page: &str, fresh: &str) -> bool {
    let (page, fresh): (Vec<_>, Vec<_>) = (
        page.split_whitespace().collect(),
        fresh.split_whitespace().collect(),
    );
    page.len() == fresh.len()
        && (page.into_iter().zip(fresh)).all(|(page, fresh)| match (number(page), number(fresh)) {
            (Some(page), Some(fresh)) => is_close(page, fresh),
            _ => page == fresh,
        })
}

fn is_close(page: f64, fresh: f64) -> bool {
    (fresh - page).abs() <= TOLERANCE * page.abs()
}

/// A word that is a number, whatever stands behind it.
fn number(word: &str) -> Option<f64> {
    word.trim_end_matches([',', ';', ':', ')', '%'])
        .parse()
        .ok()
}

#[cfg(test)]
mod tests {
    use super::{cost_differences, differences};

    #[test]
    fn a_tenth_is_allowed() {
        let page = "error 1.00 um, peak 20\nworst -3";
        assert_eq!(
            differences(page, "error 1.09 um, peak 18.1\nworst -3.2"),
            [""; 0]
        );
        for other in [
            "error 1.11 um, peak 20\nworst -3",
            "error 0.89 um, peak 20\nworst -3",
            "error 1.00 mm, peak 20\nworst -3",
            "error 1.00 um, peak NaN\nworst -3",
            "error 1.00 um, peak never\nworst -3",
            "error 1.00 um, peak 20\nworst 3",
            "error 1.00 um, peak 20\nworst -3 4",
        ] {
            assert_eq!(differences(page, other).len(), 1, "{other}");
        }
        assert_eq!(differences(page, "error 1.00 um, peak 20").len(), 1);
    }

    #[test]
    fn costs_are_found_by_their_part() {
        let kept = "part,unit,mean,worst\nplan,instructions,100.5,200\n\"plan: a, b\",instructions,10,20\nflash,bytes,1,1\n";
        let page = "instructions   calls   mean   worst\nplan             300  100.5     200\nplan: a, b       300   10.0      20\n";
        assert_eq!(cost_differences(page, kept), [""; 0]);
        assert_eq!(cost_differences(&page.replace("200", "230"), kept).len(), 1);
        assert_eq!(cost_differences(&page.replace("a, b", "c"), kept).len(), 1);
    }
}

//! The answer of `DRR?`: a head of `# KEY = value`, then a row a line.

use super::Record;

/// Appends the rows, and takes names and period from the head; `None` when it is no such answer.
pub(crate) fn read(answer: &str, record: &mut Record) -> Option<()> {
    record.names.clear();
    let mut lines = answer.lines();
    for line in lines.by_ref() {
        let line = line.strip_prefix('#')?.trim();
        if line == "END_HEADER" {
            break;
        }
        let (key, value) = line.split_once(" = ")?;
        match key {
            "SAMPLE_TIME" => record.period_s = value.parse().ok()?,
            key if key.starts_with("NAME") => record.names.push(value.to_owned()),
            _ => {}
        }
    }
    for line in lines {
        let row: Vec<f64> = (line.split_whitespace())
            .map(|number| number.parse().ok())
            .collect::<Option<_>>()?;
        if row.len() != record.names.len() {
            return None;
        }
        record.rows.push(row);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANSWER: &str = "# DIM = 2\n# NDATA = 2\n# SAMPLE_TIME = 0.0001\n# SEPARATOR = 32\n# TYPE = 1\n\
         # NAME0 = commanded position of X, mm\n# NAME1 = state\n# END_HEADER\n1.5 1\n-2 NaN";

    #[test]
    fn an_answer() {
        let mut record = Record::default();
        assert_eq!(read(ANSWER, &mut record), Some(()));
        assert_eq!(record.period_s, 1e-4);
        assert_eq!(record.names, ["commanded position of X, mm", "state"]);
        assert_eq!(record.rows[0], [1.5, 1.0]);
        assert!(record.rows[1][1].is_nan());
    }

    #[test]
    fn what_is_no_answer() {
        for bad in [
            "",
            "x",
            "0",
            "# DIM\n# END_HEADER\n",
            &ANSWER.replace("1.5 1", "1.5"),
        ] {
            let understood = read(bad, &mut Record::default());
            assert!(understood.is_none() || bad.is_empty(), "{bad:?}");
        }
    }
}

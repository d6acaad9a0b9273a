//! Parameters that are others for a time, and what they were. Who is cut off meanwhile leaves them so; whoever comes next takes them as they are kept.

use super::bench::{Answered, Bench};

/// What they were.
#[derive(Clone, Debug)]
#[must_use]
pub(crate) struct Aside(Vec<(u32, f64)>);

impl Aside {
    /// Sets them.
    ///
    /// # Errors
    /// What the controller refuses.
    pub fn set(bench: &mut Bench<'_>, values: &[(u32, f64)]) -> Answered<Self> {
        let mut before = read(bench, values)?;
        if before == values {
            for (id, _) in values {
                bench.recall(*id)?;
            }
            before = read(bench, values)?;
        }
        if before != values {
            bench.set(values)?;
        }
        Ok(Self(before))
    }

    /// They are as they were.
    ///
    /// # Errors
    /// What the controller refuses.
    pub fn give_back(self, bench: &mut Bench<'_>) -> Answered<()> {
        bench.set(&self.0)
    }
}

fn read(bench: &mut Bench<'_>, values: &[(u32, f64)]) -> Answered<Vec<(u32, f64)>> {
    let of = |&(id, _): &(u32, f64)| Ok((id, bench.parameter(id)?));
    values.iter().map(of).collect()
}

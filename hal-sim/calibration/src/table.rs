//! Measured visits as rows of a table, lengths in mm and angles in deg. The first row names the columns and thereby the instrument.
//!
//! | instrument | columns |
//! |---|---|
//! | x, y, theta | `m1_deg,m2_deg,m3_deg,x_mm,y_mm,theta_deg` |
//! | x, y | `m1_deg,m2_deg,m3_deg,x_mm,y_mm` |
//! | theta | `m1_deg,m2_deg,m3_deg,theta_deg` |
//! | camera | `m1_deg,m2_deg,m3_deg,mark_x_mm,mark_y_mm,camera_x_mm,camera_y_mm,off_x_um,off_y_um` |
//! | ends of guides | `m1_deg,m2_deg,m3_deg,guide,end_mm` |
//!
//! m1 to m3 are the encoders' readings, multi-turn or not. A mark and a place of the camera are known by where they were drawn, in the
//! platform's and in the base frame: the same numbers are the same mark. An end is known by its guide, 1 to 3, and by where it was
//! drawn on it. `off` is how far the mark was seen from the cross-hair.
//!
//! A line `# visit N, pose, T s of the controller's clock` before a row says when it was made; `reference` in place of `pose`, that the first
//! pose was visited again.

use crate::kit::{Instrument, Kit, Noise};
use crate::visit::{Seen, Visit};

const READINGS: &str = "m1_deg,m2_deg,m3_deg";
const COLUMNS: [(Kit, &str); 6] = [
    (Kit::Xyt, "x_mm,y_mm,theta_deg"),
    (Kit::Xy, "x_mm,y_mm"),
    (Kit::Theta, "theta_deg"),
    (
        Kit::Camera,
        "mark_x_mm,mark_y_mm,camera_x_mm,camera_y_mm,off_x_um,off_y_um",
    ),
    (
        Kit::Balls,
        "ball_x_mm,ball_y_mm,gauge_x_mm,gauge_y_mm,off_x_um,off_y_um",
    ),
    (Kit::Ends, "guide,end_mm"),
];
const UM_PER_MM: f64 = 1e3;

/// Why a table cannot be taken.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum TableError {
    /// There is no first row.
    #[error("no rows: the first names the columns")]
    Empty,
    /// The first row names no instrument's columns.
    #[error(
        "line {line}: '{found}' are no instrument's columns; '{READINGS}' and then one of '{}'",
        all_columns()
    )]
    Columns {
        /// From 1.
        line: usize,
        /// What stands there.
        found: String,
    },
    /// A row does not have as many values as there are columns.
    #[error("line {line}: {found} values where {wanted} are expected")]
    Count {
        /// From 1.
        line: usize,
        /// How many there are.
        found: usize,
        /// How many there should be.
        wanted: usize,
    },
    /// A guide is none of the three.
    #[error("line {line}: there is no guide {text}")]
    Guide {
        /// From 1.
        line: usize,
        /// What stands there.
        text: String,
    },
    /// A value is no finite number.
    #[error("line {line}: '{text}' is not a number")]
    Number {
        /// From 1.
        line: usize,
        /// What stands there.
        text: String,
    },
}

/// Visits with what they say of the instrument.
#[derive(Clone, PartialEq, Debug)]
pub struct Table {
    /// Which instrument.
    pub kit: Kit,
    /// The visits.
    pub visits: Vec<Visit>,
    /// The line of each visit, from 1.
    pub lines: Vec<usize>,
    /// Visits of the reference pose, the first pose among them, by their places in the list, and when they were made, s.
    pub references: Vec<(usize, f64)>,
    marks: Vec<[f64; 2]>,
    cameras: Vec<[f64; 2]>,
    ends: Vec<[f64; 2]>,
}

impl Table {
    /// Reads a table of a stage of this track radius. Empty lines and those that begin with # are passed over.
    ///
    /// # Errors
    /// [`TableError`]: the first line that is wrong.
    pub fn from_text(text: &str, radius_mm: f64) -> Result<Self, TableError> {
        let mut lines = (text.lines().zip(1..))
            .map(|(text, line)| (text.trim(), line))
            .filter(|(text, _)| !text.is_empty());
        let (head, line) = (lines.by_ref())
            .find(|(text, _)| !text.starts_with('#'))
            .ok_or(TableError::Empty)?;
        let head: String = head.split(',').map(str::trim).collect::<Vec<_>>().join(",");
        let named = (COLUMNS.iter()).find(|(_, columns)| head == format!("{READINGS},{columns}"));
        let Some(&(kit, _)) = named else {
            return Err(TableError::Columns { line, found: head });
        };
        let mut table = Self {
            kit,
            visits: Vec::new(),
            lines: Vec::new(),
            references: Vec::new(),
            marks: Vec::new(),
            cameras: Vec::new(),
            ends: Vec::new(),
        };
        let wanted = head.split(',').count();
        for (text, line) in lines {
            if let Some(words) = text.strip_prefix('#') {
                let next = table.visits.len();
                let at_s = reference_s(words, next == 0);
                table.references.extend(at_s.map(|at_s| (next, at_s)));
                continue;
            }
            let values = numbers(text, line, wanted)?;
            if kit == Kit::Ends && ![1.0, 2.0, 3.0].contains(&values[3]) {
                let text = values[3].to_string();
                return Err(TableError::Guide { line, text });
            }
            let Some(visit) = table.visit(&values, radius_mm) else {
                let found = values.len();
                return Err(TableError::Count {
                    line,
                    found,
                    wanted,
                });
            };
            table.visits.push(visit);
            table.lines.push(line);
        }
        if kit == Kit::Camera && table.cameras.len() > 1 {
            table.kit = Kit::Camera2;
        }
        Ok(table)
    }

    /// The instrument, with marks and places of the camera as they were drawn.
    #[must_use]
    pub fn instrument(&self, noise: Noise) -> Instrument {
        let mut instrument = Instrument::new(self.kit, noise);
        instrument.marks.clone_from(&self.marks);
        instrument.cameras.clone_from(&self.cameras);
        let ends = self
            .ends
            .iter()
            .map(|&[guide, place]| (guide as usize - 1, place));
        instrument.ends = ends.collect();
        instrument
    }

    /// Visits of the reference pose that are not among these.
    #[must_use]
    pub fn references_but(&self, outliers: &[usize]) -> Vec<(usize, f64)> {
        let all = self.references.iter().copied();
        all.filter(|(visit, _)| !outliers.contains(visit)).collect()
    }

    /// The visit of a row.
    fn visit(&mut self, values: &[f64], radius_mm: f64) -> Option<Visit> {
        let (readings_deg, seen) = values.split_first_chunk::<3>()?;
        let radii = |mm: f64| mm / radius_mm;
        let seen = match (self.kit, seen) {
            (Kit::Xyt, &[x, y, theta]) => Seen::Pose([radii(x), radii(y), theta.to_radians()]),
            (Kit::Xy, &[x, y]) => Seen::Place([radii(x), radii(y)]),
            (Kit::Theta, &[theta]) => Seen::Turn(theta.to_radians()),
            (Kit::Camera | Kit::Balls, &[mark_x, mark_y, camera_x, camera_y, x_um, y_um]) => {
                Seen::Mark {
                    mark: place_in(&mut self.marks, [radii(mark_x), radii(mark_y)]),
                    camera: place_in(&mut self.cameras, [radii(camera_x), radii(camera_y)]),
                    off: [radii(x_um / UM_PER_MM), radii(y_um / UM_PER_MM)],
                }
            }
            (Kit::Ends, &[guide, end]) => Seen::End {
                end: place_in(&mut self.ends, [guide, radii(end)]),
            },
            _ => return None,
        };
        Some(Visit {
            readings_rad: readings_deg.map(f64::to_radians),
            seen,
        })
    }
}

/// Writes visits of an instrument as a table.
#[must_use]
pub fn to_text(instrument: &Instrument, visits: &[Visit], radius_mm: f64) -> String {
    let kit = match instrument.kit {
        Kit::Camera2 => Kit::Camera,
        kit => kit,
    };
    let columns = COLUMNS.iter().find(|(known, _)| *known == kit);
    let mut text = format!(
        "{READINGS},{}\n",
        columns.map_or("", |(_, columns)| *columns)
    );
    for Visit { readings_rad, seen } in visits {
        let mut row = readings_rad.map(f64::to_degrees).to_vec();
        match *seen {
            Seen::Pose([x, y, theta]) => {
                row.extend([x * radius_mm, y * radius_mm, theta.to_degrees()]);
            }
            Seen::Place(place) => row.extend(place.map(|value| value * radius_mm)),
            Seen::Turn(theta) => row.push(theta.to_degrees()),
            Seen::Mark { mark, camera, off } => {
                let drawn = [instrument.marks.get(mark), instrument.cameras.get(camera)];
                let drawn = drawn.into_iter().flatten().flatten();
                row.extend(drawn.map(|value| value * radius_mm));
                row.extend(off.map(|value| value * radius_mm * UM_PER_MM));
            }
            Seen::End { end } => {
                let drawn = instrument.ends.get(end);
                row.extend(
                    drawn
                        .into_iter()
                        .flat_map(|&(guide, place)| [1.0 + guide as f64, place * radius_mm]),
                );
            }
        }
        let row: Vec<String> = row.iter().map(|value| format!("{value:.12}")).collect();
        text += &(row.join(",") + "\n");
    }
    text
}

/// What is said of the visit below, and when it was made.
#[must_use]
pub fn note(visit: usize, is_reference: bool, clock_s: f64) -> String {
    let what = if is_reference { "reference" } else { "pose" };
    format!(
        "# visit {}, {what}, {clock_s:.3} s of the controller's clock",
        visit + 1
    )
}

/// When a visit of the reference pose was made, from what is said of it; the first pose is the reference pose.
fn reference_s(note: &str, is_first: bool) -> Option<f64> {
    let mut parts = note.trim().strip_prefix("visit ")?.split(", ");
    let is_reference = parts.nth(1)? == "reference" || is_first;
    let at_s = parts.next()?.split(' ').next()?.parse().ok()?;
    is_reference.then_some(at_s)
}

/// The place of an entry in a list, which gets it if it has not.
fn place_in(list: &mut Vec<[f64; 2]>, entry: [f64; 2]) -> usize {
    let known = list.iter().position(|known| *known == entry);
    known.unwrap_or_else(|| {
        list.push(entry);
        list.len() - 1
    })
}

fn numbers(text: &str, line: usize, wanted: usize) -> Result<Vec<f64>, TableError> {
    let found = text.split(',').count();
    if found != wanted {
        return Err(TableError::Count {
            line,
            found,
            wanted,
        });
    }
    let number = |cell: &str| match cell.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(TableError::Number {
            line,
            text: cell.trim().to_owned(),
        }),
    };
    text.split(',').map(number).collect()
}

fn all_columns() -> String {
    COLUMNS.map(|(_, columns)| columns).join("', '")
}

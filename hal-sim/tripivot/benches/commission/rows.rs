//! Rows of machines: kept in a file as they are done, and put together as a table.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;

/// What a machine came to.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    pub seed: u64,
    /// At which step, and why.
    pub refused: Option<String>,
    /// By the names of [`FIGURES`].
    pub figures: BTreeMap<String, f64>,
    /// How long each step took, s.
    pub steps: Vec<(String, f64)>,
}

/// A figure's short name, what it is, digits behind the point, and its limit.
type Figure = (&'static str, &'static str, usize, Option<f64>);

const FIGURES: [Figure; 32] = [
    ("time", "simulated time, s", 0, Some(300.0)),
    ("questions", "questions to the person", 0, Some(2.0)),
    ("ms safe", "Ms with safe gains", 2, None),
    ("ms", "Ms as tuned", 2, Some(2.0)),
    ("s30 safe", "S(30 Hz) with safe gains", 3, None),
    ("s30", "S(30 Hz) as tuned", 3, None),
    (
        "s30 gain",
        "S(30 Hz) as tuned over that with safe gains",
        2,
        None,
    ),
    ("ms true", "Ms on the true plant", 2, Some(2.0)),
    ("s30 true", "S(30 Hz) on the true plant", 3, None),
    (
        "s30 best",
        "S(30 Hz) on the true plant over the best that gains can do there",
        2,
        Some(1.25),
    ),
    (
        "s30 every day",
        "S(30 Hz) there over the best that keeps what it has to keep every day",
        2,
        Some(1.25),
    ),
    (
        "ms cold",
        "Ms on the true plant, windings cold",
        2,
        Some(2.0),
    ),
    (
        "ms warm",
        "Ms on the true plant, windings 60 K warmer than that",
        2,
        Some(2.0),
    ),
    (
        "peak",
        "following error of a pivot at full speed, urad",
        1,
        None,
    ),
    ("R J / K", "R J / K, % off", 2, Some(0.5)),
    ("K", "motor constant, % off", 2, Some(1.0)),
    ("R", "resistance, % off", 2, Some(5.0)),
    (
        "R warm",
        "resistance as warm as it was, % off",
        2,
        Some(5.0),
    ),
    ("L", "inductance, % off", 2, Some(5.0)),
    ("friction", "Coulomb friction, % off", 2, Some(5.0)),
    ("total", "friction at 1 rad/s, % off", 2, Some(5.0)),
    ("gears", "cyclic error of a gear, % off", 2, None),
    (
        "gears left",
        "following error once a turn of a motor, gears made up for over not",
        2,
        None,
    ),
    ("guides", "friction of a carriage, % off", 2, Some(15.0)),
    ("give", "stiffness across a guide, % off", 2, Some(15.0)),
    ("ring", "inertia at a ring, % off", 2, Some(5.0)),
    ("drive", "inertia of motor and ring, % off", 2, Some(5.0)),
    ("mass", "mass of platform and load, % off", 2, Some(5.0)),
    ("inertia", "their inertia, % off", 2, Some(5.0)),
    (
        "ratio",
        "mass over inertia of motor and ring, % off",
        2,
        Some(2.0),
    ),
    ("resonance", "first resonance, % off", 2, Some(2.0)),
    (
        "resonances",
        "resonances up to 1,500 Hz, worst, % off",
        2,
        Some(2.0),
    ),
];

/// The rows of a file, none where there is none.
pub fn read(path: &Path) -> Vec<Row> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let row = |line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{line}: {error}"));
    text.lines().map(row).collect()
}

/// A row more.
pub fn append(path: &Path, row: &Row) {
    let mut line = serde_json::to_string(row).expect("numbers and names");
    line.push('\n');
    let file = OpenOptions::new().create(true).append(true).open(path);
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

impl Row {
    fn figure(&self, name: &str) -> Option<f64> {
        let value = self.figures.get(name);
        value.copied().filter(|value| value.is_finite())
    }

    /// A line for whoever waits: what it came to, and what has missed its limit.
    pub fn words(&self) -> String {
        let figure = |name| self.figure(name).unwrap_or(f64::NAN);
        let mut words = format!("{}: {:.0} s", self.seed, figure("time"));
        if let Some(why) = &self.refused {
            return format!("{words}, refused at {why}");
        }
        words += &format!(
            ", Ms {:.2} -> {:.2}, S(30 Hz) {:.3} -> {:.3}",
            figure("ms safe"),
            figure("ms"),
            figure("s30 safe"),
            figure("s30")
        );
        for (name, _, digits, limit) in FIGURES {
            let value = figure(name);
            if limit.is_some_and(|limit| !(value.abs() <= limit)) {
                words += &format!("; {name} {value:.digits$}");
            }
        }
        words
    }
}

/// The table: sizes, whatever their sign.
pub fn print(all: &[Row]) {
    let refused: Vec<_> = all.iter().filter(|row| row.refused.is_some()).collect();
    println!("machines: {}; refused: {}", all.len(), refused.len());
    for row in refused {
        println!("{}", row.words());
    }
    println!("| what | median | 90 % | 99 % | worst | machine | limit | beyond it |");
    println!("|---|---|---|---|---|---|---|---|");
    for (name, what, digits, limit) in FIGURES {
        let mut sizes: Vec<(f64, u64)> = (all.iter())
            .filter(|row| row.refused.is_none())
            .filter_map(|row| Some((row.figure(name)?.abs(), row.seed)))
            .collect();
        sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(&(worst, seed)) = sizes.last() else {
            continue;
        };
        let part = |part: f64| sizes[((sizes.len() - 1) as f64 * part).round() as usize].0;
        let [median, most, nearly] = [0.5, 0.9, 0.99].map(part);
        let told = limit.map_or("-".to_owned(), |limit| limit.to_string());
        let beyond = limit.map_or("-".to_owned(), |limit| {
            let count = sizes.iter().filter(|(size, _)| *size > limit).count();
            count.to_string()
        });
        println!(
            "| {what} | {median:.digits$} | {most:.digits$} | {nearly:.digits$} | {worst:.digits$} | {seed} | {told} | {beyond} |"
        );
    }
    steps(all);
}

/// How long the steps take, by the controller's clock.
fn steps(all: &[Row]) {
    let Some(longest) = all.iter().max_by_key(|row| row.steps.len()) else {
        return;
    };
    println!("\n| step | median, s | worst, s |");
    println!("|---|---|---|");
    for (step, _) in &longest.steps {
        let times = all.iter().flat_map(|row| &row.steps);
        let mut times: Vec<f64> = (times.filter(|(name, _)| name == step))
            .map(|(_, seconds)| *seconds)
            .collect();
        times.sort_by(f64::total_cmp);
        println!(
            "| {step} | {:.1} | {:.1} |",
            times[times.len() / 2],
            times[times.len() - 1]
        );
    }
}

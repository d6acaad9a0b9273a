//! How well unknown machines are identified, as tables: `cargo bench -p commissioning --bench machines`. `-- N` takes N machines in place of 20,
//! `-- N V W S` V volts rms, a rate of W rad/s, and machines from seed S on.

#[path = "../tests/machine/mod.rs"]
mod machine;

use machine::truth::{NAMES, OFF_NAMES, errors, identify, off_over_uncertainty, spread};
use machine::{PLAN, Plan, unknown};

fn main() {
    let numbers: Vec<f64> = std::env::args()
        .filter_map(|word| word.parse().ok())
        .collect();
    let machines = numbers.first().copied().unwrap_or(20.0) as u64;
    let plan = Plan {
        rms_v: numbers.get(1).copied().unwrap_or(PLAN.rms_v),
        rate_rad_s: numbers.get(2).copied().unwrap_or(PLAN.rate_rad_s),
        ..PLAN
    };
    let (mut all, mut off, mut residuals): (Vec<_>, Vec<_>, Vec<_>) = Default::default();
    let first = numbers.get(3).copied().unwrap_or(0.0) as u64;
    for seed in first..first + machines {
        let parameters = unknown(seed);
        let found = identify(&parameters, &plan);
        all.push(errors(&parameters, &found));
        if let Some(errors) = all.last().filter(|errors| errors[0].abs() > 0.02) {
            println!(
                "machine {seed}: R J / K off by {:.1} %, model {:?}",
                100.0 * errors[0],
                found.model
            );
        }
        off.push(off_over_uncertainty(&parameters, &found.model));
        residuals.push(found.model.mechanical.residual);
    }
    println!(
        "{machines} machines; {} V rms on each drive in turn, turning at {} rad/s",
        plan.rms_v, plan.rate_rad_s
    );
    println!("| what | median | 90 % | worst | mean with its sign |");
    println!("|---|---|---|---|---|");
    for (k, name) in NAMES.iter().enumerate() {
        let mut sizes: Vec<f64> = all.iter().map(|errors| errors[k].abs()).collect();
        let mean = all.iter().map(|errors| errors[k]).sum::<f64>() / all.len() as f64;
        let [median, most, worst] = spread(&mut sizes);
        println!(
            "| {name} | {:.2} % | {:.2} % | {:.2} % | {:+.2} % |",
            100.0 * median,
            100.0 * most,
            100.0 * worst,
            100.0 * mean
        );
    }
    let [median, most, worst] = spread(&mut residuals);
    println!(
        "| what the model leaves of the responses | {:.2} % | {:.2} % | {:.2} % | |",
        100.0 * median,
        100.0 * most,
        100.0 * worst
    );
    println!();
    println!("| off, over what it may be off | median | 90 % | worst |");
    println!("|---|---|---|---|");
    for (k, name) in OFF_NAMES.iter().enumerate() {
        let mut shares: Vec<f64> = off.iter().map(|off| off[k]).collect();
        let [median, most, worst] = spread(&mut shares);
        println!("| {name} | {median:.2} | {most:.2} | {worst:.2} |");
    }
}

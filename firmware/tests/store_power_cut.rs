//! Power cuts: whenever the power fails while settings are written, all of the old ones are there afterwards or all of
//! the new ones. Cut off in the middle of every word and every erase of a random sequence of changes.
//!
//! `CHANGES=500 SEED=7 cargo test -p firmware --test store_power_cut` makes it longer, or another one.

mod flash_bench;

use firmware::settings_store::SettingsStore;
use flash_bench::{Flash, Kept, KeptBench, Random, fresh, kept, restore, write};

/// Small, so that the journal goes round it often.
const SECTOR: usize = 1024;
/// Ways in which every step is torn.
const TEARS: u64 = 4;

/// Numbers of parameters, and the range to choose from, that go together whatever they are.
const CHOICES: &[(u32, f64, f64)] = &[
    (0x5450_0100, 50.0, 200.0),
    (0x5450_0107, 100.0, 300.0),
    (0x5450_0300, 100.0, 400.0),
    (0x5450_0301, 10.0, 60.0),
    (0x5450_0400, 1.0, 5.0),
    (0x5450_0500, 0.01, 0.2),
    (0x5450_0702, 0.0, 5.0),
];

fn number_from(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
}

/// A change of settings, as lines.
fn change(random: &mut Random) -> String {
    let mut lines = String::new();
    for _ in 0..=random.below(3) {
        let (id, lowest, highest) = CHOICES[random.below(CHOICES.len())];
        let share = random.below(1000) as f64 / 1000.0;
        let value = lowest + share * (highest - lowest);
        lines += &format!("SPA 1 {id} {value}\n");
    }
    lines + "WPA 100\n"
}

/// A macro that is recorded anew, or deleted.
fn macro_change(random: &mut Random, bench: &mut KeptBench<SECTOR>) {
    let name = ["A", "LONGER", "third_one"][random.below(3)];
    let there = bench.say("MAC?\n").contains(name);
    if there && random.below(2) == 0 {
        assert!(bench.bench.offer(0, format!("MAC DEL {name}\n").as_bytes()));
        return;
    }
    let mut lines = format!("MAC BEG {name}\n");
    for _ in 0..random.below(6) {
        lines += &format!("MOV X {}\n", random.below(40));
    }
    assert!(bench.bench.offer(0, (lines + "MAC END\n").as_bytes()));
}

/// What a start with this flash finds, which is no damage.
fn found(flash: &Flash<SECTOR>, context: &str) -> Kept {
    let mut panel = fresh();
    let problem = restore(&mut SettingsStore::new(flash.powered()), &mut panel);
    assert_eq!(problem, None, "{context}");
    kept(&panel, panel.parameters())
}

#[test]
fn at_any_step_the_old_settings_are_there_or_the_new_ones() {
    let (changes, seed) = (number_from("CHANGES", 60), number_from("SEED", 1));
    println!("CHANGES={changes} SEED={seed}");
    let mut random = Random(seed);
    let mut bench = KeptBench::start(Flash::<SECTOR>::new());
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    let (mut cuts, mut old_found, mut new_found) = (0, 0, 0);
    for number in 0..changes {
        let before = bench.keeper.flash().powered();
        let old = found(&before, "before");
        if random.below(3) == 0 {
            macro_change(&mut random, &mut bench);
        } else {
            let lines = change(&mut random);
            assert!(bench.bench.offer(0, lines.as_bytes()));
        }
        bench.bench.run(3);
        // Not carried out yet: this is what it will be.
        let panel = bench.bench.panel_mut();
        let new = kept(panel, panel.parameters_to_store());
        let mut survivor = None;
        for step in 0.. {
            let mut ended = false;
            for tear in 0..TEARS {
                let context = format!("seed {seed}, change {number}, step {step}, tear {tear}");
                let mut flash = before.powered();
                let tear_seed = random.bits();
                flash.cut_in(step, tear_seed);
                let mut keeper = SettingsStore::new(flash);
                restore(&mut keeper, &mut fresh());
                ended = write(&mut keeper, panel).is_ok();
                cuts += u64::from(!ended);
                let after = keeper.flash().powered();
                let now = found(&after, &context);
                assert!(
                    now == old || now == new,
                    "{context}: {old:?} {new:?} {now:?}"
                );
                assert!(!ended || now == new, "{context}: kept, and it is not there");
                old_found += u64::from(now == old);
                new_found += u64::from(now == new);
                // Going on from there.
                let mut keeper = SettingsStore::new(after.clone());
                restore(&mut keeper, &mut fresh());
                assert_eq!(write(&mut keeper, panel), Ok(()), "{context}");
                assert_eq!(found(&keeper.flash().powered(), &context), new, "{context}");
                if random.below(40) == 0 {
                    survivor = Some(after);
                }
            }
            if ended {
                break;
            }
        }
        bench.say("");
        assert_eq!(found(&bench.keeper.flash().powered(), "whole"), new);
        // Every other time the sequence goes on from a flash that has been through a power cut.
        if let Some(flash) = survivor.filter(|_| random.below(2) == 0) {
            bench = KeptBench::start(flash);
            assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
        }
    }
    println!("{cuts} cuts; found old {old_found} times, new {new_found} times");
    assert!(cuts > 1000 && old_found > 1000 && new_found > 0);
}

//! The cost bench: that it counts what is there, and that growth is seen. Needs `cargo stage` and `cargo cost-image` first,
//! then `cargo chip-test`.

use image::chip::elf_file;
use image::cost::{CostError, Figures, Growth, Order, Part, Sizes, count};

fn order(states: u32, only: &str) -> Order {
    Order {
        states,
        seed: 1,
        only: only.to_owned(),
    }
}

fn sizes() -> Sizes {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    Sizes::read(&path).expect("an image with symbols")
}

fn part(name: &str, mean: f64, worst: u32) -> Part {
    Part {
        name: name.to_owned(),
        calls: 10,
        refused: 0,
        mean,
        worst,
        worst_call: 0,
        worst_ticks: 0,
        most_ticks: 0,
    }
}

#[test]
fn the_first_calls_of_a_longer_run_are_those_of_a_shorter_one() {
    let name = "direct kinematics";
    let run = |states| {
        let counted = count(&order(states, name), true).expect("the image: `cargo cost-image`");
        let own = counted.parts.iter().find(|part| part.name == name);
        own.expect("asked for").clone()
    };
    let (short, again, long) = (run(3), run(3), run(6));
    assert_eq!(short, again);
    assert_eq!((short.calls, long.calls), (30, 60));
    assert!(short.worst <= long.worst && short.mean > 100.0, "{short:?}");
    // With other calls twice the calls would hardly cost exactly twice as much.
    let (half, whole) = (short.mean * 30.0, long.mean * 60.0);
    assert!(
        whole > 1.9 * half && whole < 2.1 * half,
        "{short:?} {long:?}"
    );
}

#[test]
fn a_part_that_does_not_exist_is_refused() {
    let error = count(&order(1, "perpetual motion"), true).unwrap_err();
    assert!(matches!(error, CostError::NoPart(_)), "{error}");
}

#[test]
fn a_part_that_grows_by_more_than_3_percent_is_named_and_no_other() {
    let sizes = sizes();
    let figures = |parts: &[Part]| Figures::new(10, parts, &sizes);
    let kept = figures(&[part("steady", 100.0, 200), part("gone", 1.0, 1)]);
    let same = kept.growth(&kept);
    assert_eq!(same, []);
    // 3 % and the counter's two instructions.
    let within = figures(&[part("steady", 105.0, 208), part("gone", 1.0, 1)]);
    assert_eq!(kept.growth(&within), []);
    let now = figures(&[part("steady", 105.1, 209), part("new", 1.0, 1)]);
    let names = [
        "steady: 100 to 105.1",
        "steady: 200 to 209",
        "new: not",
        "gone: in",
    ];
    let said = growths(&kept, &now);
    assert_eq!(said.len(), names.len(), "{said:?}");
    for (said, name) in said.iter().zip(names) {
        assert!(said.starts_with(name), "{said}");
    }
}

#[test]
fn an_image_that_grows_is_named() {
    let mut sizes = sizes();
    let kept = Figures::new(10, &[], &sizes);
    sizes.total.flash += sizes.total.flash / 20;
    let said = growths(&kept, &Figures::new(10, &[], &sizes));
    assert!(
        said.len() == 1 && said[0].starts_with("stage: flash"),
        "{said:?}"
    );
}

#[test]
fn figures_come_back_from_their_file_as_they_went() {
    let figures = Figures::new(
        7,
        &[part("one", 12.34, 56), part("two, three", 7.0, 8)],
        &sizes(),
    );
    let path = std::env::temp_dir().join(format!("figures-{}.csv", std::process::id()));
    figures.write(&path).expect("a file that can be written");
    let read = Figures::read(&path).expect("a file that was written");
    std::fs::remove_file(&path).expect("there");
    assert_eq!(read, figures);
}

#[test]
fn the_parts_of_the_image_add_up_to_all_of_it() {
    let sizes = sizes();
    let sum = |of: fn(&image::cost::Bytes) -> u64| sizes.parts.values().map(of).sum::<u64>();
    assert_eq!(sum(|bytes| bytes.flash), sizes.total.flash);
    assert_eq!(sum(|bytes| bytes.ram), sizes.total.ram);
    assert!(sizes.generator() > 1_000 && sizes.compiler.starts_with("rustc version"));
}

fn growths(kept: &Figures, now: &Figures) -> Vec<String> {
    kept.growth(now).iter().map(Growth::to_string).collect()
}

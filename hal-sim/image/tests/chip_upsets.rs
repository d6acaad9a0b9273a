//! Bits of the unmodified image's RAM that flip while it works. Needs `cargo stage` first, then `cargo chip-test`.

use image::chip::{REGIONS, upset, upsets};

/// One of each part of the memory, and the first once more.
#[test]
fn an_upset_comes_to_what_it_came_to_before() {
    let runs = upsets(REGIONS.len() as u64, 7, 2).expect("runs that count");
    for (place, run) in runs.iter().enumerate() {
        println!("{run}");
        assert_eq!(run.upset.region, place);
    }
    let first = runs.first().expect("a run");
    let again = upset(first.upset.region, first.upset.seed).expect("a run that counts");
    assert_eq!(&again, first);
}

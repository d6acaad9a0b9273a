//! The fuzz target for some seconds. Hours of it: `cargo run --release --bin fuzz -- --seconds 3600`.

#[test]
fn nothing_is_found_in_the_first_cases() {
    for seed in 0..60 {
        println!("seed {seed}");
        tests::fuzz::run(seed);
    }
}

#[test]
fn no_content_of_the_flash_is_taken_for_what_it_is_not() {
    for seed in 0..1_000 {
        println!("seed {seed}");
        tests::fuzz::run_settings(seed);
    }
}

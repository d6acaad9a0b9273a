//! How randomised tests run.

use proptest::test_runner::{Config, RngAlgorithm, RngSeed};

/// Fixed seed, so that every run tests the same. Another seed: PROPTEST_RNG_SEED in the environment.
pub fn settings(cases: u32) -> Config {
    let seed = std::env::var("PROPTEST_RNG_SEED")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(20_260_214);
    println!("proptest seed {seed}");
    Config {
        cases,
        rng_seed: RngSeed::Fixed(seed),
        rng_algorithm: RngAlgorithm::ChaCha,
        failure_persistence: None,
        ..Config::default()
    }
}

//! A profile in whole ticks: durations, and the heights that lead to rest.

/// Durations of the main segments in ticks.
pub(crate) struct Shape {
    pub n: [u64; 7],
    pub released_in_part: bool,
}

/// Peak, brake, and the speed between.
pub(super) struct Solution {
    pub peak: f32,
    pub brake: f32,
    pub top: f32,
}

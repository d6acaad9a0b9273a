//! Compensation of the bridges' dead time, in which both switches of a leg are off.

/// The share of the dead time that counts: over the knee, where a motor at work is, all of it.
#[inline]
pub(super) fn dead_time_share(current: f32) -> f32 {
    let share = if current > 1.0 { 1.0 } else { current };
    if share < -1.0 { -1.0 } else { share }
}

/// The duty whose pulses, after the dead time has taken its part, are `wanted`.
///
/// Dead time shortens every pulse by `dead_counts` counts, or by all of it if that is less, times the `share` that the
/// current's size and sign decide (-1 to 1; it lengthens the pulse when the current flows against the voltage). A pulse
/// that comes out no longer than `dead_counts` is one that loses its share of itself.
#[inline]
pub(in crate::control) fn compensate_dead_time(wanted: f32, share: f32, dead_counts: f32) -> f32 {
    let pulse = wanted + dead_counts * share;
    let (size, share) = if wanted < 0.0 {
        (-pulse, -share)
    } else {
        (pulse, share)
    };
    if size >= dead_counts {
        pulse
    } else {
        wanted / (1.0 - share)
    }
}

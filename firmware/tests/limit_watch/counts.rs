//! What has been under the watch, so that a test can tell whether it has seen anything.

use super::allowance::Purpose;

/// How often something was under the watch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    pub ticks: u64,
    pub ordinary_plans: u64,
    pub stream_plans: u64,
    pub urgent_stops: u64,
    /// Plans that took over from an urgent stop.
    pub stops_left: u64,
    /// Of those, with more than the ordinary acceleration.
    pub stops_left_hard: u64,
    /// Plans that began above their limit of speed.
    pub begun_above: u64,
}

impl Counts {
    /// A plan for this has taken over.
    pub fn add_plan(&mut self, purpose: Purpose) {
        match purpose {
            Purpose::Ordinary => self.ordinary_plans += 1,
            Purpose::Stream => self.stream_plans += 1,
            Purpose::UrgentStop => self.urgent_stops += 1,
        }
    }

    /// Adds those of another script.
    pub fn add(&mut self, more: &Self) {
        self.ticks += more.ticks;
        self.ordinary_plans += more.ordinary_plans;
        self.stream_plans += more.stream_plans;
        self.urgent_stops += more.urgent_stops;
        self.stops_left += more.stops_left;
        self.stops_left_hard += more.stops_left_hard;
        self.begun_above += more.begun_above;
    }
}

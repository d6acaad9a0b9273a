//! Decimation that hides nothing: the smallest and largest value of every channel in each stretch of ticks.

/// Stretches kept at most: in a minute of motion one every few milliseconds, to be zoomed into.
const CAPACITY: usize = 16_384;

/// The extremes of `N` channels over one stretch of ticks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Bin<const N: usize> {
    /// Time of the first tick in it, s.
    pub start_s: f64,
    /// Time of the last tick in it, s.
    pub end_s: f64,
    /// Smallest value of each channel.
    pub min: [f64; N],
    /// Largest value of each channel.
    pub max: [f64; N],
}

impl<const N: usize> Bin<N> {
    fn of(time_s: f64, values: &[f64; N]) -> Self {
        Self {
            start_s: time_s,
            end_s: time_s,
            min: *values,
            max: *values,
        }
    }

    fn absorb(&mut self, other: &Self) {
        self.end_s = other.end_s;
        for channel in 0..N {
            self.min[channel] = self.min[channel].min(other.min[channel]);
            self.max[channel] = self.max[channel].max(other.max[channel]);
        }
    }
}

/// Any number of ticks in a bounded number of equally long bins. When they are full, neighbours merge and the bins' length
/// doubles.
#[derive(Clone, Debug)]
pub struct Envelope<const N: usize> {
    bins: Vec<Bin<N>>,
    ticks_per_bin: u32,
    ticks_in_last: u32,
}

impl<const N: usize> Default for Envelope<N> {
    fn default() -> Self {
        Self {
            bins: Vec::new(),
            ticks_per_bin: 1,
            ticks_in_last: 1,
        }
    }
}

impl<const N: usize> Envelope<N> {
    /// Adds one tick.
    pub fn add(&mut self, time_s: f64, values: &[f64; N]) {
        let tick = Bin::of(time_s, values);
        if let Some(last) = self.bins.last_mut()
            && self.ticks_in_last < self.ticks_per_bin
        {
            last.absorb(&tick);
            self.ticks_in_last += 1;
            return;
        }
        if self.bins.len() == CAPACITY {
            self.merge_neighbours();
        }
        self.bins.push(tick);
        self.ticks_in_last = 1;
    }

    /// The bins in the order of time.
    pub fn bins(&self) -> &[Bin<N>] {
        &self.bins
    }

    /// The same in at most `most` bins.
    pub fn reduced(&self, most: usize) -> Self {
        let mut reduced = self.clone();
        while reduced.bins.len() > most.max(1) {
            reduced.merge_neighbours();
        }
        reduced
    }

    /// An odd one at the end stays by itself.
    fn merge_neighbours(&mut self) {
        let count = self.bins.len().div_ceil(2);
        for pair in 0..count {
            let mut merged = self.bins[2 * pair];
            if let Some(second) = self.bins.get(2 * pair + 1) {
                merged.absorb(second);
            }
            self.bins[pair] = merged;
        }
        self.bins.truncate(count);
        self.ticks_per_bin *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_spike_is_lost() {
        let ticks = 100_003;
        for spike in [0, 1, 16_383, 16_384, 54_321, ticks - 1] {
            let mut envelope = Envelope::<2>::default();
            for tick in 0..ticks {
                let value = if tick == spike { 7.0 } else { 0.25 };
                envelope.add(tick as f64, &[value, -value]);
            }
            for most in [CAPACITY, 2_048, 3, 1, 0] {
                let reduced = envelope.reduced(most);
                assert!(reduced.bins().len() <= most.max(1));
                let hit: Vec<_> = (reduced.bins().iter())
                    .filter(|bin| bin.max[0] == 7.0 && bin.min[1] == -7.0)
                    .collect();
                assert_eq!(hit.len(), 1, "spike at tick {spike}");
                assert!((hit[0].start_s..=hit[0].end_s).contains(&(spike as f64)));
            }
        }
    }

    #[test]
    fn bins_cover_every_tick_once() {
        for ticks in [1, 2, 16_384, 16_385, 32_769, 80_001] {
            let mut envelope = Envelope::<1>::default();
            for tick in 0..ticks {
                envelope.add(f64::from(tick), &[0.0]);
            }
            let bins = envelope.bins();
            assert!(bins.len() <= CAPACITY);
            assert_eq!(bins[0].start_s, 0.0);
            assert_eq!(bins[bins.len() - 1].end_s, f64::from(ticks - 1));
            for pair in bins.windows(2) {
                assert_eq!(pair[0].end_s + 1.0, pair[1].start_s, "{ticks} ticks");
            }
        }
    }
}

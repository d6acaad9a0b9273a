//! What is done to a stage that is to notice it, and how one is made to.

use hal_sim::machine::plant::External;

use crate::Bench;

/// The pivot that is pushed and held, counted from 0.
pub const PIVOT: usize = 1;

impl Bench {
    /// Holding, with these parameters.
    ///
    /// # Panics
    /// When one is refused.
    #[must_use]
    pub fn holding(parameters: &[(u32, f64)]) -> Self {
        let mut bench = Self::ready();
        bench.set(parameters);
        bench
    }

    /// Turning steadily.
    ///
    /// # Panics
    /// When it does not.
    #[must_use]
    pub fn turning(parameters: &[(u32, f64)], deg_s: f64) -> Self {
        let mut bench = Self::holding(parameters);
        assert_eq!(bench.error_after(&format!("JOG W {deg_s}")), "0");
        bench.run(8_000);
        assert_eq!(bench.fault(), None);
        bench
    }

    /// Sets parameters of the supervision.
    ///
    /// # Panics
    /// When one is refused.
    pub fn set(&mut self, parameters: &[(u32, f64)]) {
        assert_eq!(self.error_after("CCL 1 ADVANCED"), "0");
        for (id, value) in parameters {
            assert_eq!(self.error_after(&format!("SPA 1 {id} {value}")), "0");
        }
    }

    /// Pushes the ring of a pivot from now on.
    pub fn push(&mut self, torque_n_m: f64) {
        let mut external = External::default();
        external.ring_torque_n_m[PIVOT] = torque_n_m;
        self.rig.front.stage.plant.set_external(external);
    }

    /// Pushes it for so many ticks.
    pub fn push_for(&mut self, torque_n_m: f64, ticks: u32) {
        self.push(torque_n_m);
        self.run(ticks);
        self.push(0.0);
    }

    /// Jams it where it is from now on, until it is pushed.
    pub fn jam(&mut self) {
        let mut external = External::default();
        external.jammed_at_rad[PIVOT] = Some(self.rig.front.stage.plant.pivots_rad()[PIVOT]);
        self.rig.front.stage.plant.set_external(external);
    }

    /// Jams it for so many ticks.
    pub fn jam_for(&mut self, ticks: u32) {
        self.jam();
        self.run(ticks);
        self.push(0.0);
    }
}

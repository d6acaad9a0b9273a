//! Other parameters, for the plans to come and for the tick.

use super::coordinates::travel;
use super::{Flight, Stage};
use crate::control::config::Config;
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{Constraints, Limits};
use crate::parameters::Parameters;
use crate::queues::{Command, CommandQueues};

impl Stage {
    /// Goes over from the parameters `now` to those `wanted`; the tick is told when what it computes with changes. To be
    /// called only at rest, and only when [`Stage::present`] is known.
    ///
    /// # Errors
    /// [`ErrorCode::SoftLimit`] when the travel leaves nothing of the soft limits, [`ErrorCode::Busy`] when the tick can not
    /// be told, [`ErrorCode::NotForStage`] for another radius of the track while a point beside the platform centre is moved.
    /// Nothing has changed then.
    pub fn configure(
        &mut self,
        now: &Parameters,
        wanted: &Parameters,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let moved = self.view.tool.origin() != [0.0; 2];
        if moved && now.geometry.radius_mm != wanted.geometry.radius_mm {
            // The tick knows that point in track radii.
            return Err(ErrorCode::NotForStage);
        }
        let soft = self.soft.fitted(&travel(&self.view, &wanted.geometry));
        let soft = soft.ok_or(ErrorCode::SoftLimit)?;
        let config = Config::new(wanted);
        if config != Config::new(now) {
            self.send(Command::Configure(config), Flight::Configure, queues)?;
        }
        self.soft = soft;
        self.use_parameters(wanted);
        Ok(())
    }

    /// Plans with these from now on.
    pub fn use_parameters(&mut self, parameters: &Parameters) {
        self.base = Constraints::new(self.base.limits, parameters.geometry);
        self.targets = parameters.targets;
        self.set_limits(parameters.limits);
    }

    /// Whether the tick has refused the parameters that were set last; asked once.
    pub fn has_refused_settings(&mut self) -> bool {
        core::mem::take(&mut self.settings_refused)
    }

    /// Whether the servo is on.
    pub fn is_held(&self) -> bool {
        matches!(self.mode(), Mode::Holding | Mode::Moving)
    }

    /// Other limits of motion. `VLS` stays, as far as they allow it.
    fn set_limits(&mut self, limits: Limits) {
        let mm_s = self.base.limits.speed_mm_s.min(limits.speed_mm_s);
        self.full = limits;
        self.base.limits = limits;
        // Not refused: it is inside the new limits, which are far over the slowest.
        let _ = self.set_velocity(mm_s);
    }
}

//! Other parameters, for the plans to come and for the tick.

use super::coordinates::travel;
use super::error::CommandError;
use super::in_flight::InFlight;
use super::reach::ReachMargins;
use super::state::Commander;
use crate::control::SubdivisionTable;
use crate::control::config::Config;
use crate::control::servo::{BorneLimits, ask_the_same};
use crate::mode::Mode;
use crate::motion::{Constraints, Limits};
use crate::parameters::Parameters;
use crate::queues::{Command, CommandQueues};

impl Commander {
    /// Goes over from the parameters `now` to those `wanted`; the tick is told when what it computes with changes. To
    /// be called only at rest, and only when [`Commander::current_snapshot`] is known.
    ///
    /// # Errors
    /// [`CommandError::SoftLimitsInvalid`] when the travel leaves nothing of the soft limits, [`CommandError::Busy`]
    /// when the tick can not be told, [`CommandError::LimitsNotBorne`], [`CommandError::RadiusWithToolFrame`] for another radius of the track while a
    /// point beside the platform centre is moved. Nothing has changed then.
    pub fn configure(
        &mut self,
        now: &Parameters,
        wanted: &Parameters,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let moved = self.active_frames.tool.origin() != [0.0; 2];
        if moved && now.geometry.radius_mm != wanted.geometry.radius_mm {
            // The tick knows that point in track radii.
            return Err(CommandError::RadiusWithToolFrame);
        }
        check_borne(now, wanted)?;
        let soft = self
            .soft_limits
            .narrowed_to(&travel(&self.active_frames, &wanted.geometry));
        let soft = soft.ok_or(CommandError::SoftLimitsInvalid)?;
        let config = Config::new(wanted);
        if config != Config::new(now) {
            // The encoders' tables follow when it is counted, before the next line.
            self.send(Command::Configure(config), InFlight::Configure, queues)?;
        } else {
            self.send_due_subdivision(wanted, queues)?;
        }
        self.soft_limits = soft;
        self.use_parameters(wanted);
        Ok(())
    }

    /// Tells the tick what to take from the encoders' readings, where it does not know that yet and the servo is off.
    ///
    /// # Errors
    /// [`CommandError::Busy`] when the tick can not be told.
    // In a frame of its own: a command has the length of a plan.
    #[inline(never)]
    pub(crate) fn send_due_subdivision(
        &mut self,
        parameters: &Parameters,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let mode = self.current_snapshot().map(|snapshot| snapshot.mode);
        if self.subdivision == parameters.subdivision
            || !matches!(mode, Some(Mode::Off | Mode::Fault))
        {
            return Ok(());
        }
        let tables = (parameters.subdivision.each_ref()).map(SubdivisionTable::new);
        self.send(Command::Subdivide(tables), InFlight::Other, queues)?;
        self.subdivision = parameters.subdivision;
        Ok(())
    }

    /// Whether the tick has not counted the parameters yet that were sent last.
    pub const fn is_configuring(&self) -> bool {
        matches!(self.in_flight, Some(InFlight::Configure))
    }

    /// Plans with these from now on.
    pub fn use_parameters(&mut self, parameters: &Parameters) {
        self.base_constraints = Constraints::new(self.base_constraints.limits, parameters.geometry);
        self.drawn_radius_mm = parameters.geometry.radius_mm;
        self.grow_track();
        self.targets = parameters.targets;
        self.commissioned = parameters.commissioned;
        self.stop_test_needed = parameters.supervision.stop_test_needed;
        self.reach_margins = ReachMargins::new(parameters);
        self.set_limits(parameters.limits);
    }

    /// Whether the tick has refused the parameters that were set last; asked once.
    pub fn take_configuration_refused(&mut self) -> bool {
        core::mem::take(&mut self.configuration_refused)
    }

    /// A debugger is attached, or is no more: nothing that is held lets go of that.
    pub const fn set_debugged(&mut self, is_debugged: bool) {
        self.is_debugged = is_debugged;
    }

    /// # Errors
    /// [`CommandError::NotCommissioned`], and those of [`Commander::check_may_excite`]: no servo may drive.
    pub(super) const fn check_may_drive(&self) -> Result<(), CommandError> {
        if self.commissioned {
            self.check_may_excite()
        } else {
            Err(CommandError::NotCommissioned)
        }
    }

    /// # Errors
    /// [`CommandError::Debugged`], [`CommandError::StopUntested`]: nothing at all may drive.
    pub(super) const fn check_may_excite(&self) -> Result<(), CommandError> {
        if self.is_debugged {
            Err(CommandError::Debugged)
        } else if self.stop_test_needed && !self.stop_seen {
            Err(CommandError::StopUntested)
        } else {
            Ok(())
        }
    }

    /// Whether the servo is on.
    pub fn is_held(&self) -> bool {
        matches!(self.mode(), Mode::Holding | Mode::Moving)
    }

    /// Other limits of motion. The velocity stays, as far as they allow it.
    fn set_limits(&mut self, limits: Limits) {
        let mm_s = self
            .base_constraints
            .limits
            .speed_mm_s
            .min(limits.speed_mm_s);
        self.full_limits = limits;
        self.base_constraints.limits = limits;
        // Not refused: it is inside the new limits, which are far over the slowest.
        let _ = self.limit_velocity(mm_s);
    }
}

/// What a machine is commissioned with, its drives bear. Of one that was not so before, what is not made worse may be set: it is
/// put right line by line. Until a machine is commissioned it is not known, and does not move.
///
/// # Errors
/// [`CommandError::LimitsNotBorne`].
fn check_borne(now: &Parameters, wanted: &Parameters) -> Result<(), CommandError> {
    if !wanted.commissioned || now.commissioned && ask_the_same(now, wanted) {
        return Ok(());
    }
    let borne = BorneLimits::new(wanted);
    let excess = borne.excess(wanted);
    if excess <= 1.0 || now.commissioned && excess <= BorneLimits::new(now).excess(now) {
        return Ok(());
    }
    Err(CommandError::LimitsNotBorne(borne))
}

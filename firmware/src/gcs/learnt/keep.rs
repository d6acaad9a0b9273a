//! Told by `LST?`, taken over and stored.

use crate::control::ServoReport;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::WriteFailed;
use crate::gcs::reply_writer::ReplyWriter;
use crate::parameters::{Learnt, Parameters};
use crate::queues::CommandQueues;

/// Time between what is stored by itself.
const KEEP_S: f64 = 600.0;
/// Changes that are worth a write to flash: a tenth of a volt at 10 rad/s, at 5 N m, and against friction.
const WORTH: Learnt = Learnt {
    rate_v_s_rad: 0.01,
    torque_v_n_m: 0.02,
    friction_v: 0.1,
    motor_constant_v_s_rad: 0.05,
};

impl Interpreter {
    /// What the servos have learnt becomes what they start with. To be called only at rest.
    pub(in crate::gcs) fn take_over_learnt(
        &mut self,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let learnt = self.servo_reports.learnt(&self.parameters);
        if learnt == self.parameters.learnt {
            return Ok(());
        }
        let wanted = Parameters {
            learnt,
            ..self.parameters.clone()
        };
        self.apply_parameters(wanted, queues)
    }

    /// Keeps it without being asked, when the time has come.
    pub(in crate::gcs) fn keep_learnt(&mut self, queues: &mut CommandQueues<'_>) {
        let held = self.commander.is_held();
        let went_off = core::mem::replace(&mut self.servo_reports.was_held, held) && !held;
        if !self.parameters.servo.keeps_learnt {
            return;
        }
        let tick = self.commander.tick();
        let period = KEEP_S * self.parameters.limits.rate_hz;
        let waited = tick.saturating_sub(self.servo_reports.kept_tick) as f64 > period;
        if !(went_off || held && waited)
            || self.commander.current_snapshot().is_none()
            || !self.may_store_by_itself()
        {
            return;
        }
        self.servo_reports.kept_tick = tick;
        let learnt = self.servo_reports.learnt(&self.parameters);
        let kept = &self.parameters_to_store().learnt;
        let changed = (learnt.iter().zip(kept)).any(|(learnt, kept)| differ(learnt, kept));
        // Where the tick can not be told there is a next time.
        if changed && self.take_over_learnt(queues).is_ok() {
            self.store_learnt();
        }
    }

    /// The lines of `LST?`.
    pub(in crate::gcs) fn reply_learnt(
        &self,
        reply: &mut ReplyWriter<'_>,
    ) -> Result<(), WriteFailed> {
        let drives = self.parameters.drives.iter();
        for ((number, servo), drive) in (1..).zip(self.servo_reports.servos).zip(drives) {
            let ServoReport {
                learnt,
                integral_v,
                current_knees,
                ..
            } = servo.unwrap_or_default();
            let [rate, torque, friction] = learnt.weights;
            let motor = learnt.motor_constant_excess;
            let current_a = f64::from(current_knees) * drive.dead_time_knee_a;
            reply.line(format_args!(
                "LEARNT{number}={rate:.5} {torque:.5} {friction:.5} {motor:.5}"
            ))?;
            reply.line(format_args!("INTEGRAL{number}={integral_v:.4}"))?;
            reply.line(format_args!("CURRENT{number}={current_a:.4}"))?;
        }
        Ok(())
    }
}

fn differ(learnt: &Learnt, kept: &Learnt) -> bool {
    let beyond = |value: fn(&Learnt) -> f64| (value(learnt) - value(kept)).abs() > value(&WORTH);
    beyond(|l| l.rate_v_s_rad)
        || beyond(|l| l.torque_v_n_m)
        || beyond(|l| l.friction_v)
        || beyond(|l| l.motor_constant_v_s_rad)
}

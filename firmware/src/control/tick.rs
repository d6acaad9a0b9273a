//! The control loop: one function of state and inputs.

use super::state::{Inputs, Outputs, State};
use super::supervisor::{INSPECTION_PERIOD_TICKS, Inspection};
use crate::control::config::Config;
use crate::control::encoder::Encoder;
use crate::control::loop_counters::LoopCounters;
use crate::control::servo::{PivotSetpoint, platform_torques};
use crate::drivers::biss::RawFrame;
use crate::drivers::bridge::Duty;
use crate::fault::FaultKind;
use crate::mode::Mode;
use crate::motion::{Position, Setpoint};
use crate::number::Fixed;
use crate::queues::{Snapshot, TickQueues};
use crate::recorder::{Sample, TickObserver};
use kinematics::{
    Angle, Guide, Inverse, PivotMotion, Pose, in_platform_axes, inverse,
    pivot_motion_in_platform_axes,
};

/// One period of the control loop, at 20 kHz by default.
///
/// Encoder frames go in, duties come out; in between the data path reads top to bottom. Called by the timer's update interrupt
/// with the highest priority. The frames were latched 15 us before; the duties act from the next PWM period, 25 us after the
/// update, which is the deadline. A miss is a late duty: the old one acts one PWM period longer. No allocation, no blocking,
/// no unbounded loop; no panic and no f64, which `cargo image-check` proves of the image. Its cost on the chip stands in the
/// README and is printed by `cargo chip`.
#[inline]
pub fn tick(
    config: &mut Config,
    state: &mut State,
    inputs: &Inputs,
    queues: &mut TickQueues<'_>,
    recorder: &mut impl TickObserver,
) -> Outputs {
    state.tick = state.tick.wrapping_add(1);
    state
        .loop_counters
        .count_tick(inputs.tick_cycles, inputs.late);
    let mut pivots = decode(config, &mut state.encoders, inputs.frames);
    // A slow average: the supply feeds every duty, and one count of the ADC is 0.03 % of it.
    let supply = f32::from(inputs.supply_counts);
    if state.supply == 0.0 {
        state.supply = supply;
    }
    state.supply += (supply - state.supply) * SUPPLY_SMOOTHING;

    // Obeyed where it lies: a plan is too long to be moved twice.
    let command = queues.commands.peek();
    let commanded = command.is_some();
    // The tick that switches the servo on has measured the pose, which costs what driving does: it drives from the next one on.
    let drives = state.servo_on();
    if let Some(command) = command {
        state.commands = state.commands.wrapping_add(1);
        state.handle_command(config, command, &pivots);
        let _ = queues.commands.dequeue();
        // Once more: referencing gives the pivots their turns.
        pivots = state.encoders.each_ref().map(Encoder::angle);
    }
    state.check_inputs(config, inputs);
    state.check_motor_heat(config, inputs);

    let point = advance(config, state);
    let setpoint = state.motion.centre().platform_setpoint(&point);
    let driven = if drives && state.servo_on() {
        state.drive(config, &setpoint, &mut pivots)
    } else {
        None
    };
    // A fault that came of it takes the drive away in the same tick, unless it stops the motion first.
    let (target, rates, duty) =
        (driven.filter(|_| state.servo_on())).unwrap_or((pivots, [0.0; 3], [Duty(0); 3]));
    let turn = state.inspection_slot;
    state.inspection_slot = (turn + 1) % INSPECTION_PERIOD_TICKS as usize;
    let outputs = Outputs {
        duty,
        awake: state.bridges_awake(),
    };
    let sample = || Sample {
        tick: state.tick,
        mode: state.mode,
        fault: state.fault.map(|fault| fault.kind),
        setpoint,
        reference_point: point,
        pivot_setpoints: target,
        pivot_rates: rates,
        pivots,
        duty,
        current_counts: inputs.current_counts,
        supply_counts: inputs.supply_counts,
        tick_cycles: inputs.tick_cycles,
        commands: state.commands,
    };
    recorder.observe(&sample());
    if let Some(history) = &mut queues.fault_record {
        history.observe(&sample());
    }
    // Made anew, so that a tick that records nothing has it in registers only.
    if queues.recorder.is_active() {
        queues.recorder.observe(&sample());
    }
    // In its turn, and when there is news; not in a tick that has taken a command, which is the longest as it is. Where there is
    // no room then, the next turn serves: so the ticks that can leave one do not depend on when the command side looks.
    let now = (state.mode, state.commands);
    state.report_due |= now != state.last_reported;
    state.last_reported = now;
    if (turn == SNAPSHOT_SLOT || state.report_due) && !commanded {
        state.report_due = false;
        state.send_snapshot(queues, &point.position, &pivots, &target, duty);
    }
    outputs
}

/// In turn, a tick each: a look at every pivot, and a snapshot.
const SNAPSHOT_SLOT: usize = 3;
const _: () = assert!(INSPECTION_PERIOD_TICKS as usize == SNAPSHOT_SLOT + 1);

// The stages of a tick are functions of their own on the chip too: each has its registers to itself, and a bench can count
// each between its symbols.

/// Encoder frames to pivot angles.
#[inline(never)]
fn decode(config: &Config, encoders: &mut [Encoder; 3], frames: [RawFrame; 3]) -> [Angle; 3] {
    for i in 0..3 {
        encoders[i].update(&config.encoders[i], &frames[i]);
    }
    encoders.each_ref().map(Encoder::angle)
}

/// The motion generator's next setpoint, of the point that is moved.
#[inline(never)]
fn advance(config: &Config, state: &mut State) -> Setpoint {
    let motion = &mut state.motion;
    if state.mode == Mode::Stopping {
        motion.advance_fault_stop(&config.fault_stop);
        return motion.fault_stop_setpoint(&config.scale);
    }
    // With the servo off there is nothing under way.
    if matches!(state.mode, Mode::Holding | Mode::Moving) {
        motion.advance();
    }
    motion.setpoint(&config.scale)
}

/// Setpoints of the three pivots.
struct PivotSetpoints {
    angles: [Angle; 3],
    motion: PivotMotion<f32>,
    torques: [f32; 3],
    /// Distances along the guides, track radii: all that is looked at of these later.
    lengths: [f32; 3],
}

/// Setpoint of the pose to setpoints of the pivots, if it is a pose of the mechanism.
#[inline(never)]
fn pivot_setpoints(config: &Config, setpoint: &Setpoint) -> Option<PivotSetpoints> {
    let Inverse { pivots, guides } = inverse(&pose(&setpoint.position)?).ok()?;
    let guides = guides.map(|guide: Guide<Fixed>| guide.map(Fixed::to_f32));
    let (twist, acceleration) = in_platform_axes(&guides, &setpoint.twist, &setpoint.acceleration);
    Some(PivotSetpoints {
        angles: pivots,
        motion: pivot_motion_in_platform_axes(&guides, &twist, &acceleration),
        torques: platform_torques(&config.servo.body, &guides, &twist, &acceleration),
        lengths: [guides[0].rho(), guides[1].rho(), guides[2].rho()],
    })
}

const SUPPLY_SMOOTHING: f32 = 1.0 / 256.0;

type DriveOutputs = ([Angle; 3], [f32; 3], [Duty; 3]);

impl State {
    /// Setpoint to duties; `None` when a fault came of it.
    fn drive(
        &mut self,
        config: &Config,
        setpoint: &Setpoint,
        pivots: &mut [Angle; 3],
    ) -> Option<DriveOutputs> {
        if !self.is_in_disk(config, &setpoint.position) {
            return None;
        }
        // Looked at where it lies.
        let Some(wanted) = &pivot_setpoints(config, setpoint) else {
            self.raise_fault(FaultKind::ImpossibleSetpoint, None, 0.0, 0.0);
            return None;
        };
        let target = &wanted.angles;
        if let Some(lost) = self.lost_pivot
            && let (Some(pivot), Some(target)) = (pivots.get_mut(lost), target.get(lost))
        {
            // All that is known of it.
            *pivot = *target;
        }
        let (errors, worst) = self.following_errors(config, pivots, wanted)?;
        (self.settling).update(&config.limits, worst, self.motion.is_moving());
        self.loop_counters.observe_error(worst);
        if self.mode != Mode::Holding && !self.motion.is_moving() {
            self.finish_motion();
        }
        let (duty, sum) = self.step_servos(config, &errors, wanted);
        // Infinities add up to one, or to no number.
        if !(sum.abs() <= f32::MAX) {
            self.raise_fault(FaultKind::NotFinite, None, 0.0, 0.0);
            return None;
        }
        let i = self.inspection_slot;
        let after = if i < 2 { i + 1 } else { 0 };
        // All are there, but in the snapshot's turn none.
        if let (Some(&length), Some(&setpoint), Some(&angle), Some(&next), Some(&duty)) = (
            wanted.lengths.get(i),
            target.get(i),
            pivots.get(i),
            pivots.get(after),
            duty.get(i),
        ) {
            let turn = Inspection {
                pivot: i,
                setpoint,
                angle,
                next,
                duty,
            };
            if !(self.is_in_guide_range(config, i, length) && self.inspect_pivot(config, &turn)) {
                return None;
            }
        }
        Some((wanted.angles, wanted.motion.rates, duty))
    }

    /// Duties of the three servos, and the sum of what they asked for. The one whose turn it is learns.
    #[inline(never)]
    fn step_servos(
        &mut self,
        config: &Config,
        errors: &[i32; 3],
        wanted: &PivotSetpoints,
    ) -> ([Duty; 3], f32) {
        let counts_per_volt = config.servo.counts_per_volt(self.supply);
        let mut duty = [Duty(0); 3];
        let mut sum = 0.0;
        for i in 0..3 {
            let setpoint = PivotSetpoint {
                error: errors[i],
                rate: wanted.motion.rates[i],
                acceleration: wanted.motion.accelerations[i],
                platform_torque: wanted.torques[i],
            };
            let servo = &mut self.servo[i];
            duty[i] = servo.step(&config.servo, &setpoint, counts_per_volt);
            if i == self.inspection_slot {
                servo.learn(&config.servo);
            }
            sum += servo.requested_counts();
        }
        (duty, sum)
    }

    /// Measured minus setpoint, 2^-32 turns, and the largest of the three by its size, if that is allowed.
    #[inline]
    fn following_errors(
        &mut self,
        config: &Config,
        pivots: &[Angle; 3],
        wanted: &PivotSetpoints,
    ) -> Option<([i32; 3], u32)> {
        let errors = [0, 1, 2].map(|i| (pivots[i] - wanted.angles[i]).units());
        let small = errors.map(|error| error as i32);
        let (mut worst, mut beyond) = (0, 0);
        for i in 0..3 {
            worst = small[i].unsigned_abs().max(worst);
            // Nothing but copies of the sign above 32 bits.
            beyond |= (errors[i] >> 32) as i32 ^ small[i] >> 31;
        }
        // What any rate allows, as a rule; else each is looked at for itself.
        let least = config.limits.following_error.unsigned_abs();
        if (beyond != 0 || worst > least) && !self.is_following_allowed(config, pivots, wanted) {
            return None;
        }
        Some((small, worst))
    }

    /// Whether errors are allowed at these rates.
    #[cold]
    fn is_following_allowed(
        &mut self,
        config: &Config,
        pivots: &[Angle; 3],
        wanted: &PivotSetpoints,
    ) -> bool {
        let pivots = pivots.iter().zip(&wanted.angles);
        for (i, ((&pivot, &target), rate)) in pivots.zip(&wanted.motion.rates).enumerate() {
            let error = (pivot - target).units();
            let more = (rate.abs() * config.limits.following_error_per_rate) as i32;
            let most = config.limits.following_error.saturating_add(more);
            if error.unsigned_abs() > u64::from(most.unsigned_abs()) {
                const RAD: f32 = (1.0 / crate::control::config::UNITS_PER_RAD) as f32;
                let (value, limit) = (error as f32 * RAD, most as f32 * RAD);
                self.raise_fault(FaultKind::FollowingError, Some(i), value, limit);
                return false;
            }
        }
        true
    }

    /// Tells the command side, if there is room.
    #[inline(never)]
    fn send_snapshot(
        &mut self,
        queues: &mut TickQueues<'_>,
        setpoint: &Position,
        pivots: &[Angle; 3],
        target: &[Angle; 3],
        duty: [Duty; 3],
    ) {
        if queues.has_snapshot_room() {
            // There is room: only this side fills the queue.
            let snapshot = self.snapshot(setpoint, pivots, target, duty);
            let _ = queues.snapshots.enqueue(snapshot);
            self.loop_counters = LoopCounters::default();
        }
    }

    #[inline]
    fn snapshot(
        &self,
        setpoint: &Position,
        pivots: &[Angle; 3],
        target: &[Angle; 3],
        duty: [Duty; 3],
    ) -> Snapshot {
        let (plan, plan_tick) = self.motion.progress();
        Snapshot {
            tick: self.tick,
            mode: self.mode,
            fault: self.fault,
            stop_ended_by: self.stop_ended_by,
            referenced: self.referenced,
            encoder_faults: self.encoders.each_ref().map(Encoder::unusable),
            encoder_warnings: self.encoders.each_ref().map(Encoder::warning),
            pivots: *pivots,
            // A difference that does not fit is a fault, and then the target is what is measured.
            pivot_errors: [0, 1, 2].map(|i| (pivots[i] - target[i]).units() as i32),
            duty,
            setpoint: *setpoint,
            centre: self.motion.centre(),
            plan,
            plan_tick,
            settled: self.settling.settled() && self.servo_on(),
            commands: self.commands,
            refused: self.refused,
            peak_following_error_rad: self.settling.peak_error_rad(),
            loop_counters: self.loop_counters,
        }
    }
}

/// The pose of a position, as far as it is one of the mechanism.
#[inline]
fn pose(position: &Position) -> Option<Pose<Fixed>> {
    Some(Pose {
        x: Fixed::from_position(position[0])?,
        y: Fixed::from_position(position[1])?,
        theta: Angle::from_units(position[2]),
    })
}

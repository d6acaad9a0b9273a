//! The control loop: one function of state and inputs.

use super::command::Command;
use super::config::Config;
use super::encoder::Encoder;
use super::inspection::{INSPECTION_PERIOD_TICKS, Inspection, SNAPSHOT_SLOT};
use super::pivot_setpoints::{PivotSetpoints, pivot_setpoints, pose};
use super::rest_mode::Stiffness;
use super::servo::{LoopSetpoint, PivotSetpoint};
use super::state::{Inputs, Outputs, State};
use super::tick_queues::TickQueues;
use crate::drivers::biss::RawFrame;
use crate::drivers::bridge::Duty;
use crate::fault::FaultKind;
use crate::mode::Mode;
use crate::motion::Setpoint;
use crate::recorder::{Sample, TickObserver};
use kinematics::Angle;

/// One period of the control loop, at 20 kHz by default.
///
/// Encoder frames go in, duties come out; in between the data path reads top to bottom. No allocation, no blocking, no
/// unbounded loop; no panic and no f64, which `cargo image-check` proves of the image.
///
/// - Period: 50 us, by a timer's compare event. The frames were latched 15 us before.
/// - Deadline: 32 us after the event, 5,376 cycles. There the PWM period begins in which the duties act.
/// - Cost until then: in cycles by use, from `cargo chip-cycles`, which CI holds to `firmware/cycle-limits.csv`; in
///   instructions from `cargo chip`. What follows, learning, the rest of a plan that was taken, sample and snapshot, has no deadline.
/// - Miss: the old duties act one PWM period, 25 us, longer. The next tick is told so ([`Inputs::late`]) and counts it; more
///   than parameter 0x5450050B of them, one in 100 ticks forgiven, are a fault.
#[inline]
pub fn tick(
    config: &mut Config,
    state: &mut State,
    inputs: &Inputs,
    queues: &mut TickQueues<'_>,
    recorder: &mut impl TickObserver,
) -> Outputs {
    let mut given = Outputs::default();
    let drive = |outputs| given = outputs;
    tick_and_drive(config, state, inputs, queues, drive, |queues, sample| {
        recorder.observe(sample);
        if let Some(observers) = &mut queues.observers {
            observers.observe(sample);
        }
    });
    given
}

/// The same with the outputs handed to `drive` as soon as they are known, and the sample to `observe`: where the recorders run
/// behind the tick, their code is no part of it.
#[inline]
pub fn tick_and_drive<'a>(
    config: &mut Config,
    state: &mut State,
    inputs: &Inputs,
    queues: &mut TickQueues<'a>,
    drive: impl FnOnce(Outputs),
    observe: impl FnOnce(&mut TickQueues<'a>, &Sample),
) {
    state.tick = state.tick.wrapping_add(1);
    let sorted;
    let (frames, currents) = if config.wiring.is_straight() {
        (&inputs.frames, &inputs.current_counts)
    } else {
        sorted = (config.wiring).of_pivots(&inputs.frames, &inputs.current_counts);
        (&sorted.0, &sorted.1)
    };
    let mut pivots = decode(config, &mut state.encoders, frames);
    // An average: the supply feeds every duty, and one count of the ADC is 0.03 % of it.
    let supply = f32::from(inputs.supply_counts);
    if state.supply == 0.0 {
        state.supply = supply;
    }
    state.supply += (supply - state.supply) * SUPPLY_SMOOTHING;

    // Handled where it lies: a plan is too long to be moved twice.
    let command = queues.commands.peek();
    let commanded = command.is_some();
    // The tick that switches the servo on has measured the pose, which costs what driving does: it drives from the next
    // one on.
    let drives = state.servo_on();
    if let Some(command) = command {
        state.commands = state.commands.wrapping_add(1);
        state.handle_command(config, command, &pivots);
        // Once more: referencing gives the pivots their turns.
        pivots = state.encoders.each_ref().map(Encoder::angle);
    }
    state.check_inputs(config, inputs);
    let overload = (state.brake_resistor).update(inputs.supply_counts, config.limits.rate_hz);
    if let Some([taken_j, most_j]) = overload {
        state.raise_fault(FaultKind::BrakeResistorHot, None, taken_j, most_j);
    }
    // Not in a tick that has taken a command, which is the longest as it is.
    if !commanded {
        state.check_currents(config, currents);
    }

    let point = advance(config, state);
    state.advance_trial(config, queues.trial);
    let setpoint = state.motion.centre().platform_setpoint(&point);
    let mut guides = None;
    let driven = if drives && state.servo_on() {
        state.drive(config, &setpoint, &mut pivots, currents, &mut guides)
    } else {
        None
    };
    let excited = if state.mode == Mode::Exciting {
        state.drive_excited(config, &pivots, currents)
    } else {
        [Duty(0); 3]
    };
    // A fault that came of it takes the drive away in the same tick, unless it stops the motion first.
    if let Some((target, ..)) = &driven {
        state.record_trial(config, queues.trial, &pivots, target);
    }
    let (target, rates, duty) =
        (driven.filter(|_| state.servo_on())).unwrap_or((pivots, [0.0; 3], excited));
    let slot = state.inspection_slot;
    state.inspection_slot = (slot + 1) % INSPECTION_PERIOD_TICKS as usize;
    drive(Outputs {
        duty: config.wiring.duties(duty),
        awake: state.bridges_awake(),
        brake_resistor: state.brake_resistor.is_on(),
    });
    // What has no deadline: from here on it is for ticks to come.
    state
        .loop_counters
        .count_tick(inputs.tick_cycles, inputs.late);
    if let Some(guides) = &guides {
        state.learn(config, guides, slot);
    }
    if state.calibrated.is_on {
        if let Some(guides) = &guides {
            state.calibrated.look_up_at(slot, &target, &guides[0]);
        } else if !drives && !state.servo_on() {
            state.calibrated.follow(config, &pivots, slot);
        }
    }
    if let Some(Command::Move(plan)) = queues.commands.peek() {
        state.motion.accept_rest(plan);
    }
    if commanded {
        let _ = queues.commands.dequeue();
    }
    let sample = Sample {
        tick: state.tick,
        mode: state.mode,
        fault: state.fault.map(|fault| fault.kind),
        setpoint,
        reference_point: point,
        pivot_setpoints: target,
        pivot_rates: rates,
        pivots,
        duty,
        current_counts: *currents,
        supply_counts: inputs.supply_counts,
        tick_cycles: inputs.tick_cycles,
        commands: state.commands,
        servo: state.servo_sample(slot),
    };
    observe(queues, &sample);
    // In its slot, and when mode or commands have changed; not in a tick that has taken a command, which is the longest
    // as it is. Where there is no room then, it is sent in the next slot: so the ticks that can send one do not depend
    // on when the command side reads.
    let now = (state.mode, state.commands);
    state.report_due |= now != state.last_mode_and_commands;
    state.last_mode_and_commands = now;
    if (slot == SNAPSHOT_SLOT || state.report_due) && !commanded {
        state.report_due = false;
        state.send_snapshot(queues, &point.position, &pivots, &target, duty);
    }
}

// The stages of a tick are functions of their own on the chip too: each has its registers to itself, and a bench can
// count each between its symbols.

/// Encoder frames to pivot angles.
#[inline(never)]
fn decode(config: &Config, encoders: &mut [Encoder; 3], frames: &[RawFrame; 3]) -> [Angle; 3] {
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

/// Of the measured supply, from one tick to the next: half a millisecond, in which the bus answers to a load, and over which the noise of
/// a sample is a third of it.
const SUPPLY_SMOOTHING: f32 = 1.0 / 8.0;

/// Lengths of the guides, and cosines of their angles to the track, as in [`PivotSetpoints`].
type Guides = [[f32; 3]; 2];

/// Setpoints of the pivots, their rates (rad/s), and the duties.
type DriveOutputs = ([Angle; 3], [f32; 3], [Duty; 3]);

impl State {
    /// Setpoint to duties; `None` when a fault came of it. `guides` are told where servos have run, which can learn then.
    fn drive(
        &mut self,
        config: &Config,
        setpoint: &Setpoint,
        pivots: &mut [Angle; 3],
        currents: &[i16; 3],
        guides: &mut Option<Guides>,
    ) -> Option<DriveOutputs> {
        if !self.is_in_disk(config, &setpoint.position) {
            return None;
        }
        // Used where it lies.
        let wanted = if self.calibrated.is_on {
            pose(&setpoint.position).and_then(|pose| {
                self.calibrated.pivot_setpoints(
                    config,
                    &pose,
                    &setpoint.twist,
                    &setpoint.acceleration,
                    None,
                )
            })
        } else {
            pivot_setpoints(config, setpoint)
        };
        let Some(wanted) = &wanted else {
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
        let moving = self.motion.is_moving();
        (self.settling).update(&config.limits, &errors, worst, moving);
        let sums = self.settling.error_sums();
        let stiffness = (self.rest_mode).update(&config.rest_mode, moving, sums);
        self.loop_counters.observe_error(worst);
        if self.mode != Mode::Holding && !self.motion.is_moving() {
            self.finish_motion();
        }
        if self.excitation.request().is_some() {
            self.excitation.advance_added_volts();
        }
        *guides = Some([wanted.lengths, wanted.cosines]);
        let (duty, sum) = self.step_servos(config, &errors, wanted, stiffness, currents);
        // Infinities add up to one, or to no number.
        if !(sum.abs() <= f32::MAX) {
            self.raise_fault(FaultKind::NotFinite, None, 0.0, 0.0);
            return None;
        }
        let i = self.inspection_slot;
        let after = if i < 2 { i + 1 } else { 0 };
        // Each pivot in its slot; in the snapshot's slot none.
        if let (Some(&length), Some(&setpoint), Some(&angle), Some(&next), Some(&duty)) = (
            wanted.lengths.get(i),
            target.get(i),
            pivots.get(i),
            pivots.get(after),
            duty.get(i),
        ) {
            let slowly = wanted.motion.rates[i].abs() < config.limits.slow_rate
                && wanted.motion.accelerations[i].abs() < config.limits.slow_acceleration;
            let inspection = Inspection {
                pivot: i,
                slowly,
                setpoint,
                angle,
                next,
                duty,
            };
            if !(self.is_in_guide_range(config, i, length)
                && self.inspect_pivot(config, &inspection))
            {
                return None;
            }
        }
        Some((wanted.angles, wanted.motion.rates, duty))
    }

    /// The servo that is inspected in this tick learns, for those to come.
    fn learn(&mut self, config: &Config, [lengths, cosines]: &Guides, slot: usize) {
        let servos = &config.servo;
        let (Some(servo), Some(config)) = (self.servo.get_mut(slot), servos.pivots.get(slot))
        else {
            return;
        };
        if self.trial.holds_model() {
            servo.skip_learning();
        } else {
            servo.learn(config);
        }
        servo.schedule(servos.scheduled_share(lengths, cosines, slot));
    }

    /// Duties of the three servos, and the sum of what they asked for.
    #[inline(never)]
    pub(super) fn step_servos(
        &mut self,
        config: &Config,
        errors: &[i32; 3],
        wanted: &PivotSetpoints,
        stiffness: Stiffness,
        current_counts: &[i16; 3],
    ) -> ([Duty; 3], f32) {
        let servos = &config.servo;
        let common = LoopSetpoint {
            counts_per_volt: servos.counts_per_volt(self.supply),
            stiffness,
        };
        let mut duty = [Duty(0); 3];
        let mut sum = 0.0;
        for i in 0..3 {
            let setpoint = PivotSetpoint {
                error: errors[i],
                rate: wanted.motion.rates[i],
                acceleration: wanted.motion.accelerations[i],
                platform_torque: wanted.torques[i],
                angle: wanted.angles[i],
                current_counts: current_counts[i],
                added_volts: self.trial.volts(i) + self.excitation.added_volts[i],
            };
            let (servo, config) = (&mut self.servo[i], &servos.pivots[i]);
            duty[i] = servo.step(config, &setpoint, &common);
            sum += servo.requested_counts();
        }
        (duty, sum)
    }
}

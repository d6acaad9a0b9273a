//! The control loop: one function of state and inputs.

use super::command::Command;
use super::config::Config;
use super::encoder::Encoder;
use super::inspection::{INSPECTION_PERIOD_TICKS, Inspection, SNAPSHOT_SLOT};
use super::rest_mode::Stiffness;
use super::servo::{LoopSetpoint, PivotFeedback};
use super::state::{Inputs, Outputs, State};
use super::subdivision::SubdivisionTable;
use super::tick_queues::TickQueues;
use crate::drivers::biss::RawFrame;
use crate::drivers::bridge::Duty;
use crate::fault::FaultKind;
use crate::mode::Mode;
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
///   instructions from `cargo chip`. What follows has no deadline but the next tick: learning, commands, the setpoint of the next
///   tick ([`next_setpoint`](super::next_setpoint)), sample and snapshot.
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
    let mut pivots = decode(config, &state.subdivision, &mut state.encoders, frames);
    // An average: the supply feeds every duty, and one count of the ADC is 0.03 % of it.
    let supply = f32::from(inputs.supply_counts);
    if state.supply == 0.0 {
        state.supply = supply;
    }
    state.supply += (supply - state.supply) * SUPPLY_SMOOTHING;

    state.check_inputs(config, inputs);
    let is_pulsed =
        state.brake_resistor.test.is_under_way() && state.test_brake_resistor(inputs.supply_counts);
    let (supply_counts, rate_hz) = (inputs.supply_counts, config.limits.rate_hz);
    let switched = (state.brake_resistor).update(supply_counts, rate_hz, is_pulsed);
    if let Some((kind, [value, limit])) = switched {
        state.raise_fault(kind, None, value, limit);
    }
    state.check_currents(config, currents);

    let wanted = state.next.pivots.as_ref().map(|wanted| wanted.angles);
    let driven = match &wanted {
        Some(target) if state.servo_on() => state.drive(config, target, &mut pivots, currents),
        _ => None,
    };
    let excited = if state.mode == Mode::Exciting {
        state.drive_excited(config, &pivots, currents)
    } else {
        [Duty(0); 3]
    };
    // A fault that came of it takes the drive away in the same tick, unless it stops the motion first.
    let in_force = driven.filter(|_| state.servo_on());
    let duty = in_force.unwrap_or(excited);
    drive(Outputs {
        duty: config.wiring.duties(duty),
        awake: state.bridges_awake(),
        brake_resistor: state.brake_resistor.is_on(),
    });

    // What has no deadline: from here on it is for ticks to come.
    state
        .loop_counters
        .count_tick(inputs.tick_cycles, inputs.late);
    let slot = state.inspection_slot;
    state.inspection_slot = (slot + 1) % INSPECTION_PERIOD_TICKS as usize;
    if driven.is_some() {
        state.record_trial(config, queues.trial, &pivots);
        state.learn(config, slot);
    }
    // With a calibration there is time for a command or a snapshot only in the tick that looks nothing up, and for one of them:
    // what the last command did is told before the next one is taken.
    let calibrated = state.calibrated.is_on;
    let has_time = slot == SNAPSHOT_SLOT || !calibrated;
    let now = (state.mode, state.commands);
    let is_told = now == state.told_mode_and_commands;
    // Taken below, by this tick. While the bridges wake up it waits: whatever it asks for, nothing could drive yet.
    let takes = has_time && (is_told || !calibrated) && !state.is_waking();
    let commanded = takes && queues.commands.ready();
    if calibrated {
        if let Some(wanted) = &state.next.pivots {
            (state.calibrated).look_up_at(slot, &wanted.angles, &wanted.lengths);
        } else if !state.servo_on() && !commanded {
            // A command that needs the pose finds it itself: both would be longer than a period.
            state.calibrated.follow(config, &pivots, slot);
        }
    }
    let (target, rates) = match &state.next.pivots {
        Some(wanted) if in_force.is_some() => (wanted.angles, wanted.motion.rates),
        _ => (pivots, [0.0; 3]),
    };
    let sample = Sample {
        tick: state.tick,
        mode: state.mode,
        fault: state.fault.map(|fault| fault.kind),
        setpoint: state.next.platform,
        reference_point: state.next.point,
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
    // In its slot, and when mode or commands have changed. Where there is no room then, it is sent in the next slot: so the
    // ticks that can send one do not depend on when the command side reads.
    if has_time && (!is_told || slot == SNAPSHOT_SLOT && !commanded) {
        let setpoint = state.next.point.position;
        state.send_snapshot(queues, &setpoint, &pivots, &target, duty);
        state.told_mode_and_commands = now;
    }
    // Handled where it lies: constants are too long to be moved twice.
    let mut rests = false;
    if commanded && let Some(command) = queues.commands.peek() {
        let is_long = matches!(command, Command::Configure(_));
        state.commands = state.commands.wrapping_add(1);
        state.handle_command(config, command, queues.plans, &pivots);
        // Constants are long to copy, and a setpoint that rests is what it was.
        rests = is_long && state.setpoint_rests();
        let _ = queues.commands.dequeue();
    }
    if !rests {
        state.prepare_next(config, queues.plans, queues.trial);
    }
}

// The stages of a tick are functions of their own on the chip too: each has its registers to itself, and a bench can
// count each between its symbols.

/// Encoder frames to pivot angles.
#[inline(never)]
fn decode(
    config: &Config,
    subdivision: &Option<[SubdivisionTable; 3]>,
    encoders: &mut [Encoder; 3],
    frames: &[RawFrame; 3],
) -> [Angle; 3] {
    // Written out for both: with tables decoding takes a half more, and most machines have none.
    match subdivision {
        None => {
            for i in 0..3 {
                encoders[i].update(&config.encoders[i], None, &frames[i]);
            }
        }
        Some(tables) => {
            for i in 0..3 {
                encoders[i].update(&config.encoders[i], Some(&tables[i]), &frames[i]);
            }
        }
    }
    [0, 1, 2].map(|i| encoders[i].angle_at_first_latch(&config.encoders[i]))
}

/// Of the measured supply, from one tick to the next: half a millisecond, in which the bus answers to a load, and over which the noise of
/// a sample is a third of it.
const SUPPLY_SMOOTHING: f32 = 1.0 / 8.0;

impl State {
    /// Following errors to duties; `None` when a fault came of it.
    fn drive(
        &mut self,
        config: &Config,
        target: &[Angle; 3],
        pivots: &mut [Angle; 3],
        currents: &[i16; 3],
    ) -> Option<[Duty; 3]> {
        if let Some(lost) = self.lost_pivot
            && let (Some(pivot), Some(target)) = (pivots.get_mut(lost), target.get(lost))
        {
            // All that is known of it.
            *pivot = *target;
        }
        let (errors, worst) = self.following_errors(config, pivots, target)?;
        if self.is_waking() {
            return Some(self.wait_for_bridges(config, &errors, currents));
        }
        let moving = self.next.moving;
        (self.settling).update(&config.limits, &errors, worst, moving);
        let sums = self.settling.error_sums();
        let stiffness = (self.rest_mode).update(&config.rest_mode, moving, sums);
        self.loop_counters.observe_error(worst);
        if self.mode != Mode::Holding && !moving {
            self.finish_motion();
        }
        if self.excitation.request().is_some() {
            self.excitation.advance_added_volts();
        }
        let (duty, sum) = self.step_servos(config, &errors, stiffness, currents);
        // Infinities add up to one, or to no number.
        if !(sum.abs() <= f32::MAX) {
            self.raise_fault(FaultKind::NotFinite, None, 0.0, 0.0);
            return None;
        }
        let i = self.inspection_slot;
        let after = if i < 2 { i + 1 } else { 0 };
        // Each pivot in its slot; in the snapshot's slot none.
        if let (Some(&setpoint), Some(&angle), Some(&next), Some(&duty)) =
            (target.get(i), pivots.get(i), pivots.get(after), duty.get(i))
        {
            let inspection = Inspection {
                pivot: i,
                slowly: self.next.slowly,
                setpoint,
                angle,
                next,
                duty,
            };
            if !self.inspect_pivot(config, &inspection) {
                return None;
            }
        }
        Some(duty)
    }

    /// Whether the next setpoint is the one that is followed now, and known.
    pub(super) fn setpoint_rests(&self) -> bool {
        self.mode == Mode::Holding && !self.motion.is_moving() && self.next.pivots.is_some()
    }

    /// A tick in which the bridges wake up, or the leads are tested: nothing is collected, settled or learnt from what no motor could
    /// follow.
    #[cold]
    fn wait_for_bridges(
        &mut self,
        config: &Config,
        errors: &[i32; 3],
        currents: &[i16; 3],
    ) -> [Duty; 3] {
        for (servo, error) in self.servo.iter_mut().zip(errors) {
            servo.stand_by(*error);
        }
        if self.waking_ticks == 0 {
            return self.test_leads(config, errors, currents);
        }
        self.waking_ticks -= 1;
        [Duty(0); 3]
    }

    /// The servo that is inspected in this tick learns, for those to come.
    fn learn(&mut self, config: &Config, slot: usize) {
        let servos = &config.servo;
        let (Some(servo), Some(config), Some(wanted)) = (
            self.servo.get_mut(slot),
            servos.pivots.get(slot),
            &self.next.pivots,
        ) else {
            return;
        };
        if self.trial.holds_model() {
            servo.skip_learning();
        } else {
            servo.learn(config);
        }
        servo.schedule(servos.scheduled_share(&wanted.lengths, &wanted.cosines, slot));
    }

    /// Duties of the three servos, and the sum of what they asked for.
    #[inline(never)]
    pub(super) fn step_servos(
        &mut self,
        config: &Config,
        errors: &[i32; 3],
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
            let measured = PivotFeedback {
                error: errors[i],
                current_counts: current_counts[i],
                added_volts: self.trial.volts(i) + self.excitation.added_volts[i],
            };
            let (servo, config) = (&mut self.servo[i], &servos.pivots[i]);
            duty[i] = servo.step(config, &measured, &common);
            sum += servo.requested_counts();
        }
        (duty, sum)
    }
}

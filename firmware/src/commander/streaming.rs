//! Targets that follow one another in time: streamed by moves (as the parameters ask for), or made by wave
//! generators.

use super::axis::Coordinates;
use super::error::CommandError;
use super::pending::Pending;
use super::sent_plan::{Goal, SentPlan};
use super::state::Commander;
use super::stream_source::Streaming;
use super::wave::GeneratorRun;
use crate::mode::Mode;
use crate::motion::{
    Clock, PERIOD_RANGE, PlanProgress, Position, PushError, Stream, StreamEnd, StreamStep,
};
use crate::queues::CommandQueues;

/// How far a stream may end from its last target and have come to rest there, 2^-32 track radii or turns: below what an
/// encoder tells apart.
const REST_TOLERANCE: u64 = 32;

impl Commander {
    /// Sets the ms between streamed targets.
    pub fn set_cycle_time(&mut self, ms: f64) -> Result<(), CommandError> {
        if self.pending.stream().is_some() {
            return Err(CommandError::InMotion);
        }
        if !PERIOD_RANGE.contains(&self.period(ms)) {
            return Err(CommandError::PeriodOutOfRange);
        }
        self.cycle_ms = ms;
        Ok(())
    }

    /// The time between streamed targets, ms.
    pub const fn cycle_time_ms(&self) -> f64 {
        self.cycle_ms
    }

    /// Ticks in so many ms.
    fn period(&self, ms: f64) -> f64 {
        ms * 1e-3 * self.base_constraints.limits.rate_hz
    }

    /// Which generators run, or are about to.
    pub fn running_generators(&self) -> [bool; 6] {
        let run = (self.pending.stream()).and_then(|streaming| streaming.run.as_ref());
        run.map_or([false; 6], GeneratorRun::running)
    }

    /// A streamed target.
    pub(super) fn stream(&mut self, target: Coordinates, to: Position) -> Result<(), CommandError> {
        let constraints = self.constraints();
        if self.pending.stream().is_none() {
            if self.mode() != Mode::Holding || self.is_motion_pending() {
                return Err(CommandError::StreamNotAtRest);
            }
            let period = self.period(self.cycle_ms);
            let stream = Stream::new(self.setpoint(), period, Clock::Sender);
            self.pending = Pending::Stream(Streaming {
                stream: Some(stream.ok_or(CommandError::PeriodOutOfRange)?),
                run: None,
                last: (to, 0),
                started: false,
            });
        }
        let now = self.tick();
        if let Some(streaming) = self.pending.stream_mut()
            && let Some(stream) = &mut streaming.stream
        {
            match stream.push(to, &constraints) {
                Ok(()) => {}
                Err(PushError::Full) => return Err(CommandError::StreamFull),
                Err(PushError::Over) => return Err(CommandError::Busy),
                Err(PushError::Refused(refusal)) => return Err(refusal.into()),
            }
            streaming.last = (to, now);
        }
        self.target = target;
        self.target_is_rest = false;
        Ok(())
    }

    /// Sends the axes of `starting` through their tables, after a move to where these begin.
    pub(super) fn start_generators(
        &mut self,
        starting: &[bool; 6],
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        self.check_ready()?;
        if self.mode() != Mode::Holding || self.is_motion_pending() {
            return Err(CommandError::InMotion);
        }
        let run = GeneratorRun::new(
            &self.waves,
            starting,
            self.target,
            self.base_constraints.limits.rate_hz,
        );
        let start = self.position_of(&run.start(&self.waves))?;
        self.request_goal(Goal::Position(start), queues)?;
        self.target_is_rest = true;
        self.pending = Pending::Stream(Streaming {
            stream: None,
            run: Some(run),
            last: (start, 0),
            started: false,
        });
        Ok(())
    }

    /// Takes the next step of the stream.
    pub(super) fn advance_streaming(&mut self, queues: &mut CommandQueues<'_>) {
        if self.waits_for_tick() {
            return;
        }
        let Some(mut streaming) = self.pending.take_stream() else {
            return;
        };
        match self.next_step(&mut streaming) {
            Ok(StreamStep::Wait) => self.pending = Pending::Stream(streaming),
            Ok(StreamStep::Send(plan, start)) => {
                match (&streaming.run, streaming.started) {
                    (Some(run), false) => self.prepare_waves(run, &plan, queues),
                    (None, false) => self.end_trial(queues),
                    (_, true) => {}
                }
                match self.send_plan(SentPlan::streamed(plan, start), None, queues) {
                    Ok(()) => {
                        streaming.started = true;
                        self.pending = Pending::Stream(streaming);
                    }
                    // The plan is lost.
                    Err(error) => self.report_stream_lost(error),
                }
            }
            Ok(StreamStep::Over(end)) => self.finish_streaming(&streaming, end),
            Err(error) => self.report_stream_lost(error),
        }
    }

    /// Whether a stream of somebody's targets has nothing to do until the tick goes on. Looked at first: it is so nearly
    /// always, and the stream is long to move.
    fn waits_for_tick(&self) -> bool {
        let (Some(streaming), Some(progress)) = (self.pending.stream(), self.plan_progress())
        else {
            return false;
        };
        (streaming.run.is_none() && streaming.started)
            && (streaming.stream.as_ref()).is_some_and(|stream| stream.waits(&progress))
    }

    fn plan_progress(&self) -> Option<PlanProgress> {
        let snapshot = self.snapshot.as_ref()?;
        Some(PlanProgress {
            plan: snapshot.plan,
            tick: snapshot.plan_tick,
            moving: snapshot.mode == Mode::Moving,
        })
    }

    /// Brings targets where generators make them, and asks the stream what is to be done.
    fn next_step(&mut self, streaming: &mut Streaming) -> Result<StreamStep, CommandError> {
        let constraints = self.constraints();
        let (now, period) = (self.tick(), self.period(self.cycle_ms));
        let Some(progress) = self.plan_progress() else {
            return Ok(StreamStep::Wait);
        };
        if streaming.stream.is_none() {
            let there = self.mode() == Mode::Holding;
            if !there {
                return Ok(StreamStep::Wait);
            }
            let period = f64::from(self.waves.ticks);
            streaming.stream = Stream::new(self.setpoint(), period, Clock::Own);
        }
        let id = self.next_plan_id();
        let (Some(stream), run) = (&mut streaming.stream, &mut streaming.run) else {
            return Err(CommandError::PeriodOutOfRange);
        };
        if let Some(run) = run {
            while stream.free_places() > RESERVED_KNOTS {
                let Some(target) = run.next(&self.waves) else {
                    stream.finish();
                    break;
                };
                let place = self.position_of(&target)?;
                if let Err(PushError::Refused(refusal)) = stream.push(place, &constraints) {
                    return Err(refusal.into());
                }
                streaming.last.0 = place;
            }
        } else if !streaming.started && now > streaming.last.1 + start_timeout(stream, period) {
            // Too few for a stream: they are all that come.
            stream.finish();
        }
        Ok(stream.next(id, &progress, &constraints))
    }

    /// A stream is over. What dries up at rest, at its last target, has come to a good end.
    fn finish_streaming(&mut self, streaming: &Streaming, end: StreamEnd) {
        let rest = match self.active_plan() {
            Some((sent_plan, _)) if self.mode() == Mode::Moving => sent_plan.plan.end,
            _ => self.setpoint(),
        };
        let mut pairs = rest.into_iter().zip(streaming.last.0);
        let there = pairs.all(|(rest, last)| rest.abs_diff(last) <= REST_TOLERANCE);
        if streaming.run.is_some() || !there {
            self.target_is_rest = true;
        }
        match end {
            StreamEnd::Done => {}
            StreamEnd::Starved if there && streaming.run.is_none() => {}
            StreamEnd::Starved => self.report_late(CommandError::StreamDry),
            StreamEnd::Refused(refusal) => self.report_late(refusal.into()),
        }
    }

    /// A plan of the stream has not been taken in time: it ends by itself.
    pub(super) fn abort_streaming(&mut self) {
        if self.pending.stream().is_some() {
            self.pending = self.pending.stop().map_or(Pending::Nothing, Pending::Stop);
            self.report_stream_lost(CommandError::StreamDry);
        }
    }

    /// There is no stream any more, and the target is where the stage comes to rest.
    const fn report_stream_lost(&mut self, error: CommandError) {
        self.target_is_rest = true;
        self.report_late(error);
    }
}

/// Ticks without a target after which none is waited for any more.
fn start_timeout(stream: &Stream, period: f64) -> u64 {
    stream.targets_to_start() as u64 * period as u64
}

/// Room that is left in a stream that generators fill: they make targets as these are used, not long before.
const RESERVED_KNOTS: usize = 4;

//! Targets that follow one another in time: streamed by `MOV` (parameter 0x19001900), or made by wave generators.

use super::Stage;
use super::coordinates::Coordinates;
use super::sent_plan::{Course, Goal, code};
use super::wave::Run;
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{
    Clock, PERIOD_RANGE, PlanProgress, Position, PushError, Stream, StreamEnd, StreamStep,
};
use crate::queues::CommandQueues;

/// `SCT` at first.
pub(super) const CYCLE_MS: f64 = 10.0;

/// How far a stream may end from its last target and have come to rest there, 2^-32 track radii or turns: below what an
/// encoder tells apart.
const THERE: u64 = 32;

/// A stream under way, or about to be.
pub(super) struct Flow {
    /// `None` until the stage stands where the waves begin.
    stream: Option<Stream>,
    /// The generators that make its targets; none: `MOV` brings them.
    run: Option<Run>,
    /// The last target, and the tick when it came.
    last: (Position, u64),
    started: bool,
}

impl Stage {
    /// `SCT`: ms between streamed targets.
    pub fn set_cycle_time(&mut self, ms: f64) -> Result<(), ErrorCode> {
        if self.flow.is_some() {
            return Err(ErrorCode::InMotion);
        }
        if !PERIOD_RANGE.contains(&self.period(ms)) {
            return Err(ErrorCode::OutOfRange);
        }
        self.cycle_ms = ms;
        Ok(())
    }

    /// `SCT?`
    pub const fn cycle_time_ms(&self) -> f64 {
        self.cycle_ms
    }

    /// Ticks in so many ms.
    fn period(&self, ms: f64) -> f64 {
        ms * 1e-3 * self.base.limits.rate_hz
    }

    /// Which generators run, or are about to.
    pub fn generators_going(&self) -> [bool; 6] {
        let run = self.flow.as_ref().and_then(|flow| flow.run.as_ref());
        run.map_or([false; 6], Run::going)
    }

    /// A streamed target.
    pub(super) fn stream(&mut self, target: Coordinates, to: Position) -> Result<(), ErrorCode> {
        let ground = self.ground();
        if self.flow.is_none() {
            if self.mode() != Mode::Holding || self.motion_is_due() {
                return Err(ErrorCode::NotAllowed);
            }
            let period = self.period(self.cycle_ms);
            let stream = Stream::new(self.setpoint(), period, Clock::Sender);
            self.flow = Some(Flow {
                stream: Some(stream.ok_or(ErrorCode::OutOfRange)?),
                run: None,
                last: (to, 0),
                started: false,
            });
        }
        let now = self.tick();
        if let Some(flow) = &mut self.flow
            && let Some(stream) = &mut flow.stream
        {
            match stream.push(to, &ground) {
                Ok(()) => {}
                Err(PushError::Full) => return Err(ErrorCode::StreamFull),
                Err(PushError::Over) => return Err(ErrorCode::Busy),
                Err(PushError::Refused(refusal)) => return Err(code(&refusal)),
            }
            flow.last = (to, now);
        }
        self.target = target;
        self.target_is_rest = false;
        Ok(())
    }

    /// Sends the axes of `starting` through their tables, after a move to where these begin.
    pub(super) fn run_waves(
        &mut self,
        starting: &[bool; 6],
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_ready()?;
        if self.mode() != Mode::Holding || self.motion_is_due() {
            return Err(ErrorCode::InMotion);
        }
        let run = Run::new(&self.waves, starting, self.target, self.base.limits.rate_hz);
        let start = self.place_of(&run.start(&self.waves))?;
        self.want(Goal::Place(start), queues)?;
        self.target_is_rest = true;
        self.flow = Some(Flow {
            stream: None,
            run: Some(run),
            last: (start, 0),
            started: false,
        });
        Ok(())
    }

    /// Takes the next step of the stream.
    pub(super) fn carry_flow_on(&mut self, queues: &mut CommandQueues<'_>) {
        let Some(mut flow) = self.flow.take() else {
            return;
        };
        match self.next_of(&mut flow) {
            Ok(StreamStep::Wait) => self.flow = Some(flow),
            Ok(StreamStep::Send(plan, start)) => {
                // A queue that is full would be a plan that is lost.
                match self.send_course(Course::streamed(plan, start), queues) {
                    Ok(()) => {
                        flow.started = true;
                        self.flow = Some(flow);
                    }
                    Err(_) => self.lose_flow(),
                }
            }
            Ok(StreamStep::Over(end)) => self.end_flow(&flow, end),
            Err(code) => {
                self.target_is_rest = true;
                self.tell(code);
            }
        }
    }

    /// Brings targets where generators make them, and asks the stream what is to be done.
    fn next_of(&mut self, flow: &mut Flow) -> Result<StreamStep, ErrorCode> {
        let ground = self.ground();
        let (now, period) = (self.tick(), self.period(self.cycle_ms));
        if flow.stream.is_none() {
            let there = self.mode() == Mode::Holding && self.wanted.is_none();
            if !there {
                return Ok(StreamStep::Wait);
            }
            let period = f64::from(self.waves.ticks);
            flow.stream = Stream::new(self.setpoint(), period, Clock::Own);
        }
        let id = self.next_id();
        let (Some(stream), run) = (&mut flow.stream, &mut flow.run) else {
            return Err(ErrorCode::OutOfRange);
        };
        if let Some(run) = run {
            while stream.free_places() > SPARE {
                let Some(target) = run.next(&self.waves) else {
                    stream.finish();
                    break;
                };
                let place = self.place_of(&target)?;
                if let Err(PushError::Refused(refusal)) = stream.push(place, &ground) {
                    return Err(code(&refusal));
                }
                flow.last.0 = place;
            }
        } else if !flow.started && now > flow.last.1 + patience(stream, period) {
            // Too few for a stream: they are all that come.
            stream.finish();
        }
        let Some(snapshot) = &self.snapshot else {
            return Ok(StreamStep::Wait);
        };
        let progress = PlanProgress {
            plan: snapshot.plan,
            tick: snapshot.plan_tick,
            moving: snapshot.mode == Mode::Moving,
        };
        Ok(stream.next(id, &progress, &ground))
    }

    /// A stream is over. What dries up at rest, at its last target, has come to a good end.
    fn end_flow(&mut self, flow: &Flow, end: StreamEnd) {
        let rest = match self.under_way() {
            Some((course, _)) if self.mode() == Mode::Moving => course.plan.end,
            _ => self.setpoint(),
        };
        let mut pairs = rest.into_iter().zip(flow.last.0);
        let there = pairs.all(|(rest, last)| rest.abs_diff(last) <= THERE);
        if flow.run.is_some() || !there {
            self.target_is_rest = true;
        }
        match end {
            StreamEnd::Done => {}
            StreamEnd::Starved if there && flow.run.is_none() => {}
            StreamEnd::Starved => self.tell(ErrorCode::StreamDry),
            StreamEnd::Refused(refusal) => self.tell(code(&refusal)),
        }
    }

    /// A plan of the stream has not been taken in time: it ends by itself.
    pub(super) fn lose_flow(&mut self) {
        if self.flow.take().is_some() {
            self.target_is_rest = true;
            self.tell(ErrorCode::StreamDry);
        }
    }
}

/// Ticks without a target after which none is waited for any more.
fn patience(stream: &Stream, period: f64) -> u64 {
    stream.targets_to_start() as u64 * period as u64
}

/// Room that is left in a stream that generators fill: they make targets as these are used, not long before.
const SPARE: usize = 4;

//! What has been commanded, and so what the plans are for that the tick takes.

use super::allowance::{Purpose, only_brakes};
use crate::gcs_bench::axes::Course;
use firmware::motion::Stop;

#[derive(Default)]
pub struct Commanded {
    /// What is sent belongs to streamed targets or waveforms.
    streams: bool,
    awaited_stop: Option<AwaitedStop>,
}

/// A stop that has been commanded and not been taken.
struct AwaitedStop {
    how: Stop,
    /// Commands that were sent before it.
    waiting: usize,
    /// Something else has been commanded since.
    is_followed: bool,
}

impl Commanded {
    /// A motion is commanded; whether it is one of a stream's.
    pub fn begin_motion(&mut self, streams: bool) {
        self.streams = streams;
        if let Some(stop) = &mut self.awaited_stop {
            stop.is_followed = true;
        }
    }

    /// A stop is commanded, while so many commands wait that were sent before. One that is urgent already stays so.
    pub fn await_stop(&mut self, how: Stop, waiting: usize) {
        let stays = |stop: &AwaitedStop| stop.how == Stop::Urgent && !stop.is_followed;
        if !self.awaited_stop.as_ref().is_some_and(stays) {
            self.awaited_stop = Some(AwaitedStop {
                how,
                waiting,
                is_followed: false,
            });
        }
    }

    /// The stage is at rest: a stop that has not been taken was none to be made.
    pub fn come_to_rest(&mut self) {
        self.awaited_stop = None;
    }

    /// What a plan is for that has just been taken. The first one after a stop is commanded is the stop; unless there was
    /// none to be made, because the motion came to rest as soon by itself, and it is for what was commanded then.
    pub fn purpose_of(&mut self, course: &Course) -> Purpose {
        let otherwise = if self.streams {
            Purpose::Stream
        } else {
            Purpose::Ordinary
        };
        let Some(stop) = &mut self.awaited_stop else {
            return otherwise;
        };
        if stop.waiting > 0 {
            stop.waiting -= 1;
            return otherwise;
        }
        let AwaitedStop {
            how, is_followed, ..
        } = *stop;
        self.awaited_stop = None;
        match how {
            _ if is_followed && !only_brakes(course) => otherwise,
            Stop::Urgent => Purpose::UrgentStop,
            Stop::Smooth => Purpose::Ordinary,
        }
    }
}

//! The machine as a run sees it: lines over the way that its page has to the controller, or over one of its own, and whoever looks at a page for
//! what only a person can do.

use std::io;
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

use tokio::runtime::Handle;

use super::control::Control;
use super::{Person, Reach};
use crate::commission::{Machine, Task};
use crate::record::RecordError;
use crate::record::desk::{hint, strange};
use crate::web::bridge::{HeldWay, Way};
use crate::web::own_line::Jogs;
use crate::web::request::Refusal;

/// Asks for the seconds in a tick.
const PERIOD: &str = "SPA? 1 0xE000200";
/// Longest pause between two looks at the controller's clock.
const LOOK_EVERY: Duration = Duration::from_millis(20);
/// How long the clock may take for a second, in seconds of this computer: a simulated stage may be slow.
const PATIENCE: f64 = 200.0;
const LEAST_PATIENCE_S: f64 = 10.0;
/// What the jig takes to hold, by a simulated person, s.
const JIG_S: f64 = 0.1;

/// Who is told what a person is asked for, and whether somebody simulated does it; none once that is done.
pub(in super::super) type Asks = Box<dyn Fn(Option<(Task, bool)>) + Send>;

/// See the module.
pub(in super::super) struct PageMachine {
    /// Its own way to the controller.
    own: HeldWay,
    /// That of the page that began it, where that page owns the stage.
    owners: Option<Arc<Way>>,
    runtime: Handle,
    control: Arc<Control>,
    /// What it is called where others ask who commands.
    name: &'static str,
    pub person: Option<Person>,
    pub asks: Asks,
    /// As whoever has begun it says.
    pub scale_periods: Option<u32>,
    place: String,
    /// Seconds in a tick, once they are known.
    period_s: Option<f64>,
}

impl PageMachine {
    /// Over the way with this key if that one owns the stage, and else over one of its own. Nobody is beside it.
    pub fn open(reach: &Reach, key: &str, name: &'static str) -> Result<Self, String> {
        let Reach {
            bridge,
            runtime,
            control,
        } = reach;
        let own = bridge.way();
        Ok(Self {
            own: own.map_err(|error| format!("no way to the controller: {error}"))?,
            owners: runtime.block_on(bridge.owners_way(key)),
            runtime: runtime.clone(),
            control: Arc::clone(control),
            name,
            person: None,
            asks: Box::new(|_| ()),
            scale_periods: None,
            place: bridge.place(),
            period_s: None,
        })
    }

    /// Others may look, and stop, and nothing else, until [`Self::leave`].
    pub fn take_over(&mut self) -> Result<(), RecordError> {
        if self.owners.is_some() {
            return Ok(());
        }
        match self.ask(&format!("OWN 1 {}", self.name)) {
            // An older controller does not know it, and does without.
            Err(RecordError::Refused { code: 2, .. }) => Ok(()),
            answer => answer.map(drop),
        }
    }

    /// Everybody may command again.
    pub fn leave(&mut self) {
        if self.owners.is_none() {
            // With the line gone it ends by itself.
            let _ = self.send("OWN 0");
        }
    }

    fn way(&self) -> Arc<Way> {
        let own = || Arc::clone(&self.own.0);
        self.owners.clone().unwrap_or_else(own)
    }

    fn send(&self, line: &str) -> Result<Option<String>, RecordError> {
        let asked = self
            .runtime
            .block_on(self.way().ask_so(line.to_owned(), Jogs::Free));
        match asked {
            // A stop has error 10 without having been refused.
            Ok(answer) if matches!(answer.error, 0 | 10) => Ok(answer.reply),
            Ok(answer) => Err(RecordError::Refused {
                line: line.to_owned(),
                code: answer.error,
                hint: hint(line, answer.error),
            }),
            Err(Refusal::Stopped) => Err(RecordError::Ended("a stop".to_owned())),
            Err(refusal) => Err(RecordError::Broken {
                place: self.place.clone(),
                error: io::Error::other(refusal.to_string()),
            }),
        }
    }

    /// Told to end once; what follows brings the stage to rest.
    fn check_end(&self) -> Result<(), RecordError> {
        match self.control.ended() {
            Some(by) => Err(RecordError::Ended(by)),
            None => Ok(()),
        }
    }

    fn tick(&mut self) -> Result<f64, RecordError> {
        let answer = self.ask("MON?")?.unwrap_or_default();
        let tick = answer.lines().find_map(|line| line.strip_prefix("TICK="));
        let number = tick.and_then(|text| text.split([' ', ',']).next()?.trim().parse().ok());
        number.ok_or_else(|| strange("MON?", &answer))
    }

    fn period_s(&mut self) -> Result<f64, RecordError> {
        if let Some(period_s) = self.period_s {
            return Ok(period_s);
        }
        let answer = self.ask(PERIOD)?.unwrap_or_default();
        let number = answer
            .rsplit('=')
            .next()
            .and_then(|text| text.trim().parse().ok());
        let period_s = number.ok_or_else(|| strange(PERIOD, &answer))?;
        self.period_s = Some(period_s);
        Ok(period_s)
    }
}

impl Machine for PageMachine {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        self.check_end()?;
        loop {
            match self.send(line) {
                // While the stage is brought to rest one more stop, or the one that ends the run and goes out after it was told, ends nothing.
                Err(RecordError::Ended(_)) if self.control.knows() => {}
                answer => return answer,
            }
        }
    }

    /// By looking at its clock: `DEL` would hold up the pages that share the line.
    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        let period_s = self.period_s()?;
        let end = self.tick()? + seconds / period_s;
        let patience_s = (PATIENCE * seconds).max(LEAST_PATIENCE_S);
        let patience = Instant::now() + Duration::from_secs_f64(patience_s);
        loop {
            let left_s = (end - self.tick()?) * period_s;
            if left_s <= 0.0 {
                return Ok(());
            }
            if Instant::now() > patience {
                let stands = io::Error::new(io::ErrorKind::TimedOut, "its clock stands still");
                return Err(RecordError::Broken {
                    place: self.place.clone(),
                    error: stands,
                });
            }
            sleep(LOOK_EVERY.min(Duration::from_secs_f64(left_s)));
        }
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        self.check_end()?;
        self.control.ask();
        (self.asks)(Some((task, self.person.is_some())));
        match (&self.person, task) {
            (Some(person), _) => {
                person(task);
                if task.is_said_to_be_done() {
                    self.delay(JIG_S)?;
                }
            }
            (None, task) if task.is_said_to_be_done() => {
                self.control.wait(|| false);
                (self.asks)(None);
                self.check_end()?;
            }
            // The encoders tell.
            (None, _) => {}
        }
        Ok(())
    }

    fn scale_periods(&self) -> Option<u32> {
        self.scale_periods
    }
}

//! The thread that runs the steps, and tries gains.

use std::sync::Arc;
use std::sync::mpsc::Receiver;

use super::super::runs::{Files, Ordered, PageMachine, Person, Reach, Told, places};
use super::Order;
use super::status::{Status, Tried, Tuning};
use crate::commission::{
    Backup, Chosen, Conditions, Done, Machine, Numbers, Ran, Results, Tunable, ZerosBy, page, run,
};
use crate::date::today;
use crate::record::RecordError;
use crate::web::operator::journal::Journal;

/// What it is called where others ask who commands.
const NAME: &str = "commissioning";
const REPORT: &str = "report.html";
const BEFORE: &str = "before.txt";

/// See the module.
pub(super) struct Worker {
    pub reach: Reach,
    pub told: Arc<Told<Status>>,
    pub files: Files,
    pub journal: Journal,
    pub person: Option<Person>,
    /// The loops that were measured last.
    pub tunable: Option<Tunable>,
    /// What was in force before the last commissioning.
    pub before: Option<Backup>,
    /// What the last one found.
    pub earlier: Option<Results>,
}

/// What an order came to, in words, or why it came to nothing.
type Came = Result<String, String>;

impl Worker {
    /// Until the server ends.
    pub fn run(mut self, orders: &Receiver<Ordered<Order>>) {
        for ordered in orders {
            let what = what(&ordered.order);
            let came = self.carry_out(&ordered, what);
            let (good, said) = match came {
                Ok(said) => (true, said),
                Err(said) => (false, said),
            };
            self.journal.note(&ordered.who, &format!("{what}…"), &said);
            self.told
                .ends(&self.reach.control, good, said, Status::rests);
            self.files.keep_plots(&self.told.plots());
        }
    }

    fn carry_out(
        &mut self,
        Ordered { order, key, .. }: &Ordered<Order>,
        what: &'static str,
    ) -> Came {
        let chosen = match order {
            Order::Commission {
                from,
                without_jig,
                also_carries_kg,
                ..
            } => {
                let zeros = ZerosBy::new(*without_jig);
                let all = || Ok(Chosen::all(zeros));
                (from.as_ref())
                    .map_or_else(all, |from| Chosen::from(from, zeros))
                    .and_then(|chosen| chosen.also_carrying(*also_carries_kg))
            }
            Order::Only { step, .. } => Chosen::only(step),
            Order::Tune { also_carries_kg } => Chosen::tune().also_carrying(*also_carries_kg),
            Order::Measure => {
                self.told
                    .begins(what, |status| status.begin(Chosen::response().steps()));
                return self.steps(key, &Chosen::response(), None);
            }
            other => {
                self.told.begins(what, |_| ());
                return self.by_hand(key, other);
            }
        };
        let chosen = chosen.map_err(|error| {
            // Refused under the name of what was asked for.
            self.told.begins(what, |_| ());
            error.to_string()
        })?;
        self.told
            .begins(what, |status| status.begin(chosen.steps()));
        let scale_periods = match order {
            Order::Commission { scale_periods, .. } | Order::Only { scale_periods, .. } => {
                *scale_periods
            }
            _ => None,
        };
        self.steps(key, &chosen, scale_periods)
    }

    /// Runs steps.
    fn steps(&mut self, key: &str, chosen: &Chosen, scale_periods: Option<u32>) -> Came {
        let keeps = chosen.keeps();
        let mut machine = self.machine(key)?;
        machine.scale_periods = scale_periods;
        let ran = self.over_steps(&mut machine, chosen);
        let ran = ran.map_err(|error| ended(&mut machine, error));
        machine.leave();
        let (conditions, Ran { done, tunable }) = ran?;
        let changes = self.changes(&conditions, &done, keeps);
        let report = page(&conditions, &done, changes.as_deref());
        let report = self.files.put(REPORT, &report);
        for table in done.iter().flat_map(|done| &done.found.tables) {
            self.files.put(&format!("{}.csv", table.name), &table.csv);
        }
        let plots = (done.iter().rev())
            .find(|done| !done.found.tables.is_empty())
            .map(|done| places(&done.found.plots, &self.files));
        self.told.change(|status| {
            status.report = Some(report);
            status.tables = self.files.tables();
            if let Some(tunable) = &tunable {
                status.tuning = Some(Tuning::new(
                    tunable.numbers(),
                    tunable.measured(),
                    plots.unwrap_or_default(),
                ));
            }
        });
        self.tunable = tunable.or(self.tunable.take());
        let seconds: f64 = done.iter().map(|done| done.seconds).sum();
        match done
            .iter()
            .find_map(|done| Some((done.step.name, done.failure.as_ref()?)))
        {
            Some((step, failure)) => Err(format!("step {step} has failed: {}", failure.what)),
            None if keeps => Ok(format!(
                "done and kept, {seconds:.0} s of the machine's time"
            )),
            None => Ok(format!(
                "measured in {seconds:.0} s of the machine's time; everything is as it was, the servo is off"
            )),
        }
    }

    fn over_steps(
        &mut self,
        machine: &mut PageMachine,
        chosen: &Chosen,
    ) -> Result<(Conditions, Ran), RecordError> {
        machine.take_over()?;
        let identity = machine.ask("*IDN?")?.unwrap_or_default();
        let conditions = Conditions {
            machine: "machine".to_owned(),
            identity,
            date: today(),
            temperature_c: None,
        };
        if chosen.keeps() {
            let before = Backup::of(machine)?;
            let path = self.files.put(BEFORE, &before.to_string());
            self.before = Some(before);
            self.told.change(|status| status.before = Some(path));
        }
        let ran = run(machine, chosen, &mut |done| {
            self.told.step(done, &self.files)
        })?;
        Ok((conditions, ran))
    }

    /// What has changed since the last time, where there was one; and what is compared next time.
    fn changes(
        &mut self,
        conditions: &Conditions,
        done: &[Done],
        keeps: bool,
    ) -> Option<Vec<crate::commission::Change>> {
        if !keeps || done.iter().any(|done| done.failure.is_some()) {
            return None;
        }
        let results = Results::new(conditions.clone(), done);
        let changes = (self.earlier.as_ref()).map(|earlier| results.changes(earlier));
        self.earlier = Some(results);
        changes
    }

    /// What takes no steps.
    fn by_hand(&mut self, key: &str, order: &Order) -> Came {
        match order {
            Order::Predict { gains } => self.predict(gains),
            Order::Put { gains } => {
                let tunable = self.tunable.clone().ok_or("measure the loops first")?;
                let mut machine = self.machine(key)?;
                (tunable.put_in_force(&mut machine, gains)).map_err(|error| error.to_string())?;
                Ok("in force, and not kept: measure the loops again".to_owned())
            }
            Order::Keep => {
                let mut machine = self.machine(key)?;
                machine.ask("CCL 1 ADVANCED").map_err(said)?;
                machine.ask("WPA 100").map_err(said)?;
                Ok("what is in force is kept".to_owned())
            }
            Order::Undo => {
                let before = self
                    .before
                    .clone()
                    .ok_or("nothing was commissioned from here")?;
                let mut machine = self.machine(key)?;
                let changed = before.give_back(&mut machine);
                let changed = changed.map_err(|error| error.to_string())?;
                Ok(format!(
                    "{} parameters and {} macros are what they were before, and kept",
                    changed.parameters, changed.macros
                ))
            }
            _ => Ok(String::new()),
        }
    }

    fn predict(&self, gains: &Numbers) -> Came {
        let tunable = self.tunable.as_ref().ok_or("measure the loops first")?;
        let predicted = tunable.predict(gains).map_err(|error| error.to_string())?;
        let tried = Tried {
            gains: *gains,
            is_stable: predicted.is_stable,
            loops: predicted.loops,
            plots: places(&predicted.plots, &self.files),
        };
        self.told.change(|status| {
            if let Some(tuning) = &mut status.tuning {
                tuning.tried = Some(tried);
            }
        });
        Ok("computed from the loops that were measured; nothing is changed".to_owned())
    }

    fn machine(&self, key: &str) -> Result<PageMachine, String> {
        let mut machine = PageMachine::open(&self.reach, key, NAME)?;
        machine.person.clone_from(&self.person);
        let told = Arc::clone(&self.told);
        machine.asks = Box::new(move |asked| match asked {
            Some((task, is_simulated)) => told.asks(task, is_simulated),
            None => told.answered(),
        });
        Ok(machine)
    }
}

fn said(error: RecordError) -> String {
    error.to_string()
}

/// Why a run has ended early, and what is known of the stage then.
fn ended(machine: &mut PageMachine, error: RecordError) -> String {
    let servo = machine.ask("SVO? X").ok().flatten().unwrap_or_default();
    let motors = match servo.trim() {
        "X=0" => "the motors are off",
        _ => "whether the motors are off is not known",
    };
    format!("{error}; {motors}, and nothing was kept")
}

/// What an order is called.
pub(super) const fn what(order: &Order) -> &'static str {
    match order {
        Order::Commission { .. } => "commissioning",
        Order::Only { .. } => "one step of commissioning",
        Order::Tune { .. } => "tuning for another payload",
        Order::Measure => "measuring the loops",
        Order::Predict { .. } => "gains on the loops as measured",
        Order::Put { .. } => "gains put in force",
        Order::Keep => "keeping what is in force",
        Order::Undo => "giving back what was before",
        Order::Done | Order::End => "",
    }
}

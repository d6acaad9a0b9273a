//! The thread that measures, fits, applies and verifies.

use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Instant;

use ::calibration::file::Calibration;
use ::calibration::table::Table;
use ::calibration::{Instrument, Kit, plan};

use super::super::runs::{Control, Failed, Files, Ordered, PageMachine, Reach, Told, places};
use super::by_hand::ByHand;
use super::measurement::Measurement;
use super::status::{APPLY, FIT, MEASURE, PLAN, Progress, Status, VERIFY};
use super::wish::Wish;
use super::{Instruments, Order};
use crate::calibrate::report::{Report, left_by_visit, page};
use crate::calibrate::{
    self, ApplyError, Evidence, FitTold, Fitted, Line, PlanTold, Reader, Verdict, apply, measure,
    serial, switch_off, verify,
};
use crate::commission::Machine;
use crate::web::operator::journal::Journal;

/// What it is called where others ask who commands.
const NAME: &str = "calibration";
const MEASURED: &str = "measured.csv";
const CALIBRATION: &str = "calibration.toml";
const REPORT: &str = "report.html";

/// See the module.
pub(super) struct Worker {
    reach: Reach,
    told: Arc<Told<Status>>,
    files: Files,
    journal: Journal,
    instruments: Option<Instruments>,
    /// What was measured last, or of it so far.
    measurement: Option<Measurement>,
    /// What came of it.
    made: Option<Made>,
    /// What was given to the controller from here.
    applied: Option<Calibration>,
}

/// A calibration, and what it was fitted to.
struct Made {
    table: Table,
    fitted: Fitted,
    verified: Option<calibrate::Told>,
}

/// What an order came to, in words, or why it came to nothing.
type Came = Result<String, String>;

/// What a step came to.
type Done<T> = Result<T, Failed>;

fn failed(what: impl ToString, advice: &str) -> Failed {
    Failed {
        what: what.to_string(),
        advice: advice.to_owned(),
    }
}

impl Worker {
    pub const fn new(
        reach: Reach,
        told: Arc<Told<Status>>,
        files: Files,
        journal: Journal,
        instruments: Option<Instruments>,
    ) -> Self {
        Self {
            reach,
            told,
            files,
            journal,
            instruments,
            measurement: None,
            made: None,
            applied: None,
        }
    }

    /// Until the server ends.
    pub fn run(mut self, orders: &Receiver<Ordered<Order>>) {
        for Ordered {
            order, key, who, ..
        } in orders
        {
            let what = what(&order);
            self.told.begins(what, Status::rests);
            let came = self.carry_out(&order, &key);
            let (good, said) = match came {
                Ok(said) => (true, said),
                Err(said) => (false, said),
            };
            self.journal.note(&who, &format!("{what}…"), &said);
            let unfinished = |measurement: &Measurement| !measurement.is_whole();
            let may_resume = self.measurement.as_ref().is_some_and(unfinished);
            self.told.ends(&self.reach.control, good, said, |status| {
                (status.may_resume, status.may_apply) = (may_resume, self.made.is_some());
                status.rests();
            });
            self.files.keep_plots(&self.told.plots());
        }
    }

    fn carry_out(&mut self, order: &Order, key: &str) -> Came {
        match order {
            Order::Plan(wish) => {
                let (instrument, poses) = (wish.instrument()?, wish.poses);
                self.step(PLAN, |worker| worker.plan(&instrument, poses))?;
                Ok("nothing has moved".to_owned())
            }
            Order::Measure(wish) => {
                let (instrument, poses) = (wish.instrument()?, wish.poses);
                let planned = self.step(PLAN, |worker| worker.plan(&instrument, poses))?;
                let mut machine = self.machine(key)?;
                let serial = serial(&mut machine).map_err(|error| error.to_string())?;
                self.made = None;
                self.measurement = Some(Measurement::new(instrument, &planned, serial));
                self.measured(machine)
            }
            Order::Resume => {
                let machine = self.machine(key)?;
                self.measured(machine)
            }
            Order::Apply => {
                let mut machine = self.machine(key)?;
                self.step(APPLY, |worker| worker.apply(&mut machine))?;
                Ok("in force, and kept by the controller; the servo is off".to_owned())
            }
            Order::Verify(wish) => {
                let mut machine = self.machine(key)?;
                self.step(VERIFY, |worker| {
                    machine
                        .take_over()
                        .map_err(|error| failed(error, NOT_REACHED))?;
                    let verified = worker.verify(&mut machine, wish);
                    machine.leave();
                    verified
                })
            }
            Order::Undo => {
                let mut machine = self.machine(key)?;
                switch_off(&mut machine).map_err(|error| error.to_string())?;
                Ok("no calibration is in force: the controller believes the drawing; the servo is off".to_owned())
            }
            Order::Pause | Order::Continue | Order::Read(_) | Order::End => Ok(String::new()),
        }
    }

    /// A step, as pages see it.
    fn step<T>(
        &mut self,
        name: &str,
        work: impl FnOnce(&mut Self) -> Done<T>,
    ) -> Result<T, String> {
        self.told.step_begins(name);
        let start = Instant::now();
        let done = work(self);
        let failure = done.as_ref().err().cloned();
        let seconds = start.elapsed().as_secs_f64();
        self.told.step_ends(name, seconds, failure);
        done.map_err(|failed| format!("{name}: {}", failed.what))
    }

    fn plan(&self, instrument: &Instrument, poses: usize) -> Done<::calibration::Plan> {
        let planned = plan(instrument, poses).ok_or_else(|| {
            let what = "these numbers of the instrument leave nothing to compute with";
            failed(what, "look at its noise")
        })?;
        let lines = PlanTold::new(instrument, &planned).lines();
        self.told.step(PLAN, |step| {
            step.findings = lines.into_iter().map(Into::into).collect();
        });
        Ok(planned)
    }

    /// Measures what is left to be measured, and fits it.
    fn measured(&mut self, mut machine: PageMachine) -> Came {
        let temperature_c = self.step(MEASURE, |worker| {
            machine
                .take_over()
                .map_err(|error| failed(error, NOT_REACHED))?;
            let visited = worker.visit(&mut machine);
            let temperature_c = temperature_c(&mut machine);
            machine.leave();
            visited.map(|()| temperature_c)
        })?;
        let expected = self.step(FIT, |worker| worker.fit(temperature_c))?;
        Ok(format!(
            "{expected}; what is in force is what it was before"
        ))
    }

    fn visit(&mut self, machine: &mut PageMachine) -> Done<()> {
        let measurement = self.measurement.as_mut();
        let Some(measurement) = measurement.filter(|measurement| !measurement.is_whole()) else {
            return Err(failed("there is no measurement to go on with", "begin one"));
        };
        let (told, files, control) = (&self.told, &self.files, &self.reach.control);
        let instrument = measurement.instrument.clone();
        let stops = measurement.stops.clone();
        let mut reader = reader(&instrument, self.instruments.as_ref(), told, control)?;
        measurement.begin();
        let way = measurement.way(&stops, &instrument.ends);
        progress(told, measurement.visits, stops.len());
        let visited = measure(machine, reader.as_mut(), &way, &mut |measured| {
            let looks = measurement.keep(measured);
            progress(told, measurement.visits, stops.len());
            if looks {
                look(told, files, measurement);
            }
            control.stay_paused();
            Ok(())
        });
        put(told, files, MEASURED, &measurement.text);
        let made = measurement.visits;
        visited.map_err(|error| {
            let what = format!("{error}; {made} of {} visits are kept", stops.len());
            failed(what, "\u{201c}Go on\u{201d} continues behind them")
        })
    }

    /// What is expected of the calibration.
    fn fit(&mut self, temperature_c: Option<f64>) -> Done<String> {
        let Some(measurement) = &self.measurement else {
            return Err(failed("nothing was measured", "measure first"));
        };
        let table = measurement
            .table()
            .map_err(|what| failed(what, MORE_POSES))?;
        let fitted = measurement.fitted(&table, temperature_c);
        let fitted = fitted.map_err(|error| failed(error, MORE_POSES))?;
        let text = fitted.calibration.to_text();
        put(&self.told, &self.files, CALIBRATION, &text);
        let told = FitTold::new(&fitted, &table, CALIBRATION);
        let plots = places(&left_by_visit(&fitted.fit, &fitted.left), &self.files);
        self.told.step(FIT, |step| {
            step.findings = told.lines().into_iter().map(Into::into).collect();
            step.plots = plots;
        });
        self.made = Some(Made {
            table,
            fitted,
            verified: None,
        });
        self.report()?;
        let (xy_um, theta_urad) = (told.expected_xy_nm * 1e-3, told.expected_theta_urad);
        Ok(format!(
            "expected: {xy_um:.3} um in x and y, {theta_urad:.2} urad"
        ))
    }

    fn apply(&mut self, machine: &mut PageMachine) -> Done<()> {
        let Some(Made { table, fitted, .. }) = &self.made else {
            return Err(failed("nothing was fitted", "measure first"));
        };
        let calibration = &fitted.calibration;
        let evidence = Evidence {
            instrument: table.instrument(calibration.made.noise()),
            visits: table.visits.clone(),
            references: table.references_but(&fitted.fit.outliers),
            over: self.applied.clone(),
        };
        let told = apply(machine, calibration, &evidence);
        let told = told.map_err(|error| {
            let advice = match error {
                ApplyError::Unknown => "\u{201c}Out of force\u{201d} takes it out",
                _ => "what was in force before still is",
            };
            failed(error, advice)
        })?;
        self.applied = Some(calibration.clone());
        let lines = told.lines().filter_map(|line| line.trim().split_once('='));
        self.told.step(APPLY, |step| {
            step.findings = lines
                .map(|(what, text)| Line::new(what, text).into())
                .collect();
        });
        Ok(())
    }

    fn verify(&mut self, machine: &mut PageMachine, wish: &Wish) -> Done<String> {
        let calibration = self.made.as_ref().map(|made| &made.fitted.calibration);
        let calibration = calibration
            .ok_or_else(|| failed("nothing was fitted", "measure first"))?
            .clone();
        let instrument = wish.before_scatter(calibration.made.noise().encoder_rad);
        let instrument = instrument.map_err(|what| failed(what, "look at the numbers above"))?;
        let (told, control) = (&self.told, &self.reach.control);
        let mut reader = reader(&instrument, self.instruments.as_ref(), told, control)?;
        let verified = verify(
            machine,
            reader.as_mut(),
            &calibration,
            &instrument,
            wish.poses,
            &mut |made, of| {
                progress(told, made, of);
                control.stay_paused();
            },
        );
        let verified = verified.map_err(|error| failed(error, "nothing is changed"))?;
        let told = calibrate::Told::new(&instrument, &verified);
        let lines = told.lines();
        self.told.step(VERIFY, |step| {
            step.findings = lines.into_iter().map(Into::into).collect();
        });
        let verdict = told.verdict.clone();
        if let Some(made) = &mut self.made {
            made.verified = Some(told);
        }
        self.report()?;
        match verified.verdict() {
            Verdict::Holds | Verdict::Better => Ok(verdict),
            Verdict::Worse | Verdict::WorseThanDrawn => Err(failed(verdict, TAKE_OUT)),
        }
    }

    /// All that is known of it, as a page.
    fn report(&self) -> Done<()> {
        let Some(made) = &self.made else {
            return Ok(());
        };
        let report = Report {
            calibration: &made.fitted.calibration,
            measured: &made.table,
            verified: made.verified.as_ref(),
            truth: None,
        };
        let text = page(&report).map_err(|error| failed(error, "the files are there"))?;
        let place = self.files.put(REPORT, &text);
        self.told.change(|status| status.report = Some(place));
        Ok(())
    }

    fn machine(&self, key: &str) -> Result<PageMachine, String> {
        PageMachine::open(&self.reach, key, NAME)
    }
}

const NOT_REACHED: &str = "look at the controller's line, and at who commands it";
const MORE_POSES: &str = "measure at more poses, or look at the instrument";
const TAKE_OUT: &str = "another machine's, damaged, or the instrument is not what was said: \u{201c}Out of force\u{201d} takes it out";

/// What reads this instrument.
fn reader(
    instrument: &Instrument,
    instruments: Option<&Instruments>,
    told: &Arc<Told<Status>>,
    control: &Arc<Control>,
) -> Done<Box<dyn Reader>> {
    match instruments {
        Some(instruments) if instrument.kit != Kit::Ends => (instruments.set_up)(instrument)
            .ok_or_else(|| {
                let what = format!("{} has no {}", instruments.words, instrument.kit);
                failed(what, "choose another instrument")
            }),
        _ => Ok(Box::new(ByHand {
            instrument: instrument.clone(),
            control: Arc::clone(control),
            told: Arc::clone(told),
        })),
    }
}

fn progress(told: &Told<Status>, made: usize, of: usize) {
    told.change(|status| status.progress = Some(Progress { made, of }));
}

/// A file for pages.
fn put(told: &Told<Status>, files: &Files, name: &str, text: &str) {
    let place = files.put(name, text);
    told.change(|status| {
        if !status.files.contains(&place) {
            status.files.push(place);
        }
    });
}

/// What the visits so far say.
fn look(told: &Told<Status>, files: &Files, measurement: &Measurement) {
    let Ok(table) = measurement.table() else {
        return;
    };
    match measurement.fitted(&table, None) {
        Ok(fitted) => {
            let lines = FitTold::new(&fitted, &table, "").lines();
            let plots = places(&left_by_visit(&fitted.fit, &fitted.left), files);
            told.step(MEASURE, |step| {
                step.findings = lines.into_iter().map(Into::into).collect();
                step.plots = plots;
            });
        }
        Err(error) => told.step(MEASURE, |step| {
            step.findings = vec![Line::judged("so far", error.to_string(), false).into()];
        }),
    }
    files.keep_plots(&told.plots());
}

/// What the controller was told of the machine's temperature, deg C.
fn temperature_c(machine: &mut PageMachine) -> Option<f64> {
    let told = machine.ask("TMP?").ok()??;
    let text = told
        .lines()
        .find_map(|line| line.trim().strip_prefix("TEMPERATURE="));
    text?.trim().parse().ok()
}

/// What an order is called.
pub(super) const fn what(order: &Order) -> &'static str {
    match order {
        Order::Plan(_) => "planning",
        Order::Measure(_) => "measuring",
        Order::Resume => "measuring on",
        Order::Apply => "giving the calibration to the controller",
        Order::Verify(_) => "verifying",
        Order::Undo => "taking the calibration out of force",
        Order::Pause | Order::Continue | Order::Read(_) | Order::End => "",
    }
}

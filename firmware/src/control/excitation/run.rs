//! The excitation under way: its volts, its guards, its end.

use super::request::{Excitation, ExcitationSignal};
use crate::control::units::{CURRENT_A_PER_COUNT, UNITS_PER_RAD};
use crate::mode::Mode;
use kinematics::Angle;

/// Ticks for which the motors brake at the end: 20 ms, in which a ring comes to rest from any rate that the guards let it have.
const BRAKING_TICKS: u32 = 400;

/// Why an excitation has ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExcitationEnd {
    /// There has been none, or it is under way.
    #[default]
    None,
    /// Its time was over.
    Time,
    /// A pivot has gone as far as it was to; value in rad.
    Way,
    /// The motor has carried as much as it was to; value in A.
    Current,
    /// It was stopped.
    Stopped,
    /// A fault has ended it.
    Fault,
}

/// What came of an excitation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExcitationReport {
    /// Whether it is under way; braking at its end counts as that.
    pub runs: bool,
    /// Why it has ended.
    pub end: ExcitationEnd,
    /// Which pivot has ended it, 0 to 2.
    pub pivot: u8,
    /// By what.
    pub value: f32,
    /// Ticks that it took.
    pub ticks: u32,
}

/// What a guard has found: pivot, value, limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control) enum GuardBroken {
    /// A pivot went too far, 2^-32 turns.
    Way(usize, u32, u32),
    /// A pivot was too fast, 2^-32 turns a tick.
    Rate(usize, u32, u32),
}

/// The one excitation, under way or over.
#[derive(Clone, Debug, Default)]
pub struct ExcitationRun {
    request: Option<Excitation>,
    report: ExcitationReport,
    /// What it adds to the servos' voltages, with the servo on.
    pub(in crate::control) added_volts: [f32; 3],
    /// Ticks of braking left.
    braking_ticks: u32,
    /// Where servos are to have the pivots, or where these were at the start.
    pub(in crate::control) setpoints: [Angle; 3],
    /// How far the ring has been moved, 2^-32 turns.
    moved: i32,
}

impl ExcitationRun {
    pub(in crate::control) fn start(&mut self, request: &Excitation, pivots: &[Angle; 3]) {
        *self = Self {
            request: Some(request.clone()),
            setpoints: *pivots,
            ..Self::default()
        };
    }

    /// The one under way.
    pub(in crate::control) const fn request(&self) -> Option<&Excitation> {
        self.request.as_ref()
    }

    /// What came of it.
    pub(in crate::control) fn report(&self, mode: Mode) -> ExcitationReport {
        ExcitationReport {
            runs: self.request.is_some() || mode == Mode::Exciting,
            ..self.report
        }
    }

    /// Whether braking is over too. To be asked once a tick when nothing is [under way](Self::request).
    pub(in crate::control) fn has_come_to_rest(&mut self) -> bool {
        self.braking_ticks = self.braking_ticks.saturating_sub(1);
        self.braking_ticks == 0
    }

    /// Ends what is under way, for nothing that a pivot did.
    pub(in crate::control) fn end(&mut self, end: ExcitationEnd) {
        if self.request.is_some() {
            self.finish(end, 0, 0.0);
        }
    }

    fn finish(&mut self, end: ExcitationEnd, pivot: usize, value: f32) {
        self.request = None;
        self.braking_ticks = BRAKING_TICKS;
        self.added_volts = [0.0; 3];
        self.report.end = end;
        self.report.pivot = pivot as u8;
        self.report.value = value;
    }

    /// Goes a tick on with the servo on.
    #[cold]
    #[inline(never)]
    pub(in crate::control) fn advance_added_volts(&mut self) {
        if let Some((pivot, volts)) = self.advance()
            && let Some(added) = self.added_volts.get_mut(pivot)
        {
            *added = volts;
        }
    }

    /// Goes a tick on with the servo off: volts of the pivot that is excited; none when it has ended.
    pub(in crate::control) fn next_volts(
        &mut self,
        pivots: &[Angle; 3],
        current_counts: &[i16; 3],
    ) -> Option<(usize, f32)> {
        if let Some((end, pivot, value)) = self.reached(pivots, current_counts) {
            self.finish(end, pivot, value);
        }
        self.advance_ring();
        self.advance()
    }

    /// What was to end it.
    fn reached(
        &self,
        pivots: &[Angle; 3],
        current_counts: &[i16; 3],
    ) -> Option<(ExcitationEnd, usize, f32)> {
        let Excitation { pivot, until, .. } = *self.request.as_ref()?;
        let current = current_counts.get(pivot)?.unsigned_abs();
        if current >= until.current_counts {
            let value = f32::from(current) * CURRENT_A_PER_COUNT as f32;
            return Some((ExcitationEnd::Current, pivot, value));
        }
        for (i, way) in self.ways(pivots).into_iter().enumerate() {
            if way >= until.way {
                const RAD: f32 = (1.0 / UNITS_PER_RAD) as f32;
                return Some((ExcitationEnd::Way, i, way as f32 * RAD));
            }
        }
        None
    }

    /// How far the pivots are from their setpoints, 2^-32 turns.
    fn ways(&self, pivots: &[Angle; 3]) -> [u32; 3] {
        [0, 1, 2].map(|i| {
            let way = (pivots[i] - self.setpoints[i]).units().unsigned_abs();
            u32::try_from(way).unwrap_or(u32::MAX)
        })
    }

    /// The ring's setpoint goes on, as long as it has way left.
    fn advance_ring(&mut self) {
        let Some(Excitation {
            pivot,
            signal: ExcitationSignal::Ring { way, step },
            ..
        }) = self.request
        else {
            return;
        };
        let left = way - self.moved;
        let step = left.unsigned_abs().min(step) as i32 * left.signum();
        self.moved += step;
        if let Some(setpoint) = self.setpoints.get_mut(pivot) {
            *setpoint += Angle::from_units(i64::from(step));
        }
    }

    /// The pivot and its volts, until the time is over.
    fn advance(&mut self) -> Option<(usize, f32)> {
        let request = self.request.as_mut()?;
        let (pivot, tick) = (request.pivot, self.report.ticks);
        if tick >= request.ticks {
            self.finish(ExcitationEnd::Time, pivot, 0.0);
            return None;
        }
        self.report.ticks = tick + 1;
        Some((pivot, request.volts_at(tick)))
    }

    /// Whether a pivot has left what the guards allow, with the servo off.
    pub(in crate::control) fn broken_guard(
        &self,
        pivots: &[Angle; 3],
        steps: [i32; 3],
    ) -> Option<GuardBroken> {
        let guards = &self.request.as_ref()?.guards;
        for (i, way) in self.ways(pivots).into_iter().enumerate() {
            if way > guards.way {
                return Some(GuardBroken::Way(i, way, guards.way));
            }
            let step = steps[i].unsigned_abs();
            if step > guards.step {
                return Some(GuardBroken::Rate(i, step, guards.step));
            }
        }
        None
    }
}

impl Excitation {
    /// Volts of the next tick, within the guard's.
    fn volts_at(&mut self, tick: u32) -> f32 {
        let most = self.guards.volts;
        let volts = match &mut self.signal {
            ExcitationSignal::Volts { start, per_tick } => *start + *per_tick * tick as f32,
            ExcitationSignal::Sines(multisine) => multisine.next_volts(),
            ExcitationSignal::Ring { .. } => 0.0,
        };
        if volts > most {
            most
        } else if volts < -most {
            -most
        } else {
            volts
        }
    }
}

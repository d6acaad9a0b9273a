//! The run's clock: stops the emulator once a control period and moves everything outside the chip.

use super::board::{ChipBoard, HSE_ON, RCC_CR};
use super::cost::TickCost;
use super::follow::Following;
use super::period::{Action, Period, Reset};
use super::timeline::{EARLY_NS, FIRST_TICK_NS, LATCH_NS, PERIOD_NS};
use hal_sim::machine::devices::{BridgeState, Stage};
use rigless::emulator::{AccessKind, Driver, Hit, HitKind, Host, Settled, Stop};
use rigless::session::Session;
use rigless::time::VirtualNanos;
use std::ops::ControlFlow;

/// How often to look whether the timers have been started.
const SEARCH_NS: u64 = 5_000;
/// A chip that has not started its timers by then never will.
const BOOT_NS: u64 = 1_000_000_000;

const TIM1_CR1: u64 = 0x4001_0000;
const COUNTER_ENABLE: u64 = 1;

/// Addresses the run needs from the image.
#[derive(Clone, Copy, Debug)]
pub struct Landmarks {
    /// First instruction of the tick's interrupt handler.
    pub tick_begin: u64,
    /// Where its cost ends: its duties are written.
    pub tick_end: u64,
    /// Where all that it does has ended.
    pub handler_end: u64,
    /// The image's record.
    pub trace: u64,
}

/// Drives a run; `on_period` is the caller.
pub struct StageDriver<F> {
    pub on_period: F,
    pub stage: Stage,
    pub landmarks: Landmarks,
    pub cost: TickCost,
    pub resets: Vec<Reset>,
    pub bridge_faults: [bool; 3],
    pub probes: Vec<(u64, [BridgeState; 3])>,
    pub actions: Vec<(u64, Action)>,
    /// The ticks' instructions, where somebody has asked for them.
    pub following: Option<Following>,
    /// When the timers were started, since the last reset.
    pub started_at: Option<u64>,
    /// The tick to come, since the last reset.
    pub tick: u64,
    /// Instruction count at which the tick under way began.
    pub tick_began: Option<u64>,
    /// When the search for the start of the timers began, and how far the plant has been moved meanwhile.
    pub searching_since: u64,
    pub searched_periods: u64,
    pub never_started: bool,
    /// The loop was started where the chip has no code of it.
    pub not_mapped: bool,
}

impl<F> StageDriver<F> {
    pub fn new(on_period: F, stage: Stage, landmarks: Landmarks) -> Self {
        Self {
            on_period,
            stage,
            landmarks,
            cost: TickCost::default(),
            resets: Vec::new(),
            bridge_faults: [false; 3],
            probes: Vec::new(),
            actions: Vec::new(),
            following: None,
            started_at: None,
            tick: 0,
            tick_began: None,
            searching_since: 0,
            searched_periods: 0,
            never_started: false,
            not_mapped: false,
        }
    }

    fn stop_ns(started_at: u64, tick: u64) -> u64 {
        started_at + FIRST_TICK_NS + tick * PERIOD_NS - LATCH_NS - EARLY_NS
    }

    /// Takes note of a restart: the timers stand still and have to be found again, and the pins are as before.
    fn notice_resets(&mut self, session: &mut Session<ChipBoard>, now: VirtualNanos) {
        let resets = session.resets();
        if resets.len() == self.resets.len() {
            return;
        }
        self.resets = resets
            .iter()
            .map(|reset| Reset {
                at_ns: reset.at.0,
                cause: reset.cause,
            })
            .collect();
        self.started_at = None;
        self.tick = 0;
        self.tick_began = None;
        self.searching_since = now.0;
        self.searched_periods = 0;
        session.board_mut().drive_again(now, self.bridge_faults);
    }

    /// After a restart the plant goes on without the controller, its motors coasting. At power on it waits.
    fn coast_while_searching(&mut self, at_ns: u64) {
        if self.resets.is_empty() {
            return;
        }
        let periods = (at_ns - self.searching_since) / PERIOD_NS;
        while self.searched_periods < periods {
            self.stage.advance_period([BridgeState::RESET; 3]);
            self.searched_periods += 1;
        }
    }

    fn note_hit(&mut self, hit: Hit, host: &mut dyn Host) {
        let (address, at, instructions) = (hit.address, hit.at, hit.instruction_count);
        if let Some(following) = &mut self.following {
            match address {
                // The tick under way is the one before the one to come.
                _ if address == self.landmarks.tick_begin => {
                    following.begin(address, self.tick.saturating_sub(1), host);
                }
                _ if address == self.landmarks.tick_end => following.duties(address, host),
                _ if address == self.landmarks.handler_end => following.end(),
                _ => following.step(address, host),
            }
        }
        let Some(started_at) = self.started_at else {
            return;
        };
        // The tick under way is the one before the one to come.
        let due = started_at + FIRST_TICK_NS + self.tick.saturating_sub(1) * PERIOD_NS;
        let after_ns = at.0 as i64 - due as i64;
        if address == self.landmarks.tick_begin {
            self.tick_began = Some(instructions);
            self.cost.begin(after_ns);
        } else if address == self.landmarks.tick_end
            && let Some(began) = self.tick_began.take()
        {
            self.cost.add(instructions - began, after_ns.max(0) as u64);
        }
    }

    fn run_actions(&mut self, session: &mut Session<ChipBoard>, now: VirtualNanos) {
        while self
            .actions
            .first()
            .is_some_and(|(at_ns, _)| *at_ns <= now.0)
        {
            let (_, action) = self.actions.remove(0);
            let board = session.board_mut();
            match action {
                Action::EmergencyStop(pressed) => board.set_emergency_stop(now, pressed),
                // The register exists: the image wrote to it before.
                Action::HaltLoop => drop(board.stop_latch_timer(now)),
                Action::DelayLatch(counts) => drop(board.delay_latch(now, counts)),
                Action::LoseTick => drop(board.disarm_tick(now)),
                Action::Probe => self
                    .probes
                    .push((now.0, board.bridges(now, self.bridge_faults))),
            }
        }
    }
}

impl<F> StageDriver<F>
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()>,
{
    /// Moves the stage to the tick to come, hands its signals over, and lets the caller look.
    fn period(
        &mut self,
        session: &mut Session<ChipBoard>,
        now: VirtualNanos,
        host: &mut dyn Host,
    ) -> ControlFlow<()> {
        let board = session.board_mut();
        let pins = board.bridges(now, self.bridge_faults);
        if self.tick > 0 {
            (self.stage).set_brake_resistor(board.brake_resistor());
            self.stage.advance_period(pins);
        }
        board.set_frames(self.stage.frames());
        board.set_analog(self.stage.analog());
        let flow = (self.on_period)(&mut Period {
            board,
            host,
            at: now,
            trace_at: self.landmarks.trace,
            actions: &mut self.actions,
            tick: self.tick,
            stage: &mut self.stage,
            pins,
            bridge_faults: &mut self.bridge_faults,
            cost: self.cost,
            resets: &self.resets,
            probes: &self.probes,
            following: &mut self.following,
            ends: [
                self.landmarks.tick_begin,
                self.landmarks.tick_end,
                self.landmarks.handler_end,
            ],
        });
        let pulled = self.stage.pulled_fault_pins();
        let faults = [0, 1, 2].map(|axis| self.bridge_faults[axis] || pulled[axis]);
        session.board_mut().set_bridge_faults(now, faults);
        self.tick += 1;
        flow
    }

    fn search(&mut self, now: VirtualNanos) -> Option<VirtualNanos> {
        self.coast_while_searching(now.0);
        if now.0 - self.searching_since > BOOT_NS {
            self.never_started = true;
            return None;
        }
        Some(VirtualNanos(now.0 + SEARCH_NS))
    }
}

impl<F> Driver<ChipBoard> for StageDriver<F>
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send,
{
    fn on_settled(
        &mut self,
        session: &mut Session<ChipBoard>,
        host: &mut dyn Host,
        settled: Settled,
    ) {
        let now = match settled {
            Settled::Access { access, .. } => access.virtual_time,
            Settled::Stop(stop) => stop.at,
            Settled::Hit(hit) => hit.at,
            _ => return,
        };
        self.notice_resets(session, now);
        match settled {
            Settled::Access { access, .. }
                if self.started_at.is_none()
                    && access.address == TIM1_CR1
                    && access.kind == AccessKind::Write
                    && access.value & COUNTER_ENABLE != 0 =>
            {
                self.started_at = Some(now.0);
                self.not_mapped |= !session.board_mut().has_sram_at_zero(now);
            }
            Settled::Hit(hit) if hit.kind == HitKind::Instruction => self.note_hit(hit, host),
            Settled::Access { access, .. } => {
                let switches_crystal_on = access.address == RCC_CR
                    && access.kind == AccessKind::Write
                    && access.value & u64::from(HSE_ON) != 0;
                if switches_crystal_on {
                    session.board_mut().crystal_switched_on(now);
                }
                if let Some(following) = &mut self.following {
                    following.access(&access);
                }
            }
            _ => {}
        }
    }

    fn on_stop(
        &mut self,
        session: &mut Session<ChipBoard>,
        stop: Stop,
        host: &mut dyn Host,
    ) -> Option<VirtualNanos> {
        let now = stop.at;
        self.notice_resets(session, now);
        self.run_actions(session, now);
        let Some(started_at) = self.started_at else {
            return self.search(now);
        };
        if now.0 >= Self::stop_ns(started_at, self.tick)
            && self.period(session, now, host).is_break()
        {
            return None;
        }
        let next = Self::stop_ns(started_at, self.tick);
        let action = self.actions.first().map_or(u64::MAX, |(at_ns, _)| *at_ns);
        Some(VirtualNanos(next.min(action.max(now.0 + 1))))
    }
}

//! GCS lines from a seed: everything that the motion layer does, in episodes, without a rest for the controller between.
//!
//! Some lines are refused, and are meant to be: what follows a fault is, and a new target beyond the disk.

use std::f64::consts::TAU;
use std::fmt::Write;

use firmware::mode::Mode;

use crate::random::Random;
use crate::rig::client::Client;
use crate::rig::script::{Script, ScriptError};

/// Just inside the usable disk, mm.
const EDGE_MM: f64 = 79.9;
/// Commands an episode has at least, from its lines and the answers to them: 10 ms.
const LEAST_TICKS: u64 = 200;

/// Enough lines for so many ticks.
///
/// # Errors
/// None in practice: a test parses thousands.
pub fn script(seed: u64, ticks: u64) -> Result<Script, ScriptError> {
    let mut lines = Lines {
        random: Random::new(seed),
        text: "FRF\nWAC ONT? W = 1\nCCL 1 ADVANCED\n".to_owned(),
    };
    for _ in 0..ticks.div_ceil(LEAST_TICKS) {
        lines.episode();
    }
    Script::parse("exercise", &lines.text)
}

/// Ticks after which a line that waits while the servo is off is given up with a stop.
const OFF_PATIENCE: u32 = 4_000;
/// `#24`, and the question for its error.
const STOP: &[u8] = b"\x18ERR?\n";

/// Ends a wait in vain: the stage does not arrive while its servo is off.
#[derive(Debug, Default)]
pub struct Patience {
    off_polls: u32,
}

impl Patience {
    /// What is to be sent besides what the client sends: a stop, when nothing but that ends the wait. It throws away the
    /// `ERR?` that waits behind it. To be called once a tick, after the client was polled.
    pub fn poll(&mut self, client: &Client, mode: Mode) -> &'static [u8] {
        let current = client.current();
        let waits = current.is_some_and(|line| line.text.starts_with("WAC"));
        let in_vain = waits && mode == Mode::Off;
        self.off_polls = if in_vain { self.off_polls + 1 } else { 0 };
        if self.off_polls <= OFF_PATIENCE {
            return b"";
        }
        self.off_polls = 0;
        STOP
    }
}

struct Lines {
    random: Random,
    text: String,
}

impl Lines {
    fn episode(&mut self) {
        // After a fault, of which an encoder may have had one, and with it lost its turns, the episode before is not whole.
        self.line("FLC");
        self.line("FRF");
        self.line("SPA 1 0x19001900 0 1 0x54500110 0 1 0x54500500 0.002");
        match self.whole(0, 11) {
            0 => self.tour(),
            1 | 2 => self.retargets(),
            3 => self.turn_at_the_edge(),
            4 => self.many_turns(),
            5 => self.jog(),
            6 => self.stream(),
            7 => self.waves(),
            8 => self.about_a_point(),
            9 | 10 => self.stops(),
            _ => self.fault(),
        }
    }

    fn tour(&mut self) {
        for _ in 0..self.whole(1, 4) {
            self.target();
            self.rest();
        }
    }

    fn retargets(&mut self) {
        for _ in 0..self.whole(3, 9) {
            self.target();
            self.wait(2, 250);
        }
        self.rest();
    }

    /// Where the pivots are fastest and closest.
    fn turn_at_the_edge(&mut self) {
        let direction = self.within(0.0, TAU);
        let (x, y) = (EDGE_MM * direction.cos(), EDGE_MM * direction.sin());
        self.line(&format!("MOV X {x:.6} Y {y:.6}"));
        self.rest();
        let by = self.within(-400.0, 400.0);
        self.line(&format!("MVR W {by:.6}"));
        self.rest();
    }

    /// As far as commands go, and some other way before that is reached.
    fn many_turns(&mut self) {
        let far = self.within(-3.5e6, 3.5e6);
        let way = self.whole(0, 3);
        self.line(&format!("MOV W {far:.3}"));
        self.wait(100, 600);
        self.line("HLT");
        self.rest();
        self.line(&format!("SPA 1 0x54500110 {way}"));
        self.target();
        self.wait(50, 400);
        self.line("STP");
        self.rest();
        self.line("SPA 1 0x54500110 0");
    }

    fn jog(&mut self) {
        for _ in 0..self.whole(1, 4) {
            let [x, y] = [0, 1].map(|_| self.within(-120.0, 120.0));
            let w = self.within(-300.0, 300.0);
            self.line(&format!("JOG X {x:.4} Y {y:.4} W {w:.4}"));
            self.wait(20, 300);
        }
        match self.whole(0, 2) {
            0 => self.line("JOG X 0 Y 0 W 0"),
            1 => self.line("STP"),
            _ => self.target(),
        }
        self.rest();
    }

    /// A circle from where the stage is, a target at a time.
    fn stream(&mut self) {
        let (cycle_ms, radius_mm) = (self.whole(4, 20), self.within(1.0, 8.0));
        self.line("MOV X 0 Y 0");
        self.rest();
        self.line("SPA 1 0x19001900 1");
        self.line(&format!("SCT T {cycle_ms}"));
        for target in 1..=self.whole(10, 40) {
            let turned = target as f64 * 0.05;
            let (x, y) = (
                radius_mm * (1.0 - turned.cos()),
                radius_mm * (turned - turned.sin()),
            );
            self.line(&format!("MOV X {x:.6} Y {y:.6}"));
            // A line and its answer take about a millisecond.
            self.line(&format!("DEL {}", cycle_ms - 2));
        }
        self.rest();
        self.line("SPA 1 0x19001900 0");
    }

    fn waves(&mut self) {
        let points = 2 * self.whole(250, 500);
        let amplitude_mm = self.within(4.0, 30.0);
        let (half, quarter) = (amplitude_mm / 2.0, points / 4);
        for (table, start) in [(1, 0), (2, quarter)] {
            self.line(&format!(
                "WAV {table} X SIN_P {points} {amplitude_mm:.4} {:.4} {points} {start} {}",
                -half,
                points / 2
            ));
        }
        self.line("WSL 1 1 2 2");
        let cycles = self.whole(1, 3);
        self.line(&format!("WGC 1 {cycles} 2 {cycles}"));
        self.line("WGO 1 1 2 1");
        if self.whole(0, 1) == 0 {
            self.wait(50, 700);
            self.line("HLT");
        }
        self.rest();
    }

    /// A centre of rotation beside the platform's, set where it changes no coordinate.
    fn about_a_point(&mut self) {
        self.line("MOV X 0 Y 0 W 0");
        self.rest();
        let [r, s] = [0, 1].map(|_| self.within(-45.0, 45.0));
        self.line(&format!("SPI R {r:.4} S {s:.4}"));
        for _ in 0..self.whole(1, 4) {
            let w = self.within(-180.0, 180.0);
            self.line(&format!("MVR W {w:.4}"));
            self.wait(50, 400);
        }
        self.line("HLT");
        self.rest();
        self.line("MOV W 0");
        self.rest();
        self.line("SPI R 0 S 0");
    }

    fn stops(&mut self) {
        for _ in 0..self.whole(1, 5) {
            self.target();
            self.wait(2, 300);
            let stop = ["STP", "HLT", "#24"][self.whole(0, 2) as usize];
            self.line(stop);
            if self.whole(0, 1) == 0 {
                self.rest();
            }
        }
        self.rest();
        if self.whole(0, 2) == 0 {
            self.line("SVO X 0");
            self.wait(5, 50);
            self.line("FRF");
            self.rest();
        }
    }

    /// A following error that is allowed too little for the motion it is asked, and other limits after it.
    fn fault(&mut self) {
        self.line("SPA 1 0x54500500 0.00002");
        self.target();
        self.wait(50, 200);
        self.line("FLT?");
        self.line("FLC");
        self.line("SPA 1 0x54500500 0.002");
        self.line("FRF");
        self.rest();
        let speed = self.within(20.0, 200.0);
        self.line(&format!("VLS {speed:.3}"));
        self.tour();
        self.line("VLS 200");
    }

    fn target(&mut self) {
        // Even over the disk, with its edge more often than that.
        let r = EDGE_MM * (self.within(0.0, 1.1).min(1.0)).sqrt();
        let direction = self.within(0.0, TAU);
        let (x, y) = (r * direction.cos(), r * direction.sin());
        let w = self.within(-180.0, 180.0);
        let line = match self.whole(0, 3) {
            0 => format!("MOV X {x:.6} Y {y:.6}"),
            1 => format!("MOV W {w:.6}"),
            _ => format!("MOV X {x:.6} Y {y:.6} W {w:.6}"),
        };
        self.line(&line);
    }

    fn rest(&mut self) {
        self.line("WAC ONT? W = 1");
    }

    fn wait(&mut self, least_ms: u64, most_ms: u64) {
        let ms = self.whole(least_ms, most_ms);
        self.line(&format!("DEL {ms}"));
    }

    fn line(&mut self, line: &str) {
        // A string takes everything.
        let _ = writeln!(self.text, "{line}");
    }

    fn within(&mut self, least: f64, most: f64) -> f64 {
        self.random.between(least, most)
    }

    /// Either end included.
    fn whole(&mut self, least: u64, most: u64) -> u64 {
        least + self.random.bits() % (most - least + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_seeds_give_lines_that_a_controller_understands() {
        for seed in 0..20 {
            let lines = script(seed, 100_000).expect("a script").lines;
            assert!(lines.len() > 5_000, "seed {seed}: {}", lines.len());
        }
    }

    #[test]
    fn a_seed_gives_the_same_lines_again_and_another_gives_others() {
        let [one, again, other] = [7, 7, 8].map(|seed| script(seed, 10_000).expect("a script"));
        assert_eq!(one, again);
        assert_ne!(one, other);
    }
}

//! The controller on a stage without flaws: its own tick and command side, pivots that are always where the setpoint puts
//! them, and encoders that show it. Cheap enough for millions of ticks; nothing here knows any dynamics.

use firmware::control::{Inputs, Outputs};
use firmware::drivers::biss::RawFrame;
use firmware::gcs::Session;
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use firmware::queues::{Command, QueueFull};
use firmware::recorder::{Sample, TickObserver};
use hal_sim::front::ControlLoop;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::machine::devices::biss::{Preamble, encode};
use hal_sim::rig::{ControllerMemory, Rig};
use kinematics::Angle;

/// 48 V at the ADC.
const SUPPLY_COUNTS: u16 = 2979;
/// By how much the brake resistor draws it down, counts: 0.29 V.
const RESISTOR_COUNTS: u16 = 18;

/// What is wrong with the hardware at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trouble {
    /// Emergency stop pressed.
    pub emergency_stop: bool,
    /// No frame of these encoders.
    pub silent: [bool; 3],
    /// Fault pin of the first bridge.
    pub bridge: bool,
    /// No supply.
    pub no_supply: bool,
}

/// A connection: what it has to send, and what it was answered.
#[derive(Default)]
pub struct Connection {
    /// The controller's end of it.
    pub session: Session,
    /// Sent, and not taken yet.
    pub input: Vec<u8>,
    /// Answers.
    pub output: Vec<u8>,
}

/// Keeps the last tick's sample.
#[derive(Default)]
struct Last(Option<Sample>);

impl TickObserver for Last {
    fn observe(&mut self, sample: &Sample) {
        self.0 = Some(sample.clone());
    }
}

/// See the module.
pub struct Ideal {
    /// The controller; its settings are kept in memory.
    pub rig: Rig<'static, ControlLoop>,
    /// The connections.
    pub connections: Vec<Connection>,
    /// What is wrong with the hardware.
    pub trouble: Trouble,
    /// The encoders' last bit changes from tick to tick, as that of any real one does.
    pub flicker: bool,
    /// What the last tick put out.
    pub outputs: Outputs,
    last: Last,
    /// What the encoders show.
    counts: [u32; 3],
    last_bit: u32,
}

impl Ideal {
    /// Just switched on, at the origin, with so many connections.
    #[must_use]
    pub fn new(connections: usize) -> Self {
        let mut parameters = Parameters::REFERENCE;
        // Its motors carry nothing, whatever drives them.
        parameters.supervision.unexplained_current_a = 20.0;
        let (queues, flash) = (
            ControllerMemory::endless().split(),
            SettingsFlash::in_memory(),
        );
        let rig = Rig::new(queues, &parameters, flash, ControlLoop::new);
        let third =
            |i: usize| Angle::from_degrees(-30.0 + 120.0 * i as f64).expect("within a turn");
        let counts = [0, 1, 2].map(|i| rig.front.config.encoders[i].ideal_counts_at(third(i)));
        Self {
            rig,
            connections: (0..connections).map(|_| Connection::default()).collect(),
            trouble: Trouble::default(),
            flicker: false,
            outputs: Outputs::default(),
            last: Last::default(),
            counts,
            last_bit: 0,
        }
    }

    /// One tick, and a turn of the command side for every connection.
    pub fn tick(&mut self) {
        let before = self.last.0.take();
        self.rig.front.inputs = self.inputs();
        self.outputs = self.rig.tick(&mut self.last);
        self.follow(before.as_ref());
        self.last_bit = u32::from(self.flicker) & (self.last_bit ^ 1);
        for number in 0..self.connections.len() {
            self.serve(number);
        }
    }

    /// So many ticks.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    /// Has a connection carry out what it has sent.
    pub fn serve(&mut self, number: usize) {
        let connection = &mut self.connections[number];
        let taken = connection.session.receive(&connection.input);
        connection.input.drain(..taken);
        // Writing to a vector does not fail.
        let _ = (self.rig).service(&mut connection.session, &mut connection.output);
        self.rig.keep();
        if self.rig.restart_if_wanted() {
            for connection in &mut self.connections {
                connection.session.start_again();
            }
        }
    }

    /// Sends to a connection, lets a few ticks pass, and gives what it has been answered.
    pub fn ask(&mut self, number: usize, line: &[u8]) -> Vec<u8> {
        self.connections[number].output.clear();
        self.connections[number].input.extend_from_slice(line);
        self.run(8);
        std::mem::take(&mut self.connections[number].output)
    }

    /// Sends a command past the command side.
    ///
    /// # Errors
    /// [`QueueFull`]
    pub fn send(&mut self, command: Command) -> Result<(), QueueFull> {
        self.rig.command_queues.send(command)
    }

    /// What the last tick computed, once one has run.
    #[must_use]
    pub fn sample(&self) -> Option<&Sample> {
        self.last.0.as_ref()
    }

    fn inputs(&self) -> Inputs {
        let frame = |i: usize| {
            if self.trouble.silent[i] {
                RawFrame::MISSING
            } else {
                let bits = encode(
                    self.counts[i] ^ self.last_bit,
                    false,
                    false,
                    Preamble::DEFAULT,
                );
                RawFrame(bits.to_be_bytes())
            }
        };
        Inputs {
            frames: [frame(0), frame(1), frame(2)],
            bridge_fault: [self.trouble.bridge, false, false],
            emergency_stop: self.trouble.emergency_stop,
            current_counts: [0; 3],
            supply_counts: match (self.trouble.no_supply, self.outputs.brake_resistor) {
                (true, _) => 0,
                (false, true) => SUPPLY_COUNTS - RESISTOR_COUNTS,
                (false, false) => SUPPLY_COUNTS,
            },
            tick_cycles: 0,
            program_damaged: false,
            late: false,
        }
    }

    /// The pivots go where they are sent; by the next latch they have gone on as fast as before.
    fn follow(&mut self, before: Option<&Sample>) {
        let Some(now) = self.last.0.as_ref().filter(|now| is_held(now)) else {
            return;
        };
        for i in 0..3 {
            let step = before
                .filter(|before| is_held(before))
                .map_or(Angle::ZERO, |before| {
                    now.pivot_setpoints[i] - before.pivot_setpoints[i]
                });
            self.counts[i] =
                self.rig.front.config.encoders[i].ideal_counts_at(now.pivot_setpoints[i] + step);
        }
    }
}

/// Whether the servo was on.
#[must_use]
pub fn is_held(sample: &Sample) -> bool {
    matches!(sample.mode, Mode::Holding | Mode::Moving | Mode::Stopping)
}

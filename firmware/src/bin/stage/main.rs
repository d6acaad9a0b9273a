//! The controller on its board, an STM32F427 at 168 MHz. Pins, clocks and interrupts, nothing else: what the controller does is
//! the library's.
//!
//! The same for every board; the boards' roots (`reference.rs`, `nucleo.rs`) differ in the pins: `firmware/PINS.md`.
//!
//! # Timeline
//!
//! ```text
//!  latch            tick T                                T + 32 us  latch            tick T + 50 us
//!  |----- 15 us ----|------------ 32 us ---------------------|- 3 us -|----- 15 us -----|
//!  | 12.2 us SPI    | control task                           | duty of T acts from here
//!  | 7.6 us ADC     | what it takes: `cargo chip-cycles`
//!  |- 3 us -|----- 25 us -----------|---------- 25 us -------|----- 25 us --- PWM periods
//! ```
//!
//! From the encoders' latch to the PWM period in which the answer acts: 47 us (`timeline`). A duty takes over with a whole
//! PWM period. Phase and sleep pins change inside the tick: the enable pulse stands at the beginning of the period, so with
//! less than a third of full duty, as at every change of sign in normal operation, it is over by then and the phase
//! does not matter until the new duty comes.
//!
//! # Memory
//!
//! The latch, the tick and all that they call run from RAM (`loop_memory`); `memory.x` has the map.
//!
//! # Priorities
//!
//! The latch has 1 in the hardware, the tick 2: a latch comes in its time, whatever a tick still does after its duties
//! for the recorders and the command side. Above them, at 0, are only the exceptions that end the program
//! (`fault_handlers`): processor faults, the crystal's failure, and the window watchdog, which the tick feeds.
//! Below them, at 15 in the hardware, runs what records the ticks (`samples`): rows of the recorders and the trace are
//! written in what the tick leaves of its period, and the independent watchdog is fed. All the rest, command interface,
//! settings, log, and a look whether the program is still whole, is the idle task. Between them are lock-free queues and atomics. Nothing masks interrupts after start-up but a tick
//! that reads its sensors, when no latch is due: a log frame that meets another one, or a full buffer, is dropped instead.
//! The independent watchdog is fed only while the idle task gives signs of life.

/// The tasks.
#[rtic::app(device = stm32f4xx_hal::pac, peripherals = true)]
mod app {
    use crate::{
        board::{Board, BrakeResistorSwitch, Bridges, Sensors},
        flash::SettingsFlash,
        identity,
        latch::LatchTimer,
        latch_timing,
        marks::{BoardLamps, LatchMark, TickMark},
        program_watch::{self, ProgramWatch},
        pwm::{PwmTimer, TickEvent},
        restart,
        retained_memory::RETAINED_MEMORY,
        samples::{SampleQueue, SampleReceiver, SampleSender},
        self_test::StageBoard,
        serial::{Receiver, Transmitter},
        tick_timing::{TickTiming, count_latch},
        trace::{self, TRACE, TraceWriter},
        watchdog,
    };
    use core::mem::MaybeUninit;
    use firmware::control::config::Config;
    use firmware::control::{Inputs, State, TickObservers, tick_and_drive};
    use firmware::fault::FaultKind;
    use firmware::gcs::{Identity, Interpreter, Session};
    use firmware::parameters::Parameters;
    use firmware::queues::{CommandQueues, Queues, TickQueues};
    use firmware::recorder::TickObserver;
    use firmware::settings_store::SettingsStore;
    use stm32f4xx_hal::pac::Interrupt;

    /// What is in force until settings have been stored.
    const PARAMETERS: Parameters = Parameters::REFERENCE.uncommissioned();

    #[shared]
    struct Shared {
        sensors: Sensors,
    }

    #[local]
    struct Local {
        latch_timer: LatchTimer,
        tick_event: TickEvent,
        latch_mark: LatchMark,
        tick_mark: TickMark,
        lamps: BoardLamps,
        pwm: PwmTimer,
        bridges: Bridges,
        brake_resistor: BrakeResistorSwitch,
        config: &'static mut Config,
        state: &'static mut State,
        sample_sender: SampleSender,
        sample_receiver: SampleReceiver,
        observers: Option<TickObservers<'static>>,
        trace_writer: TraceWriter,
        tick_timing: TickTiming,
        tick_queues: TickQueues<'static>,
        interpreter: &'static mut Interpreter,
        session: &'static mut Session,
        settings_store: SettingsStore<SettingsFlash>,
        command_queues: CommandQueues<'static>,
        receiver: Receiver,
        transmitter: Transmitter,
    }

    // What is large is written to where it stays: in `Local` it would stand on the stack several times on its way.
    #[init(local = [
        queues: Queues = Queues::new(),
        #[unsafe(link_section = ".ccm.samples")]
        samples_place: MaybeUninit<SampleQueue> = MaybeUninit::uninit(),
        #[unsafe(link_section = ".ccm.config")]
        config_place: MaybeUninit<Config> = MaybeUninit::uninit(),
        panel_place: MaybeUninit<Interpreter> = MaybeUninit::uninit(),
        #[unsafe(link_section = ".ccm.session")]
        session_place: MaybeUninit<Session> = MaybeUninit::uninit(),
        #[unsafe(link_section = ".ccm.state")]
        state_place: MaybeUninit<State> = MaybeUninit::uninit(),
        #[unsafe(link_section = ".ccm.serial")]
        serial_place: MaybeUninit<identity::Serial> = MaybeUninit::uninit(),
    ])]
    fn init(context: init::Context) -> (Shared, Local) {
        let Board {
            latch_timer,
            tick_event,
            sensors,
            latch_mark,
            tick_mark,
            lamps,
            pwm,
            bridges,
            brake_resistor,
            receiver,
            transmitter,
            flash,
            watchdogs,
            reset_cause,
            crash,
            without_crystal,
            self_check,
            mut rcc,
        } = Board::new(context.device);
        TRACE.set_reset_cause(reset_cause);
        defmt::info!("start after {}", reset_cause);
        let mut core = context.core;
        let (mut tick_queues, mut command_queues) =
            context.local.queues.split_with_retained(&RETAINED_MEMORY);
        let identity = Identity {
            serial: context.local.serial_place.write(identity::serial()),
            version: env!("CARGO_PKG_VERSION"),
        };
        let interpreter = place_interpreter(context.local.panel_place, identity);
        interpreter.set_board(&StageBoard);
        match reset_cause.told() {
            (cause, true) => interpreter.set_wanted_start(cause),
            (cause, false) => interpreter.set_start_cause(cause),
        }
        for crash in crash.into_iter().flatten() {
            defmt::error!("{}", defmt::Display2Format(&crash));
            interpreter.add_crash(crash);
        }
        self_check
            .notices()
            .for_each(|notice| interpreter.add_board_notice(notice));
        // Before anything can move.
        let mut settings_store = SettingsStore::new(flash);
        let unusable_settings =
            settings_store.restore(&mut interpreter.contents(&mut command_queues.trial));
        let damaged = self_check.image_damaged.then_some(FaultKind::ImageDamaged);
        let no_crystal = without_crystal.then_some(FaultKind::CrystalFailed);
        let config = (context.local.config_place).write(Config::new(interpreter.parameters()));
        // The one that stays first.
        let state = match damaged.or(no_crystal).or(unusable_settings) {
            None => State::new(),
            Some(problem) => State::with_fault(problem),
        }
        .with_motor_heat(RETAINED_MEMORY.motor_heat())
        .with_learnt(config);
        let samples = context.local.samples_place.write(SampleQueue::new());
        let (sample_sender, sample_receiver) = samples.split();
        watchdogs.start(&mut rcc);
        let state = context.local.state_place.write(state);
        let session = context.local.session_place.write(Session::new());
        let mut local = Local {
            latch_timer,
            tick_event,
            latch_mark,
            tick_mark,
            lamps,
            pwm,
            bridges,
            brake_resistor,
            config,
            state,
            sample_sender: SampleSender(sample_sender),
            sample_receiver,
            // They run behind the tick.
            observers: tick_queues.observers.take(),
            trace_writer: TraceWriter::default(),
            tick_timing: TickTiming::new(&mut core.DCB, &mut core.DWT),
            tick_queues,
            interpreter,
            session,
            settings_store,
            command_queues,
            receiver,
            transmitter,
        };
        // Last: everything that takes time is done, the first latch comes 35 us from here, and no interrupt before this ends.
        local.latch_timer.start_with(&mut local.pwm);
        (Shared { sensors }, local)
    }

    /// In a frame of its own: what it makes on the stack is gone before the settings are read.
    #[inline(never)]
    fn place_interpreter(
        place: &'static mut MaybeUninit<Interpreter>,
        identity: Identity,
    ) -> &'static mut Interpreter {
        place.write(Interpreter::new(&PARAMETERS, identity))
    }

    /// Latches the encoders, starts the conversions, arms the tick.
    #[task(binds = TIM3, priority = 15, shared = [sensors], local = [latch_timer, tick_event, latch_mark])]
    fn latch(mut context: latch::Context) {
        let latch_timer = context.local.latch_timer;
        latch_timer.acknowledge();
        count_latch();
        let latch_mark = context.local.latch_mark;
        context.shared.sensors.lock(|sensors| {
            sensors.encoders.latch();
            latch_timing::record(latch_timer.counts());
            // Not before: the latch's time is the encoders'.
            latch_mark.set_high();
            sensors.analog.start();
        });
        context.local.tick_event.arm();
        latch_mark.set_low();
        // The acknowledgement has arrived before the core looks for further interrupts (erratum 838869).
        cortex_m::asm::dsb();
    }

    /// The control task, every 50 us. Duties that are written more than 32 us after its event miss their PWM period: it
    /// counts as late. The next latch interrupts what it does after that; if all of it takes more than 50 us the next tick
    /// comes late, and if it never ends, the watchdog resets the chip.
    #[task(
        binds = TIM1_CC, priority = 14, shared = [sensors],
        local = [pwm, tick_mark, bridges, brake_resistor, config, state, tick_queues, sample_sender, tick_timing]
    )]
    fn control(mut context: control::Context) {
        let (pwm, bridges) = (context.local.pwm, context.local.bridges);
        let (brake_resistor, tick_mark) = (context.local.brake_resistor, context.local.tick_mark);
        tick_mark.set_high();
        pwm.disarm_tick();
        let (tick_cycles, late) = context.local.tick_timing.begin(pwm.counts_since_tick());
        // The latch is 35 us off: nobody waits for this.
        let (frames, counts) = (context.shared.sensors)
            .lock(|sensors| (sensors.encoders.frames(), sensors.analog.counts()));
        let cut = pwm.take_break();
        let inputs = Inputs {
            frames,
            bridge_fault: bridges.faults(),
            emergency_stop: cut,
            program_damaged: program_watch::is_damaged(),
            current_counts: counts.current,
            supply_counts: counts.supply,
            tick_cycles,
            late,
        };
        tick_and_drive(
            context.local.config,
            context.local.state,
            &inputs,
            context.local.tick_queues,
            |outputs| {
                bridges.set(outputs.duty, outputs.awake);
                brake_resistor.set(outputs.brake_resistor);
                // Not in the tick that is told of a break: the old duty would act for the rest of the period.
                pwm.connect(outputs.awake && !cut);
                tick_mark.set_low();
                context.local.tick_timing.end();
                // What follows has no deadline.
                trace::mark_end_of_tick();
            },
            |_, sample| context.local.sample_sender.observe(sample),
        );
        watchdog::feed_window();
        rtic::pend(Interrupt::CRYP);
        // The interrupt's acknowledgement has arrived before the core looks whether there is one (erratum 838869).
        cortex_m::asm::dsb();
        trace::mark_end_of_handler();
    }

    /// Records the tick that has just ended and feeds the independent watchdog, in what it leaves of the period: below latch and tick, above the command
    /// side. Bound to the interrupt of a peripheral that the chip does not have.
    #[task(binds = CRYP, priority = 1, local = [sample_receiver, observers, trace_writer])]
    fn observe(context: observe::Context) {
        let local = context.local;
        // Looked at where it lies: it is too long to be moved.
        while let Some(sample) = local.sample_receiver.peek() {
            if let Some(observers) = local.observers {
                observers.observe(sample);
            }
            // Last: whoever sees the tick there finds it recorded.
            local.trace_writer.observe(sample);
            let _ = local.sample_receiver.dequeue();
        }
        watchdog::feed();
        crate::tick_timing::mark_recorded();
    }

    /// The command interface and the settings.
    #[idle(local = [interpreter, session, settings_store, command_queues, receiver, transmitter, lamps])]
    fn idle(context: idle::Context) -> ! {
        let local = context.local;
        let mut received = 0u32;
        let mut program = ProgramWatch::new();
        loop {
            if local.receiver.poll() {
                local.session.lose();
            }
            local.receiver.pass_to(|bytes| {
                let taken = local.session.receive(bytes);
                received = received.wrapping_add(taken as u32);
                taken
            });
            local.session.set_room(local.transmitter.room());
            let Ok(()) =
                local
                    .interpreter
                    .service(local.session, local.command_queues, local.transmitter);
            TRACE.record_service(received, local.interpreter.tick() as u32);
            local.transmitter.send();
            local.lamps.show(local.interpreter.lamps());
            let trial = &mut local.command_queues.trial;
            (local.settings_store).store_pending(&mut local.interpreter.contents(trial));
            if local.interpreter.wants_restart() {
                restart::now();
            }
            program.step();
            watchdog::note_alive();
            cortex_m::asm::wfi();
        }
    }
}

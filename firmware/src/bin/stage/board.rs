//! The board: every peripheral configured and handed to its owner.

use crate::{
    analog::Analog,
    clocks::{self, Clocks},
    crash, debug, dma,
    encoders::Encoders,
    flash::SettingsFlash,
    latch::LatchTimer,
    marks::{BoardLamps, LatchMark, TickMark},
    oscillator,
    pin_list::Ports,
    pins::{self, Pins},
    pwm::{self, PwmChannel, PwmTimer, TickEvent},
    reset_cause::ResetCause,
    self_check::SelfCheck,
    serial::{self, Port as _, Receiver, Transmitter},
    watchdog::Watchdogs,
};
use core::convert::Infallible;
use embedded_hal::digital::{InputPin, OutputPin};
use firmware::drivers::bridge::{Bridge, BridgeError, Duty};
use firmware::gcs::Crash;
use stm32f4xx_hal::{
    gpio::{Input, Output, Pin, PinPull, PinSpeed, Pull, Speed},
    pac,
    rcc::Rcc,
};

/// Where the sleep pins of all three bridges are set low, and by which word: `GPIOD_BSRR`, for whoever has nothing else
/// left.
pub const SLEEP_PINS_LOW: (u32, u32) = (0x4002_0C18, 0b111 << (16 + 4));
/// They are these on every board.
const _: fn(pins::Sleep1<Output>) -> Pin<'D', 4, Output> = |pin| pin;
const _: fn(pins::Sleep2<Output>) -> Pin<'D', 5, Output> = |pin| pin;
const _: fn(pins::Sleep3<Output>) -> Pin<'D', 6, Output> = |pin| pin;

/// Lets all motors coast, from wherever the program has failed.
pub fn let_motors_coast() {
    // SAFETY: for use when nothing else runs any more; the word clears three pins.
    let port = unsafe { &*pac::GPIOD::ptr() };
    port.bsrr().write(|w| unsafe { w.bits(SLEEP_PINS_LOW.1) });
}

/// What is measured: started by the latch, read by the tick.
pub struct Sensors {
    /// The encoders.
    pub encoders: Encoders,
    /// Currents and supply.
    pub analog: Analog,
}

/// Everything.
pub struct Board {
    /// The latch's timer.
    pub latch_timer: LatchTimer,
    /// What the latch arms the tick by.
    pub tick_event: TickEvent,
    /// What is measured.
    pub sensors: Sensors,
    /// Where the latch is, for a scope.
    pub latch_mark: LatchMark,
    /// Where the tick is.
    pub tick_mark: TickMark,
    /// The lamps.
    pub lamps: BoardLamps,
    /// The tick's timer.
    pub pwm: PwmTimer,
    /// The bridges.
    pub bridges: Bridges,
    /// Bytes of the command interface.
    pub receiver: Receiver,
    /// The switch of the brake resistor.
    pub brake_resistor: BrakeResistorSwitch,
    /// Answers of the command interface.
    pub transmitter: Transmitter,
    /// Where settings are kept.
    pub flash: SettingsFlash,
    /// The watchdogs, with the time-out of the start-up.
    pub watchdogs: Watchdogs,
    /// Why the chip started.
    pub reset_cause: ResetCause,
    /// How the program ended before.
    pub crash: [Option<Crash>; 3],
    /// The crystal did not start.
    pub without_crystal: bool,
    /// What the chip says of itself.
    pub self_check: SelfCheck,
    /// Clocks of what is switched on later.
    pub rcc: Rcc,
}

type Axis1 = Bridge<PwmChannel<1>, pins::Phase1<Output>, pins::Sleep1<Output>, pins::Fault1<Input>>;
type Axis2 = Bridge<PwmChannel<2>, pins::Phase2<Output>, pins::Sleep2<Output>, pins::Fault2<Input>>;
type Axis3 = Bridge<PwmChannel<3>, pins::Phase3<Output>, pins::Sleep3<Output>, pins::Fault3<Input>>;

/// The switch of the brake resistor.
pub struct BrakeResistorSwitch(pins::BrakeResistor<Output>);

impl BrakeResistorSwitch {
    /// On or off.
    #[inline(always)]
    pub fn set(&mut self, on: bool) {
        self.0.set_state(on.into());
    }
}

/// The three bridges, pivot 1 first.
pub struct Bridges(Axis1, Axis2, Axis3);

impl Bridges {
    /// Which bridges report a fault.
    #[inline(always)]
    pub fn faults(&mut self) -> [bool; 3] {
        let Ok(faults) = (|| {
            Ok::<_, Infallible>([
                self.0.reports_fault()?,
                self.1.reports_fault()?,
                self.2.reports_fault()?,
            ])
        })();
        faults
    }

    /// Drives all three, or lets the motors coast.
    #[inline(always)]
    pub fn set(&mut self, duty: [Duty; 3], awake: bool) {
        set_axis(&mut self.0, duty[0], awake);
        set_axis(&mut self.1, duty[1], awake);
        set_axis(&mut self.2, duty[2], awake);
    }
}

#[inline(always)]
fn set_axis<const N: u8, D, S, F>(
    bridge: &mut Bridge<PwmChannel<N>, D, S, F>,
    duty: Duty,
    awake: bool,
) where
    D: OutputPin<Error = Infallible>,
    S: OutputPin<Error = Infallible>,
    F: InputPin,
{
    let done = if awake {
        bridge.drive(duty)
    } else {
        bridge.coast()
    };
    match done {
        Ok(()) => {}
        Err(BridgeError::Pwm(never) | BridgeError::Pin(never)) => match never {},
    }
}

impl Board {
    /// Brings the board up. The timers stand still until [`LatchTimer::start_with`].
    pub fn new(mut peripherals: pac::Peripherals) -> Self {
        let watchdogs = Watchdogs::new(peripherals.IWDG, peripherals.WWDG);
        let crash = crash::take();
        let reset_cause = ResetCause::take(&mut peripherals.RCC, crash[0]);
        let Clocks {
            mut rcc,
            without_crystal,
        } = clocks::start(peripherals.RCC, pins::CLOCK);
        debug::halt_stops_the_motors(&peripherals.DBGMCU);
        let self_check = SelfCheck::new(&peripherals.DBGMCU, &peripherals.FLASH);
        oscillator::watch(&peripherals.TIM5, &mut rcc);
        let streams = dma::split(
            peripherals.DMA1,
            peripherals.DMA2,
            pins::SerialPort::STREAMS,
            &mut rcc,
        );

        let ports = (
            peripherals.GPIOA,
            peripherals.GPIOB,
            peripherals.GPIOC,
            peripherals.GPIOD,
            peripherals.GPIOE,
        );
        let pins = Pins::new(Ports::new(ports, &mut rcc));

        // Bank 2 of the flash is read wrongly while this pin floats, on silicon before revision 3 (erratum 2.2.14).
        pins.held.into_push_pull_output();
        let encoders = Encoders::new(
            (peripherals.SPI1, peripherals.SPI2, peripherals.SPI3),
            [
                (streams.spi1_receive, streams.spi1_transmit),
                (streams.spi2_receive, streams.spi2_transmit),
                (streams.spi3_receive, streams.spi3_transmit),
            ],
            &mut rcc,
        );
        // The ports are set up and hold their clocks high: no edge reaches an encoder. The fastest slope: with a slower one
        // the last bit of a byte may be lost (erratum 2.12.4).
        let fastest = Speed::VeryHigh;
        pins.encoder_data_1.connect();
        pins.encoder_data_2.connect();
        pins.encoder_data_3.connect();
        (pins.encoder_clock_1.connect().speed(fastest)).set_internal_resistor(Pull::Up);
        (pins.encoder_clock_2.connect().speed(fastest)).set_internal_resistor(Pull::Up);
        (pins.encoder_clock_3.connect().speed(fastest)).set_internal_resistor(Pull::Up);

        pins.current_1.into_analog();
        pins.current_2.into_analog();
        pins.current_3.into_analog();
        pins.supply.into_analog();
        let analog = Analog::new(
            peripherals.ADC1,
            &peripherals.ADC_COMMON,
            pins::channels(),
            &mut rcc,
        );

        pins.serial_transmit.connect();
        (pins.serial_receive.connect()).set_internal_resistor(Pull::Up);
        let serial_streams = (streams.serial_receive, streams.serial_transmit);
        // SAFETY: the command line's port, which nothing else takes: its name is the board's to say.
        let port = unsafe { pins::SerialPort::steal() };
        let (receiver, transmitter) = serial::configure(port, serial_streams, &mut rcc);

        // The break input is connected before the timer that it cuts, the timer before its outputs.
        (pins.emergency_stop.connect()).set_internal_resistor(Pull::Down);
        let (pwm, tick_event, (pwm1, pwm2, pwm3)) = pwm::configure(peripherals.TIM1, &mut rcc);
        pins.pwm_1.connect();
        pins.pwm_2.connect();
        pins.pwm_3.connect();
        let latch_timer = LatchTimer::new(peripherals.TIM3, &mut rcc);

        let bridges = Bridges(
            axis(pwm1, pins.phase_1, pins.sleep_1, pins.fault_1),
            axis(pwm2, pins.phase_2, pins.sleep_2, pins.fault_2),
            axis(pwm3, pins.phase_3, pins.sleep_3, pins.fault_3),
        );
        Self {
            latch_timer,
            tick_event,
            sensors: Sensors { encoders, analog },
            latch_mark: pins.latch_mark.into_push_pull_output(),
            tick_mark: pins.tick_mark.into_push_pull_output(),
            lamps: BoardLamps {
                status: pins.status_lamp.into_push_pull_output(),
                drive: pins.drive_lamp.into_push_pull_output(),
                fault: pins.fault_lamp.into_push_pull_output(),
            },
            pwm,
            bridges,
            brake_resistor: BrakeResistorSwitch(pins.brake_resistor.into_push_pull_output()),
            receiver,
            transmitter,
            flash: SettingsFlash::new(peripherals.FLASH, peripherals.PWR, &self_check, &mut rcc),
            watchdogs,
            reset_cause,
            crash,
            without_crystal,
            self_check,
            rcc,
        }
    }
}

type BridgeOf<const N: u8, D, S, F> = Bridge<PwmChannel<N>, D, S, F>;

fn axis<
    const N: u8,
    const DP: char,
    const D: u8,
    const SP: char,
    const S: u8,
    const FP: char,
    const F: u8,
>(
    pwm: PwmChannel<N>,
    phase: Pin<DP, D>,
    sleep: Pin<SP, S>,
    fault: Pin<FP, F>,
) -> BridgeOf<N, Pin<DP, D, Output>, Pin<SP, S, Output>, Pin<FP, F, Input>> {
    let bridge = Bridge::new(
        pwm,
        phase.into_push_pull_output(),
        sleep.into_push_pull_output(),
        fault.into_pull_up_input(),
    );
    match bridge {
        Ok(bridge) => bridge,
        Err(BridgeError::Pwm(never) | BridgeError::Pin(never)) => match never {},
    }
}

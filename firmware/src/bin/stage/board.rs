//! The board: every peripheral configured and handed to its owner.

use crate::{
    analog::Analog,
    clocks::{self, Clocks},
    crash, debug, dma,
    encoders::Encoders,
    flash::SettingsFlash,
    latch::LatchTimer,
    pwm::{self, PwmChannel, PwmTimer, TickEvent},
    reset_cause::ResetCause,
    self_check::SelfCheck,
    serial::{self, Receiver, Transmitter},
    watchdog::Watchdogs,
};
use core::convert::Infallible;
use embedded_hal::digital::{InputPin, OutputPin};
use firmware::drivers::bridge::{Bridge, BridgeError, Duty};
use firmware::gcs::Crash;
use stm32f4xx_hal::{
    gpio::{Input, Output, Pin, Pull, Speed},
    pac,
    prelude::*,
    rcc::Rcc,
};

/// Where the sleep pins of all three bridges are set low, and by which word: `GPIOD_BSRR`, for whoever has nothing else
/// left.
pub const SLEEP_PINS_LOW: (u32, u32) = (0x4002_0C18, 0b111 << (16 + 4));

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
    /// Counts of the latch's timer at which the encoders' ports were let go last.
    pub latch_counts: u16,
}

/// Everything.
pub struct Board {
    /// The latch's timer.
    pub latch_timer: LatchTimer,
    /// What the latch arms the tick by.
    pub tick_event: TickEvent,
    /// What is measured.
    pub sensors: Sensors,
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
    pub crash: [Option<Crash>; 2],
    /// The crystal did not start.
    pub without_crystal: bool,
    /// What the chip says of itself.
    pub self_check: SelfCheck,
    /// Clocks of what is switched on later.
    pub rcc: Rcc,
}

type Axis<const CHANNEL: u8, const DIRECTION: u8, const SLEEP: u8, const FAULT: u8> = Bridge<
    PwmChannel<CHANNEL>,
    Pin<'D', DIRECTION, Output>,
    Pin<'D', SLEEP, Output>,
    Pin<'D', FAULT, Input>,
>;

/// The switch of the brake resistor.
pub struct BrakeResistorSwitch(Pin<'D', 3, Output>);

impl BrakeResistorSwitch {
    /// On or off.
    #[inline(always)]
    pub fn set(&mut self, on: bool) {
        self.0.set_state(on.into());
    }
}

/// The three bridges, pivot 1 first.
pub struct Bridges(Axis<1, 0, 4, 8>, Axis<2, 1, 5, 9>, Axis<3, 2, 6, 10>);

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
        } = clocks::start(peripherals.RCC);
        debug::halt_stops_the_motors(&peripherals.DBGMCU);
        let self_check = SelfCheck::new(&peripherals.DBGMCU, &peripherals.FLASH);
        let streams = dma::split(peripherals.DMA1, peripherals.DMA2, &mut rcc);

        let port_a = peripherals.GPIOA.split(&mut rcc);
        let port_b = peripherals.GPIOB.split(&mut rcc);
        let port_c = peripherals.GPIOC.split(&mut rcc);
        let port_d = peripherals.GPIOD.split(&mut rcc);
        let port_e = peripherals.GPIOE.split(&mut rcc);

        // Bank 2 of the flash is read wrongly while this pin floats, on silicon before revision 3 (erratum 2.2.14).
        port_a.pa12.into_push_pull_output();
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
        port_a.pa6.into_alternate::<5>();
        let mut clock = port_a.pa5.into_alternate::<5>();
        clock.set_speed(fastest);
        clock.internal_pull_up(true);
        port_b.pb14.into_alternate::<5>();
        let mut clock = port_b.pb13.into_alternate::<5>();
        clock.set_speed(fastest);
        clock.internal_pull_up(true);
        port_c.pc11.into_alternate::<6>();
        let mut clock = port_c.pc10.into_alternate::<6>();
        clock.set_speed(fastest);
        clock.internal_pull_up(true);

        port_c.pc0.into_analog();
        port_c.pc1.into_analog();
        port_c.pc2.into_analog();
        port_c.pc3.into_analog();
        let analog = Analog::new(peripherals.ADC1, &peripherals.ADC_COMMON, &mut rcc);

        port_a.pa9.into_alternate::<7>();
        port_a.pa10.into_alternate::<7>().internal_pull_up(true);
        let (receiver, transmitter) = serial::configure(
            peripherals.USART1,
            (streams.usart1_receive, streams.usart1_transmit),
            &mut rcc,
        );

        // The break input is connected before the timer that it cuts, the timer before its outputs.
        port_e
            .pe15
            .into_alternate::<1>()
            .set_internal_resistor(Pull::Down);
        let (pwm, tick_event, (pwm1, pwm2, pwm3)) = pwm::configure(peripherals.TIM1, &mut rcc);
        port_e.pe9.into_alternate::<1>();
        port_e.pe11.into_alternate::<1>();
        port_e.pe13.into_alternate::<1>();
        let latch_timer = LatchTimer::new(peripherals.TIM3, &mut rcc);

        let bridges = Bridges(
            axis(pwm1, port_d.pd0, port_d.pd4, port_d.pd8),
            axis(pwm2, port_d.pd1, port_d.pd5, port_d.pd9),
            axis(pwm3, port_d.pd2, port_d.pd6, port_d.pd10),
        );
        Self {
            latch_timer,
            tick_event,
            sensors: Sensors {
                encoders,
                analog,
                latch_counts: 0,
            },
            pwm,
            bridges,
            brake_resistor: BrakeResistorSwitch(port_d.pd3.into_push_pull_output()),
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

fn axis<const N: u8, const D: u8, const S: u8, const F: u8>(
    pwm: PwmChannel<N>,
    direction: Pin<'D', D>,
    sleep: Pin<'D', S>,
    fault: Pin<'D', F>,
) -> Axis<N, D, S, F> {
    let bridge = Bridge::new(
        pwm,
        direction.into_push_pull_output(),
        sleep.into_push_pull_output(),
        fault.into_pull_up_input(),
    );
    match bridge {
        Ok(bridge) => bridge,
        Err(BridgeError::Pwm(never) | BridgeError::Pin(never)) => match never {},
    }
}

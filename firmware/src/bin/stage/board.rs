//! The board: every peripheral configured and handed to its owner.

use crate::{
    analog::Analog,
    clocks, dma,
    encoders::Encoders,
    flash::SettingsFlash,
    latch::LatchTimer,
    pwm::{self, PwmChannel, PwmTimer},
    reset_cause::ResetCause,
    serial::{self, Receiver, Transmitter},
};
use core::convert::Infallible;
use embedded_hal::digital::{InputPin, OutputPin};
use firmware::drivers::bridge::{Bridge, BridgeError, Duty};
use stm32f4xx_hal::{
    gpio::{Input, Output, Pin, Pull, Speed},
    pac,
    prelude::*,
};

/// What the latch and the tick work on.
pub struct Loop {
    /// The latch's timer.
    pub latch_timer: LatchTimer,
    /// The tick's timer.
    pub pwm: PwmTimer,
    /// The encoders.
    pub encoders: Encoders,
    /// Currents and supply.
    pub analog: Analog,
    /// The bridges.
    pub bridges: Bridges,
}

/// Everything.
pub struct Board {
    /// What the loop works on.
    pub control: Loop,
    /// Bytes of the command interface.
    pub receiver: Receiver,
    /// Answers of the command interface.
    pub transmitter: Transmitter,
    /// Where settings are kept.
    pub flash: SettingsFlash,
    /// The watchdog, which does not run yet.
    pub watchdog: pac::IWDG,
    /// Why the chip started.
    pub reset_cause: ResetCause,
}

type Axis<const CHANNEL: u8, const DIRECTION: u8, const SLEEP: u8, const FAULT: u8> = Bridge<
    PwmChannel<CHANNEL>,
    Pin<'D', DIRECTION, Output>,
    Pin<'D', SLEEP, Output>,
    Pin<'D', FAULT, Input>,
>;

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
        let reset_cause = ResetCause::take(&mut peripherals.RCC);
        let mut rcc = clocks::start(peripherals.RCC);
        let streams = dma::split(peripherals.DMA1, peripherals.DMA2, &mut rcc);

        let port_a = peripherals.GPIOA.split(&mut rcc);
        let port_b = peripherals.GPIOB.split(&mut rcc);
        let port_c = peripherals.GPIOC.split(&mut rcc);
        let port_d = peripherals.GPIOD.split(&mut rcc);
        let port_e = peripherals.GPIOE.split(&mut rcc);

        port_a.pa5.into_alternate::<5>().set_speed(Speed::High);
        port_a.pa6.into_alternate::<5>();
        port_b.pb13.into_alternate::<5>().set_speed(Speed::High);
        port_b.pb14.into_alternate::<5>();
        port_c.pc10.into_alternate::<6>().set_speed(Speed::High);
        port_c.pc11.into_alternate::<6>();
        let encoders = Encoders::new(
            (peripherals.SPI1, peripherals.SPI2, peripherals.SPI3),
            [
                (streams.spi1_receive, streams.spi1_transmit),
                (streams.spi2_receive, streams.spi2_transmit),
                (streams.spi3_receive, streams.spi3_transmit),
            ],
            &mut rcc,
        );

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
        let (pwm, (pwm1, pwm2, pwm3)) = pwm::configure(peripherals.TIM1, &mut rcc);
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
            control: Loop {
                latch_timer,
                pwm,
                encoders,
                analog,
                bridges,
            },
            receiver,
            transmitter,
            flash: SettingsFlash::new(peripherals.FLASH),
            watchdog: peripherals.IWDG,
            reset_cause,
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

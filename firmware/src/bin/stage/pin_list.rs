//! What a board's file in `board_pins/` becomes: types and pins for [`board`](crate::board).
//!
//! The same list becomes the table of pins in `firmware/PINS.md`, by a test that has another macro of this name. That a pin has the
//! function that the list gives it, the HAL's types say: with a wrong one there is no image.

use core::marker::PhantomData;
use stm32f4xx_hal::{gpio::*, rcc::Rcc};

/// A pin that the function `S` of a peripheral is to have.
pub struct Alternate<P, S>(P, PhantomData<S>);

impl<P: Into<S>, S> Alternate<P, S> {
    /// To be connected when the peripheral is ready.
    pub fn new(pin: P) -> Self {
        Self(pin, PhantomData)
    }

    /// Connects it.
    pub fn connect(self) -> S {
        self.0.into()
    }
}

/// All ports that boards use.
#[allow(missing_docs)]
pub struct Ports {
    pub a: gpioa::Parts,
    pub b: gpiob::Parts,
    pub c: gpioc::Parts,
    pub d: gpiod::Parts,
    pub e: gpioe::Parts,
}

impl Ports {
    /// Clocks them.
    pub fn new(
        (a, b, c, d, e): (
            stm32f4xx_hal::pac::GPIOA,
            stm32f4xx_hal::pac::GPIOB,
            stm32f4xx_hal::pac::GPIOC,
            stm32f4xx_hal::pac::GPIOD,
            stm32f4xx_hal::pac::GPIOE,
        ),
        rcc: &mut Rcc,
    ) -> Self {
        Self {
            a: a.split(rcc),
            b: b.split(rcc),
            c: c.split(rcc),
            d: d.split(rcc),
            e: e.split(rcc),
        }
    }
}

/// The handler of a command line's port that sends by interrupt.
macro_rules! serial_interrupt {
    (USART1) => {};
    (USART3) => {
        use stm32f4xx_hal::pac::interrupt;
        #[interrupt]
        fn USART3() {
            crate::serial::send_next();
        }
    };
}

/// See the module.
macro_rules! board {
    (
        name: $name:literal,
        clock: $clock:ident,
        serial: $serial:ident,
        alternate: { $($AType:ident $aname:ident: $Apin:ident $aport:ident.$afield:ident as $module:ident::$Signal:ident, $atext:literal;)* }
        plain: { $($PType:ident $pname:ident: $Ppin:ident $pport:ident.$pfield:ident, $ptext:literal;)* }
        analog: { $($NType:ident $nname:ident: $Npin:ident $nport:ident.$nfield:ident, $ntext:literal;)* }
    ) => {
        use crate::clocks::ClockSource;
        use crate::pin_list::{Alternate, Ports};
        use stm32f4xx_hal::{gpio, gpio::alt, hal_02::adc::Channel, pac};

        /// What the board is.
        pub const NAME: &str = $name;
        /// Where its clock comes from.
        pub const CLOCK: ClockSource = ClockSource::$clock;
        /// The port of its command line.
        pub type SerialPort = pac::$serial;
        serial_interrupt!($serial);
        /// Channels of the converter: three currents, the supply.
        pub fn channels() -> [u8; 4] {
            [$(<gpio::$Npin<gpio::Analog> as Channel<pac::ADC1>>::channel()),*]
        }

        $(
            #[doc = $ptext]
            // Most pins are named by their field alone.
            #[allow(dead_code)]
            pub type $PType<M> = gpio::$Ppin<M>;
        )*

        /// The pins, none of them in use yet.
        pub struct Pins {
            $(#[doc = $atext] pub $aname: Alternate<gpio::$Apin, alt::$module::$Signal>,)*
            $(#[doc = $ptext] pub $pname: gpio::$Ppin,)*
            $(#[doc = $ntext] pub $nname: gpio::$Npin,)*
        }

        impl Pins {
            /// Takes them out of their ports.
            pub fn new(ports: Ports) -> Self {
                Self {
                    $($aname: Alternate::new(ports.$aport.$afield),)*
                    $($pname: ports.$pport.$pfield,)*
                    $($nname: ports.$nport.$nfield,)*
                }
            }
        }
    };
}

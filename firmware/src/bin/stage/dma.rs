//! DMA streams: which request runs on which, and the few operations the image needs of one.

use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// Which way a stream moves bytes, and how.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// From the peripheral, once.
    Receive,
    /// From the peripheral, round and round.
    ReceiveCircular,
    /// To the peripheral, once.
    Transmit,
}

/// One stream of one controller, its request selected by `channel`.
pub struct Stream {
    controller: &'static pac::dma2::RegisterBlock,
    registers: &'static pac::dma2::ST,
    /// Its flags lie in the higher of the two flag registers, and from this bit on.
    has_high_flags: bool,
    flag_shift: u32,
    channel: u8,
}

// SAFETY: a stream's registers have one owner, wherever that is.
unsafe impl Send for Stream {}

/// The streams in use (RM0090, tables 43 and 44).
#[allow(missing_docs)]
pub struct Streams {
    pub spi1_receive: Stream,
    pub spi1_transmit: Stream,
    pub spi2_receive: Stream,
    pub spi2_transmit: Stream,
    pub spi3_receive: Stream,
    pub spi3_transmit: Stream,
    pub serial_receive: Stream,
    pub serial_transmit: Option<Stream>,
}

/// The streams of the command line's port: of which controller, their numbers, their channel.
pub struct SerialStreams {
    /// Of the second controller.
    pub second: bool,
    /// For what comes.
    pub receive: usize,
    /// For what goes; `None` where the encoders have taken all that could.
    pub transmit: Option<usize>,
    /// Of all of them.
    pub channel: u8,
}

/// Clocks the controllers and hands their streams out.
pub fn split(_dma1: pac::DMA1, _dma2: pac::DMA2, serial: SerialStreams, rcc: &mut Rcc) -> Streams {
    pac::DMA1::enable(rcc);
    pac::DMA2::enable(rcc);
    // SAFETY: the controllers were handed over, and each stream's registers go to one owner. The flag registers, which
    // streams share, are only read, and written with ones that clear the stream's own flags.
    let (one, two) = unsafe { (&*pac::DMA1::ptr(), &*pac::DMA2::ptr()) };
    let stream = |controller: &'static pac::dma2::RegisterBlock, number: usize, channel| Stream {
        controller,
        registers: controller.st(number),
        has_high_flags: number >= 4,
        flag_shift: [0, 6, 16, 22][number % 4],
        channel,
    };
    let SerialStreams {
        second,
        receive,
        transmit,
        channel,
    } = serial;
    let serial = |number| stream(if second { two } else { one }, number, channel);
    Streams {
        spi1_receive: stream(two, 0, 3),
        spi1_transmit: stream(two, 3, 3),
        spi2_receive: stream(one, 3, 0),
        spi2_transmit: stream(one, 4, 0),
        spi3_receive: stream(one, 0, 0),
        spi3_transmit: stream(one, 5, 0),
        serial_receive: serial(receive),
        serial_transmit: transmit.map(serial),
    }
}

impl Stream {
    /// Sets the stream up, stopped: bytes between the data register at `peripheral` and memory.
    pub fn configure(&mut self, mode: Mode, peripheral: *mut u32) {
        let registers = self.registers;
        // SAFETY: `peripheral` is the address of a data register; every channel number is defined.
        unsafe {
            registers.par().write(|w| w.pa().bits(peripheral as u32));
            registers.cr().write(|w| {
                w.chsel().bits(self.channel).minc().incremented();
                match mode {
                    // Nothing else may hold a frame's bytes up.
                    Mode::Receive => w.dir().peripheral_to_memory().pl().very_high(),
                    Mode::ReceiveCircular => w.dir().peripheral_to_memory().circ().enabled(),
                    Mode::Transmit => w.dir().memory_to_peripheral(),
                }
            });
        }
    }

    /// Starts a transfer.
    ///
    /// # Safety
    /// `memory` is valid for `bytes` bytes, and nothing but the stream uses them, until the transfer is over or
    /// stopped. It is not in the core-coupled memory, which DMA does not reach.
    #[inline(always)]
    pub unsafe fn start(&mut self, memory: *mut u8, bytes: u16) {
        let registers = self.registers;
        self.clear_flags();
        // SAFETY: every address is defined; that it is a good one is the caller's promise.
        registers
            .m0ar()
            .write(|w| unsafe { w.m0a().bits(memory as u32) });
        registers.ndtr().write(|w| w.ndt().set(bytes));
        // What the processor wrote to the buffer is there before the stream fetches it.
        cortex_m::asm::dmb();
        registers.cr().modify(|_, w| w.en().enabled());
    }

    /// Asks the stream to stop; it does after the byte under way.
    pub fn stop(&mut self) {
        self.registers.cr().modify(|_, w| w.en().disabled());
    }

    /// Whether a transfer is under way.
    #[inline(always)]
    pub fn is_running(&self) -> bool {
        self.registers.cr().read().en().is_enabled()
    }

    /// Bytes the transfer under way has still to move.
    #[inline(always)]
    pub fn remaining(&self) -> u16 {
        self.registers.ndtr().read().ndt().bits()
    }

    /// Whether the stream has passed the middle of its buffer, and its end, since it was asked last.
    pub fn take_marks(&mut self) -> [bool; 2] {
        let flags = if self.has_high_flags {
            self.controller.hisr().read().bits()
        } else {
            self.controller.lisr().read().bits()
        };
        let seen = flags & ((HALF | COMPLETE) << self.flag_shift);
        // Only what was seen is cleared: the next mark may be passed at any moment.
        self.clear(seen);
        let is_set = |flag: u32| seen & (flag << self.flag_shift) != 0;
        [is_set(HALF), is_set(COMPLETE)]
    }

    /// Clears the stream's flags.
    #[inline(always)]
    pub fn clear_flags(&mut self) {
        self.clear(ALL_FLAGS << self.flag_shift);
    }

    #[inline(always)]
    fn clear(&mut self, bits: u32) {
        // SAFETY: ones clear the flags of this stream, zeros leave the others alone.
        unsafe {
            if self.has_high_flags {
                self.controller.hifcr().write(|w| w.bits(bits));
            } else {
                self.controller.lifcr().write(|w| w.bits(bits));
            }
        }
    }
}

const HALF: u32 = 1 << 4;
const COMPLETE: u32 = 1 << 5;
const ALL_FLAGS: u32 = 0b11_1101;

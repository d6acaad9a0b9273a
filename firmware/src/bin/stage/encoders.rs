//! The three encoders: BiSS-C on SPI1, SPI2 and SPI3, read in parallel by DMA.
//!
//! A frame is eight bytes at 5.25 MHz (the fastest rate below BiSS-C's 10 MHz that both buses divide to), 12.2 us. The
//! clock idles high, and its first falling edge latches the position; some makers
//! say the first rising one, 95 ns later, which all three have in common. The encoder shifts on rising edges; SPI mode 3
//! samples a bit at the rising edge that ends it, which leaves the whole 190 ns of a bit for the line and the
//! transceivers. Where the frame begins in the 64 bits is the decoder's to find.
//!
//! # Which encoders fit
//!
//! BiSS-C point to point with 26 bits of position, one error and one warning bit, CRC-6: 36 clocks with start bit and
//! "zero" bit, so that idle and acknowledge may have 28 of the 64: 5.3 us of processing. The line has to be high again,
//! time-out over, when the next latch comes, 37.8 us after the last clock. An encoder's data sheet gives both times.
//!
//! # One instant
//!
//! Everything is armed first, receivers and transmitters, and the three transmit requests are let go by three stores in
//! a row: all three encoders latch within some 10 cycles, 60 ns. At 10 rad/s that is 0.6 urad, 6 counts.

use crate::{
    clocks,
    dma::{Mode, Stream},
};
use core::cell::UnsafeCell;
use firmware::drivers::biss::RawFrame;
use stm32f4xx_hal::{
    pac::{self, spi1},
    rcc::{Enable, Rcc},
};

/// Bytes of one frame.
pub const FRAME_BYTES: usize = 8;

/// A frame that did not arrive: a line that never leaves idle.
const MISSING: u64 = u64::MAX;

/// Bits of `RCC_APB2RSTR`, and of `RCC_APB1RSTR`.
const SPI1_RESET: u32 = 1 << 12;
const SPI2_RESET: u32 = 1 << 14;
const SPI3_RESET: u32 = 1 << 15;

const BIT_HZ: u32 = 5_250_000;
/// Codes of the SPI's baud rate: the bus clock over 2 to the power of one more.
const APB2_BAUD: u8 = 3;
const APB1_BAUD: u8 = 2;
const _: () = assert!(clocks::APB2_HZ >> (APB2_BAUD + 1) == BIT_HZ);
const _: () = assert!(clocks::APB1_HZ >> (APB1_BAUD + 1) == BIT_HZ);

/// `CR2`: requests for both streams.
const REQUESTS_BOTH: u32 = 0b11;

/// One SPI and its streams.
struct Port {
    spi: &'static spi1::RegisterBlock,
    baud: u8,
    /// Register and bit that reset it.
    reset: (*mut u32, u32),
    receive: Stream,
    transmit: Stream,
    buffer: &'static Buffer,
}

// SAFETY: a port's registers have one owner, wherever that is.
unsafe impl Send for Port {}

/// The three encoders' ports.
pub struct Encoders([Port; 3]);

/// Where DMA leaves a frame, byte by byte in the order of the line: one word, so that it is read as one.
struct Buffer(UnsafeCell<u64>);

// SAFETY: only its port touches it, and only while no transfer is under way.
unsafe impl Sync for Buffer {}

static BUFFERS: [Buffer; 3] = [const { Buffer(UnsafeCell::new(MISSING)) }; 3];

/// What lies in the buffers, for who is not the tick: a transfer may be under way, which leaves bytes of two frames there.
pub fn last_frames() -> [RawFrame; 3] {
    // SAFETY: each is a word of RAM. Volatile, since the compiler does not know who wrote there.
    BUFFERS
        .each_ref()
        .map(|buffer| RawFrame(unsafe { buffer.0.get().read_volatile() }.to_ne_bytes()))
}

/// What is clocked out, to nobody. Mutable in name only, so that it lies in RAM beside the rest.
static IDLE: Buffer = Buffer(UnsafeCell::new(MISSING));

impl Encoders {
    /// Configures the three ports, idle. Streams: receive and transmit, in the order of the ports.
    pub fn new(
        _ports: (pac::SPI1, pac::SPI2, pac::SPI3),
        streams: [(Stream, Stream); 3],
        rcc: &mut Rcc,
    ) -> Self {
        pac::SPI1::enable(rcc);
        pac::SPI2::enable(rcc);
        pac::SPI3::enable(rcc);
        // SAFETY: the ports were handed over.
        let spis = unsafe { [&*pac::SPI1::ptr(), &*pac::SPI2::ptr(), &*pac::SPI3::ptr()] };
        let (bus2, bus1) = (rcc.apb2rstr().as_ptr(), rcc.apb1rstr().as_ptr());
        let [first, second, third] = streams;
        Self([
            Port::new(spis[0], APB2_BAUD, (bus2, SPI1_RESET), first, &BUFFERS[0]),
            Port::new(spis[1], APB1_BAUD, (bus1, SPI2_RESET), second, &BUFFERS[1]),
            Port::new(spis[2], APB1_BAUD, (bus1, SPI3_RESET), third, &BUFFERS[2]),
        ])
    }

    /// Starts reading all three: this is where they latch. A port that is broken stays armed as it was, and quiet.
    #[inline(always)]
    pub fn latch(&mut self) {
        for port in &mut self.0 {
            port.arm();
        }
        let [first, second, third] = &self.0;
        let registers = [first, second, third].map(|port| port.spi.cr2().as_ptr());
        // SAFETY: each is a port's own register, and the value is one that this module configures it with. Volatile
        // stores would do, but for what the compiler may put between them.
        unsafe {
            core::arch::asm!(
                "str {go}, [{first}]",
                "str {go}, [{second}]",
                "str {go}, [{third}]",
                go = in(reg) REQUESTS_BOTH,
                first = in(reg) registers[0],
                second = in(reg) registers[1],
                third = in(reg) registers[2],
                options(nostack, preserves_flags)
            );
        }
    }

    /// The frames of the last latch, every bit of a missing one set.
    #[inline(always)]
    pub fn frames(&mut self) -> [RawFrame; 3] {
        let [first, second, third] = &mut self.0;
        [first.frame(), second.frame(), third.frame()]
    }
}

impl Port {
    fn new(
        spi: &'static spi1::RegisterBlock,
        baud: u8,
        reset: (*mut u32, u32),
        (mut receive, mut transmit): (Stream, Stream),
        buffer: &'static Buffer,
    ) -> Self {
        let data = spi.dr().as_ptr().cast();
        receive.configure(Mode::Receive, data);
        transmit.configure(Mode::Transmit, data);
        let port = Self {
            spi,
            baud,
            reset,
            receive,
            transmit,
            buffer,
        };
        port.configure();
        port
    }

    /// From the state after its reset.
    fn configure(&self) {
        self.spi.cr2().write(|w| w.rxdmaen().enabled());
        self.spi.cr1().write(|w| {
            w.mstr().master().ssm().enabled().ssi().slave_not_selected();
            w.cpol().idle_high().cpha().second_edge();
            w.br().set(self.baud)
        });
        // Last, with the clock's idle level known.
        self.spi.cr1().modify(|_, w| w.spe().enabled());
    }

    /// Readies both streams; the transmitter's request is held back.
    #[inline(always)]
    fn arm(&mut self) {
        self.spi.cr2().write(|w| w.rxdmaen().enabled());
        // A stream that was told to stop 35 us ago has stopped; if one has not, the port is broken and stays quiet.
        if self.receive.is_running() || self.transmit.is_running() {
            return;
        }
        // SAFETY: the buffers are statics in RAM that only this port uses, and it reads its own once the stream is
        // done.
        unsafe {
            self.receive
                .start(self.buffer.0.get().cast(), FRAME_BYTES as u16);
            self.transmit.start(IDLE.0.get().cast(), FRAME_BYTES as u16);
        }
    }

    #[inline(always)]
    fn frame(&mut self) -> RawFrame {
        // A transfer that was not started is noticed as well: the one that kept it from starting has bytes left.
        if self.receive.remaining() != 0 {
            self.abandon();
            return RawFrame::MISSING;
        }
        // SAFETY: the stream is done. Volatile, since the compiler does not know who wrote there.
        RawFrame(unsafe { self.buffer.0.get().read_volatile() }.to_ne_bytes())
    }

    /// Gives a transfer up, and leaves the port such that the next one begins with its own first byte: only a reset empties
    /// its transmit register and ends the byte under way, whose answer would otherwise stand before the next frame for
    /// ever.
    #[cold]
    fn abandon(&mut self) {
        self.transmit.stop();
        self.receive.stop();
        let (register, bit) = self.reset;
        // SAFETY: the register resets peripherals, this bit this port. Nothing else writes there once the loop runs.
        unsafe {
            let resets = register.read_volatile();
            register.write_volatile(resets | bit);
            register.write_volatile(resets);
        }
        self.configure();
    }
}

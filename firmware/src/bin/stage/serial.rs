//! The command interface, on the board's USART, 921,600 baud: received by DMA, sent by DMA too where the encoders leave the port a
//! stream, else by an interrupt a byte, below latch and tick.
//!
//! Received bytes land in a ring that the command side empties whenever it runs, within 50 us as a rule. At full rate
//! half of it holds 11 ms, and so long the command side may be away; what is lost then is reported to it.

use crate::{
    clocks,
    dma::{Mode, SerialStreams, Stream},
    pins::SerialPort,
    watchdog,
};
use core::{
    cell::UnsafeCell,
    convert::Infallible,
    ops::Deref,
    sync::atomic::{AtomicUsize, Ordering},
};
use stm32f4xx_hal::{
    pac::{self, Interrupt, NVIC, usart1},
    rcc::{self, Rcc},
};

/// Rate of the line.
pub const BAUD: u32 = 921_600;
/// Size of the ring of received bytes.
const RING_BYTES: usize = 2048;
/// Bytes that may come while others are copied out of it: 1.4 ms.
const MARGIN_BYTES: usize = 128;
/// Size of the buffer of bytes to send.
const BYTES: usize = 1024;
/// How many bytes are passed on at a time.
const PIECE_BYTES: usize = 32;

/// A USART that a board may have its command line on.
pub trait Port: Deref<Target = usart1::RegisterBlock> + rcc::Enable {
    /// Its clock, Hz.
    const CLOCK_HZ: u32;
    /// Its streams (RM0090, tables 43 and 44).
    const STREAMS: SerialStreams;
    /// Its interrupt, where it has to send by that.
    const INTERRUPT: Option<Interrupt>;
}

impl Port for pac::USART1 {
    const CLOCK_HZ: u32 = clocks::APB2_HZ;
    const STREAMS: SerialStreams = SerialStreams {
        second: true,
        receive: 5,
        transmit: Some(7),
        channel: 4,
    };
    const INTERRUPT: Option<Interrupt> = None;
}

impl Port for pac::USART3 {
    const CLOCK_HZ: u32 = clocks::APB1_HZ;
    const STREAMS: SerialStreams = SerialStreams {
        second: false,
        receive: 1,
        transmit: None,
        channel: 4,
    };
    const INTERRUPT: Option<Interrupt> = Some(Interrupt::USART3);
}

struct Buffer<const N: usize>(UnsafeCell<[u8; N]>);

// SAFETY: `Receiver` and `Transmitter`, of which there is one each, alone touch their buffers.
unsafe impl<const N: usize> Sync for Buffer<N> {}

static RECEIVED: Buffer<RING_BYTES> = Buffer(UnsafeCell::new([0; RING_BYTES]));
static SENDING: Buffer<BYTES> = Buffer(UnsafeCell::new([0; BYTES]));

/// The receiving half.
pub struct Receiver {
    usart: SerialPort,
    stream: Stream,
    /// Where the next byte to hand out lies.
    next: usize,
    /// Where the stream was going to put the next byte when it was polled.
    head: usize,
}

/// The sending half.
pub struct Transmitter {
    /// `None`: byte by byte, by the port's interrupt.
    stream: Option<Stream>,
    filled: usize,
}

/// Of what is sent by interrupt: the next byte, and how many there are.
static NEXT: AtomicUsize = AtomicUsize::new(0);
static END: AtomicUsize = AtomicUsize::new(0);

/// The lowest priority that there is, that of the recorders.
const LOWEST_PRIORITY: u8 = 0xF0;

/// Configures the port and starts to receive.
pub fn configure(
    usart: SerialPort,
    (mut receive, mut transmit): (Stream, Option<Stream>),
    rcc: &mut Rcc,
) -> (Receiver, Transmitter) {
    <SerialPort as rcc::Enable>::enable(rcc);
    let divider = ((SerialPort::CLOCK_HZ + BAUD / 2) / BAUD) as u16;
    // SAFETY: the register takes the divider in sixteenths as it is.
    usart.brr().write(|w| unsafe { w.bits(divider) });
    let data = usart.dr().as_ptr().cast();
    receive.configure(Mode::ReceiveCircular, data);
    if let Some(stream) = &mut transmit {
        stream.configure(Mode::Transmit, data);
    }
    // SAFETY: the buffer is a static in RAM; `Receiver` reads only what the stream has left behind.
    unsafe { receive.start(RECEIVED.0.get().cast(), RING_BYTES as u16) };
    let by_stream = transmit.is_some();
    (usart.cr3()).write(|w| w.dmar().enabled().dmat().bit(by_stream));
    usart
        .cr1()
        .write(|w| w.ue().enabled().te().enabled().re().enabled());
    if let Some(interrupt) = SerialPort::INTERRUPT {
        // SAFETY: during start-up; nothing else sets this interrupt up.
        unsafe {
            let mut core = cortex_m::Peripherals::steal();
            core.NVIC.set_priority(interrupt, LOWEST_PRIORITY);
            NVIC::unmask(interrupt);
        }
    }
    let receiver = Receiver {
        usart,
        stream: receive,
        next: 0,
        head: 0,
    };
    let transmitter = Transmitter {
        stream: transmit,
        filled: 0,
    };
    (receiver, transmitter)
}

impl Receiver {
    /// Finds how far the bytes have come. Returns whether some are lost or damaged: then all that has not been handed
    /// out is thrown away, and so has to be what was handed out of a line and what comes of it.
    pub fn poll(&mut self) -> bool {
        // Both marks passed: half a ring has come, or that and whole ones more.
        let [half, end] = self.stream.take_marks();
        let head = (RING_BYTES - usize::from(self.stream.remaining())) % RING_BYTES;
        let come = distance(self.head, head);
        let full = distance(self.next, self.head) + come > RING_BYTES - MARGIN_BYTES;
        // The flags go with the next byte that the stream takes.
        let status = self.usart.sr().read();
        let damaged = status.fe().bit() || status.nf().bit() || status.ore().bit();
        let lost = (half && end) || full || (damaged && come > 0);
        self.head = head;
        if lost {
            self.next = head;
            defmt::warn!("received bytes lost or damaged");
        }
        lost
    }

    /// Offers what had come when it was polled, in pieces, to `take`, which says how many bytes of a piece it took; the
    /// rest stays.
    pub fn pass_to(&mut self, mut take: impl FnMut(&[u8]) -> usize) {
        let mut piece = [0; PIECE_BYTES];
        loop {
            let length = self.copy_to(&mut piece);
            let taken = take(&piece[..length]);
            self.next = (self.next + taken) % RING_BYTES;
            if length == 0 || taken < length {
                return;
            }
        }
    }

    /// Copies the bytes to hand out next, as far as they go, and says how many.
    fn copy_to(&mut self, piece: &mut [u8; PIECE_BYTES]) -> usize {
        let length = distance(self.next, self.head).min(PIECE_BYTES);
        for (offset, byte) in piece[..length].iter_mut().enumerate() {
            let at = (self.next + offset) % RING_BYTES;
            // SAFETY: the stream has left this byte behind. Volatile, since the compiler does not know who wrote it.
            *byte = unsafe { RECEIVED.0.get().cast::<u8>().add(at).read_volatile() };
        }
        length
    }
}

/// From one place in the ring on to another.
fn distance(from: usize, to: usize) -> usize {
    (to + RING_BYTES - from) % RING_BYTES
}

impl Transmitter {
    /// Sends what has been written.
    pub fn send(&mut self) {
        if self.filled == 0 {
            return;
        }
        self.wait();
        match &mut self.stream {
            // SAFETY: the buffer is a static in RAM, and nothing is written to it until the stream is done.
            Some(stream) => unsafe {
                stream.start(SENDING.0.get().cast(), self.filled as u16);
            },
            None => {
                NEXT.store(0, Ordering::Relaxed);
                // What stands in the buffer is there before the interrupt looks.
                END.store(self.filled, Ordering::Release);
                // SAFETY: the port was handed over, and nothing else writes this register once it is set up but the interrupt, which
                // is off.
                unsafe { &*SerialPort::ptr() }
                    .cr1()
                    .modify(|_, w| w.txeie().enabled());
            }
        }
        self.filled = 0;
    }

    fn is_sending(&self) -> bool {
        match &self.stream {
            Some(stream) => stream.is_running(),
            None => NEXT.load(Ordering::Acquire) < END.load(Ordering::Relaxed),
        }
    }

    /// Bytes that can be written without waiting.
    pub fn room(&self) -> usize {
        if self.is_sending() {
            0
        } else {
            BYTES - self.filled
        }
    }

    /// Waits until nothing is being sent: 11 ms at most.
    fn wait(&mut self) {
        while self.is_sending() {
            watchdog::note_alive();
            cortex_m::asm::wfi();
        }
    }
}

/// The port's interrupt, where it sends by that: it can take a byte.
// On a board whose port sends by DMA nobody calls it.
#[allow(dead_code)]
pub fn send_next() {
    // SAFETY: see `Transmitter::send`.
    let port = unsafe { &*SerialPort::ptr() };
    let next = NEXT.load(Ordering::Relaxed);
    if next < END.load(Ordering::Acquire) {
        // SAFETY: within the buffer, which nobody writes to until all of it is sent.
        let byte = unsafe { SENDING.0.get().cast::<u8>().add(next).read_volatile() };
        port.dr().write(|w| w.dr().set(byte.into()));
        NEXT.store(next + 1, Ordering::Release);
    } else {
        port.cr1().modify(|_, w| w.txeie().disabled());
    }
    // The interrupt's end has arrived before the core looks for further ones (erratum 838869).
    cortex_m::asm::dsb();
}

impl embedded_io::ErrorType for Transmitter {
    type Error = Infallible;
}

impl embedded_io::Write for Transmitter {
    /// Keeps the bytes until [`Self::flush`] or until the buffer is full.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        if self.filled == BYTES {
            self.send();
        }
        self.wait();
        let count = bytes.len().min(BYTES - self.filled);
        // SAFETY: nothing is being sent, and `count` bytes fit behind those that are there.
        unsafe {
            let free = SENDING.0.get().cast::<u8>().add(self.filled);
            core::ptr::copy_nonoverlapping(bytes.as_ptr(), free, count);
        }
        self.filled += count;
        Ok(count)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        self.send();
        Ok(())
    }
}

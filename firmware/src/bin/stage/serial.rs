//! USART1: the command interface, 921,600 baud, both directions by DMA and without an interrupt.
//!
//! Received bytes land in a ring that the command side empties whenever it runs, within 50 us as a rule. At full rate
//! the ring holds 11 ms; what a slower command side loses is noticed and logged.

use crate::{
    clocks,
    dma::{Mode, Stream},
    watchdog,
};
use core::{cell::UnsafeCell, convert::Infallible};
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// Rate of the line.
pub const BAUD: u32 = 921_600;
/// Size of either buffer.
const BYTES: usize = 1024;
/// How many bytes are passed on at a time.
const PIECE_BYTES: usize = 32;

struct Buffer(UnsafeCell<[u8; BYTES]>);

// SAFETY: `Receiver` and `Transmitter`, of which there is one each, alone touch their buffers.
unsafe impl Sync for Buffer {}

static RECEIVED: Buffer = Buffer(UnsafeCell::new([0; BYTES]));
static SENDING: Buffer = Buffer(UnsafeCell::new([0; BYTES]));

/// The receiving half.
pub struct Receiver {
    stream: Stream,
    /// Where the next byte to hand out lies.
    next: usize,
    overruns: u32,
}

/// The sending half.
pub struct Transmitter {
    stream: Stream,
    filled: usize,
}

/// Configures the port and starts to receive.
pub fn configure(
    usart: pac::USART1,
    (mut receive, mut transmit): (Stream, Stream),
    rcc: &mut Rcc,
) -> (Receiver, Transmitter) {
    pac::USART1::enable(rcc);
    let divider = ((clocks::APB2_HZ + BAUD / 2) / BAUD) as u16;
    // SAFETY: the register takes the divider in sixteenths as it is.
    usart.brr().write(|w| unsafe { w.bits(divider) });
    let data = usart.dr().as_ptr().cast();
    receive.configure(Mode::ReceiveCircular, data);
    transmit.configure(Mode::Transmit, data);
    // SAFETY: the buffer is a static in RAM; `Receiver` reads only what the stream has left behind.
    unsafe { receive.start(RECEIVED.0.get().cast(), BYTES as u16) };
    usart.cr3().write(|w| w.dmar().enabled().dmat().enabled());
    usart
        .cr1()
        .write(|w| w.ue().enabled().te().enabled().re().enabled());
    let receiver = Receiver {
        stream: receive,
        next: 0,
        overruns: 0,
    };
    let transmitter = Transmitter {
        stream: transmit,
        filled: 0,
    };
    (receiver, transmitter)
}

impl Receiver {
    /// Offers what has come, in pieces, to `take`, which says how many bytes of a piece it took; the rest stays.
    pub fn pass_to(&mut self, mut take: impl FnMut(&[u8]) -> usize) {
        let mut piece = [0; PIECE_BYTES];
        loop {
            let length = self.copy_to(&mut piece);
            let taken = take(&piece[..length]);
            self.next = (self.next + taken) % BYTES;
            if length == 0 || taken < length {
                return;
            }
        }
    }

    /// Copies the bytes to hand out next, as far as they go, and says how many.
    fn copy_to(&mut self, piece: &mut [u8; PIECE_BYTES]) -> usize {
        let waiting = (self.head() + BYTES - self.next) % BYTES;
        let length = waiting.min(PIECE_BYTES);
        for (offset, byte) in piece[..length].iter_mut().enumerate() {
            let at = (self.next + offset) % BYTES;
            // SAFETY: the stream has left this byte behind. Volatile, since the compiler does not know who wrote it.
            *byte = unsafe { RECEIVED.0.get().cast::<u8>().add(at).read_volatile() };
        }
        length
    }

    /// Where the stream will put the next byte.
    fn head(&mut self) -> usize {
        let before = self.position();
        if !self.stream.is_complete() {
            return before;
        }
        self.stream.clear_flags();
        let head = self.position();
        // The stream has gone round: it must not have come past what was not read yet.
        if head >= self.next {
            self.overruns += 1;
            defmt::warn!("received bytes lost, {} times so far", self.overruns);
            self.next = head;
        }
        head
    }

    fn position(&self) -> usize {
        (BYTES - usize::from(self.stream.remaining())) % BYTES
    }
}

impl Transmitter {
    /// Sends what has been written.
    pub fn send(&mut self) {
        if self.filled == 0 {
            return;
        }
        self.wait();
        // SAFETY: the buffer is a static in RAM, and nothing is written to it until the stream is done.
        unsafe {
            self.stream
                .start(SENDING.0.get().cast(), self.filled as u16)
        };
        self.filled = 0;
    }

    /// Bytes that can be written without waiting.
    pub fn room(&self) -> usize {
        if self.stream.is_running() {
            0
        } else {
            BYTES - self.filled
        }
    }

    /// Waits until nothing is being sent: 11 ms at most.
    fn wait(&mut self) {
        while self.stream.is_running() {
            watchdog::feed();
            cortex_m::asm::wfi();
        }
    }
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

//! USART1: the command interface, 921,600 baud, both directions by DMA and without an interrupt.
//!
//! Received bytes land in a ring that the command side empties whenever it runs, within 50 us as a rule. At full rate
//! half of it holds 11 ms, and so long the command side may be away; what is lost then is reported to it.

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
/// Size of the ring of received bytes.
const RING_BYTES: usize = 2048;
/// Bytes that may come while others are copied out of it: 1.4 ms.
const MARGIN_BYTES: usize = 128;
/// Size of the buffer of bytes to send.
const BYTES: usize = 1024;
/// How many bytes are passed on at a time.
const PIECE_BYTES: usize = 32;

struct Buffer<const N: usize>(UnsafeCell<[u8; N]>);

// SAFETY: `Receiver` and `Transmitter`, of which there is one each, alone touch their buffers.
unsafe impl<const N: usize> Sync for Buffer<N> {}

static RECEIVED: Buffer<RING_BYTES> = Buffer(UnsafeCell::new([0; RING_BYTES]));
static SENDING: Buffer<BYTES> = Buffer(UnsafeCell::new([0; BYTES]));

/// The receiving half.
pub struct Receiver {
    usart: pac::USART1,
    stream: Stream,
    /// Where the next byte to hand out lies.
    next: usize,
    /// Where the stream was going to put the next byte when it was polled.
    head: usize,
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
    unsafe { receive.start(RECEIVED.0.get().cast(), RING_BYTES as u16) };
    usart.cr3().write(|w| w.dmar().enabled().dmat().enabled());
    usart
        .cr1()
        .write(|w| w.ue().enabled().te().enabled().re().enabled());
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

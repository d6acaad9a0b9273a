//! From the tick to what observes it: the tick leaves a sample, and a task of the lowest priority takes it.

use firmware::recorder::{Sample, TickObserver};
use heapless::spsc::{Consumer, Producer, Queue};

/// Slots of the queue, a power of two; one is lost to the ring. The task may be behind by as many ticks as are left.
pub const SAMPLE_SLOTS: usize = 4;

/// Between the two.
pub type SampleQueue = Queue<Sample, SAMPLE_SLOTS>;

/// The tick's end.
pub struct SampleSender(pub Producer<'static, Sample>);

/// The other one.
pub type SampleReceiver = Consumer<'static, Sample>;

impl TickObserver for SampleSender {
    #[inline]
    fn observe(&mut self, sample: &Sample) {
        // The comparison tells the compiler the number of slots: without it there were a division, and a panic behind it.
        if self.0.capacity() == SAMPLE_SLOTS - 1 {
            // Only a loop that is late already leaves no time to take samples: that one is left out.
            let _ = self.0.enqueue(sample.clone());
        }
    }
}

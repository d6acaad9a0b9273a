//! What observes every tick and is no part of it.

use crate::fault_record::FaultRecordWriter;
use crate::recorder::{RecorderWriter, Sample, TickObserver};

/// The recorders' ends that take the samples. Where a tick has a deadline they run behind it; see
/// [`TickQueues::observers`](super::TickQueues).
pub struct TickObservers<'a> {
    /// The data recorder's.
    pub recorder: RecorderWriter<'a>,
    /// The fault record's, where there is memory for one.
    pub fault_record: Option<FaultRecordWriter<'a>>,
}

impl TickObserver for TickObservers<'_> {
    #[inline]
    fn observe(&mut self, sample: &Sample) {
        if let Some(fault_record) = &mut self.fault_record {
            fault_record.observe(sample);
        }
        self.recorder.observe(sample);
    }
}

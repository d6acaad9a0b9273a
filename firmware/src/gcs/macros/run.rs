//! Carrying on the macro that runs.

use super::state::LINES_PER_TICK;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::Discard;
use crate::queues::CommandQueues;

impl Interpreter {
    /// Carries on the macro that runs, as far as its lines for this tick go.
    pub(in crate::gcs) fn run_macro(&mut self, queues: &mut CommandQueues<'_>) {
        if !self.macros.is_running() {
            return;
        }
        let tick = self.commander.tick();
        if self.macros.tick != tick {
            self.macros.tick = tick;
            self.macros.lines = LINES_PER_TICK;
        }
        let mut session = core::mem::take(&mut self.macros.session);
        self.report_errors(&mut session);
        loop {
            // Nothing that is thrown away fails.
            let _ = self.handle(&mut session, queues, &mut Discard);
            if !session.is_idle() || !self.macros.check_line_result(&mut session) {
                break;
            }
            if self.macros.lines == 0 {
                break;
            }
            self.macros.lines -= 1;
            let macros = &mut self.macros;
            macros.line.clear();
            // No line was recorded that is longer than one may be, and the input is empty.
            let _ = (macros.line).extend_from_slice(macros.calls.next(&macros.store));
            session.receive(&macros.line);
            session.receive(b"\n");
        }
        if self.macros.is_running() {
            self.macros.session = session;
        }
    }
}

//! A measurement that is cut off: what it had changed for its time is given back by the next one.

use calibration::plan::plan;
use calibration::{Instrument, Kit, Noise, Seen};
use desk::calibrate::{Reader, Wanted, Way, measure};
use desk::commission::{Machine, Task};
use desk::record::RecordError;
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::rig::Told;
use tripivot::attended::SimulatedMachine;

/// Stiffness of guides, N/um, and the largest way of an excitation, rad.
const STIFFNESS: &str = "0x54500709";
const WAY: &str = "0x54500D01";
const POSES: usize = 12;

/// Sees the stage where it was sent.
struct Obedient;

impl Reader for Obedient {
    fn read(&mut self, wanted: &Wanted) -> Result<Seen, String> {
        Ok(Seen::Pose(wanted.pose))
    }
}

/// A machine whose line is cut after so many moves.
struct Cut<'a> {
    machine: &'a mut SimulatedMachine,
    moves_left: usize,
}

impl Machine for Cut<'_> {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        if line.starts_with("MOV") {
            self.moves_left = self.moves_left.saturating_sub(1);
        }
        if self.moves_left == 0 {
            return Err(RecordError::Ended("a cut line".to_owned()));
        }
        self.machine.ask(line)
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.machine.delay(seconds)
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        self.machine.request(task)
    }

    fn scale_periods(&self) -> Option<u32> {
        self.machine.scale_periods()
    }
}

fn value(machine: &mut SimulatedMachine, id: &str) -> String {
    let answer = machine.ask(&format!("SPA? 1 {id}"));
    let answer = answer.expect("it answers").expect("a value");
    answer.rsplit('=').next().unwrap_or_default().to_owned()
}

#[test]
fn what_it_had_set_aside_comes_back() {
    for kit in [Kit::Xyt, Kit::Ends] {
        let stage = StageParameters::REFERENCE;
        let mut machine = SimulatedMachine::told(&stage, SettingsFlash::in_memory(), Told::Machine);
        for line in [
            "CCL 1 ADVANCED",
            &format!("SPA 1 {STIFFNESS} 30"),
            "WPA 100",
        ] {
            machine.ask(line).expect("taken");
        }
        let before = [STIFFNESS, WAY].map(|id| value(&mut machine, id));
        let noise = Noise {
            length: 2e-5,
            angle_rad: 4e-5,
            encoder_rad: Noise::ENCODER_RAD,
        };
        let instrument = Instrument::new(kit, noise);
        let planned = plan(&instrument, POSES).expect("a plan");
        let way = |first| Way {
            stops: &planned.stops,
            first,
            radius_mm: 100.0,
            ends: &instrument.ends,
            is_from_both_sides: false,
        };
        let mut cut = Cut {
            machine: &mut machine,
            moves_left: 4,
        };
        let cut_off = measure(&mut cut, &mut Obedient, &way(0), &mut |_| Ok(()));
        assert!(cut_off.is_err());
        assert_eq!(value(&mut machine, STIFFNESS), "0", "{kit}");
        // The line is there again.
        measure(
            &mut machine,
            &mut Obedient,
            &way(POSES - 1),
            &mut |_| Ok(()),
        )
        .expect("it goes on");
        let after = [STIFFNESS, WAY].map(|id| value(&mut machine, id));
        assert_eq!(before, after, "{kit}");
    }
}

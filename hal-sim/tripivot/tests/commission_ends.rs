//! Guides' ends that are not where they are drawn: no zeros come of them.

use desk::commission::{Chosen, Machine, run};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::machine::unknown;
use hal_sim::rig::Told;
use tripivot::attended::SimulatedMachine;

#[test]
fn ends_that_are_not_where_they_are_drawn_are_refused_and_nothing_is_changed() {
    let mut machine = unknown(1);
    // Something in the way at the inner ends.
    machine.plant.guide_range_m[0] += 10e-3;
    let flash = SettingsFlash::in_memory();
    let mut stage = SimulatedMachine::told(&machine, flash, Told::Everything);
    // What is in force again after a failure is what is kept.
    let kept = stage.ask("WPA 100");
    assert!(kept.is_ok(), "{kept:?}");
    let before = stage.parameters().clone();
    let chosen = Chosen::only("ends").expect("a step");
    let ran = run(&mut stage, &chosen, &mut |_| ()).unwrap_or_else(|error| panic!("{error}"));
    let failure = ran.done[0].failure.as_ref().expect("refused");
    println!("{}: {}", failure.what, failure.advice);
    assert!(failure.what.contains("ends are off"), "{}", failure.what);
    assert_eq!(*stage.parameters(), before);
}

//! What the unmodified image has set up when its loop begins to run: what keeps the motors safe when something hangs, read back
//! from the chip's registers. Needs `cargo stage` first, then `cargo chip-test`.

use hal_sim::machine::devices::{Stage, StageParameters};
use image::chip::{Bench, elf_file};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// A register, which of its bits, what they are, and what for.
type Setting = (u32, u32, u32, &'static str);

const SETTINGS: [Setting; 16] = [
    (
        0x4002_3800,
        1 << 19,
        1 << 19,
        "the crystal is watched (RCC_CR.CSSON)",
    ),
    (
        0x4002_3844,
        1 << 14,
        1 << 14,
        "the system configuration has its clock (RCC_APB2ENR.SYSCFGEN)",
    ),
    (
        0x4001_3800,
        0b111,
        0b011,
        "SRAM answers at address 0 (SYSCFG_MEMRMP)",
    ),
    (
        0x4000_2C04,
        1 << 9,
        1 << 9,
        "window watchdog: early warning (WWDG_CFR.EWI)",
    ),
    (
        0x4000_2C00,
        0xFF,
        0x80 | 0x45,
        "window watchdog: runs, as it was fed last (WWDG_CR)",
    ),
    (
        0x4000_3004,
        0b111,
        0b101,
        "independent watchdog: 128 (IWDG_PR)",
    ),
    (
        0x4000_3008,
        0xFFF,
        4,
        "independent watchdog: 20 ms nominal (IWDG_RLR)",
    ),
    (
        0xE004_2004,
        1,
        1,
        "clocks go on in sleep (DBGMCU_CR.DBG_SLEEP)",
    ),
    (
        0xE004_2008,
        0x0802,
        0x0802,
        "TIM3 and window watchdog stop in halt (DBGMCU_APB1_FZ)",
    ),
    (
        0xE004_2008,
        0x1000,
        0,
        "the independent watchdog does not (DBGMCU_APB1_FZ)",
    ),
    (0xE004_200C, 1, 1, "TIM1 stops in halt (DBGMCU_APB2_FZ)"),
    (
        0x4002_0000,
        0b11 << 24,
        0b01 << 24,
        "PA12 is an output (GPIOA_MODER)",
    ),
    (0x4002_0014, 1 << 12, 0, "and low (GPIOA_ODR)"),
    (
        0x4002_0008,
        0b11 << 10,
        0b11 << 10,
        "fastest slope of PA5 (GPIOA_OSPEEDR)",
    ),
    (
        0x4002_0408,
        0b11 << 26,
        0b11 << 26,
        "fastest slope of PB13 (GPIOB_OSPEEDR)",
    ),
    (
        0x4002_0808,
        0b11 << 20,
        0b11 << 20,
        "fastest slope of PC10 (GPIOC_OSPEEDR)",
    ),
];

#[test]
fn what_stops_the_motors_is_set_up_before_the_loop_runs() {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let (send, receive) = mpsc::channel();
    let outcome = bench
        .run(move |period| {
            if period.tick < 10 {
                return Continue(());
            }
            let found = SETTINGS.map(|(register, ..)| period.register(register.into()));
            send.send(found).expect("the test waits");
            Break(())
        })
        .expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    let found = receive.recv().expect("the last period");
    for ((register, bits, wanted, what), found) in SETTINGS.into_iter().zip(found) {
        let found = found.expect(what) & bits;
        assert_eq!(found, wanted, "{what}: {register:#010x} is {found:#x}");
    }
}

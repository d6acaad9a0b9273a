//! The model of the core against ARM's table, by sequences made by hand (as `llvm-mc -mcpu=cortex-m4 -show-encoding` assembles
//! them). The image's ticks go through it in `cargo chip-cycles --check`.

use image::cycles::{Bus, Core, Cycles, Instruction, Kind, Ran, Setting, address};
use image::proof::Engine;

const ADD: &[u8] = &[0x40, 0x18]; // adds r0, r0, r1
const ADD_WIDE: &[u8] = &[0x01, 0xEB, 0x02, 0x00]; // add.w r0, r1, r2
const MUL: &[u8] = &[0x01, 0xFB, 0x02, 0xF0]; // mul r0, r1, r2
const MLA: &[u8] = &[0x01, 0xFB, 0x02, 0x30]; // mla r0, r1, r2, r3
const SMULL: &[u8] = &[0x82, 0xFB, 0x03, 0x01]; // smull r0, r1, r2, r3
const UDIV: &[u8] = &[0xB1, 0xFB, 0xF2, 0xF0]; // udiv r0, r1, r2
const LDR_R0: &[u8] = &[0x08, 0x68]; // ldr r0, [r1]
const LDR_R2_R3: &[u8] = &[0x5A, 0x68]; // ldr r2, [r3, #4]
const LDR_R2_R0: &[u8] = &[0x42, 0x68]; // ldr r2, [r0, #4]
const LDR_INDEXED: &[u8] = &[0x51, 0xF8, 0x22, 0x00]; // ldr.w r0, [r1, r2, lsl #2]
const LDR_LITERAL: &[u8] = &[0x04, 0x48]; // ldr r0, [pc, #16]
const LDR_AFTER: &[u8] = &[0x51, 0xF8, 0x04, 0x0B]; // ldr r0, [r1], #4
const STR: &[u8] = &[0x08, 0x60]; // str r0, [r1]
const STR_INDEXED: &[u8] = &[0x88, 0x50]; // str r0, [r1, r2]
const LDRD: &[u8] = &[0xD2, 0xE9, 0x00, 0x01]; // ldrd r0, r1, [r2]
const LDM: &[u8] = &[0x90, 0xE8, 0x0E, 0x00]; // ldm.w r0, {r1, r2, r3}
const PUSH: &[u8] = &[0x30, 0xB5]; // push {r4, r5, lr}
const POP_PC: &[u8] = &[0x30, 0xBD]; // pop {r4, r5, pc}
const LDR_PC: &[u8] = &[0xD1, 0xF8, 0x00, 0xF0]; // ldr.w pc, [r1]
const TBB: &[u8] = &[0xDF, 0xE8, 0x00, 0xF0]; // tbb [pc, r0]
const TBH: &[u8] = &[0xDF, 0xE8, 0x10, 0xF0]; // tbh [pc, r0, lsl #1]
const BX: &[u8] = &[0x70, 0x47]; // bx lr
const BEQ: &[u8] = &[0x02, 0xD0]; // beq over four bytes
const CBZ: &[u8] = &[0x10, 0xB1]; // cbz r0, over some bytes
const VADD: &[u8] = &[0x30, 0xEE, 0x81, 0x0A]; // vadd.f32 s0, s1, s2
const VMUL: &[u8] = &[0x60, 0xEE, 0x02, 0x1A]; // vmul.f32 s3, s0, s4
const VMLA: &[u8] = &[0x41, 0xEE, 0x80, 0x2A]; // vmla.f32 s5, s3, s0
const VMLA_OF_S0: &[u8] = &[0x01, 0xEE, 0x82, 0x0A]; // vmla.f32 s0, s3, s4
const VDIV: &[u8] = &[0x80, 0xEE, 0x81, 0x0A]; // vdiv.f32 s0, s1, s2
const VSQRT: &[u8] = &[0xB1, 0xEE, 0xE0, 0x0A]; // vsqrt.f32 s0, s1
const VLDR: &[u8] = &[0x90, 0xED, 0x00, 0x0A]; // vldr s0, [r0]
const VLDR_DOUBLE: &[u8] = &[0x90, 0xED, 0x00, 0x0B]; // vldr d0, [r0]
const VSTR: &[u8] = &[0x80, 0xED, 0x00, 0x0A]; // vstr s0, [r0]
const VLDM: &[u8] = &[0x90, 0xEC, 0x03, 0x0A]; // vldmia r0, {s0, s1, s2}
const VPUSH: &[u8] = &[0x2D, 0xED, 0x02, 0x8A]; // vpush {s16, s17}
const VMOV: &[u8] = &[0x10, 0xEE, 0x10, 0x0A]; // vmov r0, s0
const VMOV_TWO: &[u8] = &[0x51, 0xEC, 0x10, 0x0A]; // vmov r0, r1, s0, s1
const VCVT: &[u8] = &[0xB8, 0xEE, 0xE0, 0x0A]; // vcvt.f32.s32 s0, s1

const START: u64 = 0x0800_1000;

fn decoded(code: &[u8], at: u64) -> Instruction {
    let engine = Engine::new().expect("a disassembler");
    Instruction::decode(&engine, code, at).expect("an instruction")
}

/// Instructions that stand one behind the other, through the model.
fn run_with(setting: Setting, code: &[(&[u8], Bus)]) -> Cycles {
    let mut at = START;
    let decoded: Vec<(u64, Instruction, Bus)> = (code.iter())
        .map(|(code, bus)| {
            let here = at;
            at += code.len() as u64;
            (here, decoded(code, here), *bus)
        })
        .collect();
    let ran = decoded.iter().map(|(at, instruction, bus)| Ran {
        at: *at,
        instruction,
        bus: *bus,
    });
    Core::new(setting).run(ran, |_, _| {})
}

/// The same without wait states and buses: what ARM's table makes of it.
fn table(code: &[&[u8]]) -> u64 {
    let code: Vec<_> = code.iter().map(|code| (*code, Bus::None)).collect();
    let cycles = run_with(Setting::WITHOUT_WAIT_STATES, &code);
    assert_eq!((cycles.fetch, cycles.data, cycles.peripherals), (0, 0, 0));
    cycles.table + cycles.float
}

#[test]
fn instructions_by_themselves_take_what_arms_table_says() {
    for (code, cycles) in [
        (ADD, 1),
        (ADD_WIDE, 1),
        (MUL, 1),
        (MLA, 2),
        (SMULL, 1),
        (LDR_R0, 2),
        (LDR_INDEXED, 2),
        (LDR_LITERAL, 2),
        (STR, 1),
        (STR_INDEXED, 2),
        (LDRD, 3),
        (LDM, 4),
        (PUSH, 4),
        (POP_PC, 4),
        (LDR_PC, 2),
        (TBB, 2),
        (BX, 1),
        (BEQ, 1),
        (CBZ, 1),
        (VADD, 1),
        (VMUL, 1),
        (VMLA, 3),
        (VDIV, 14),
        (VSQRT, 14),
        (VLDR, 2),
        (VLDR_DOUBLE, 3),
        (VSTR, 1),
        (VLDM, 4),
        (VPUSH, 3),
        (VMOV, 1),
        (VMOV_TWO, 2),
        (VCVT, 1),
    ] {
        assert_eq!(table(&[code]), cycles, "{code:02X?}");
    }
}

#[test]
fn a_division_of_integers_takes_2_to_12_cycles_by_the_setting() {
    let of = |setting| run_with(setting, &[(UDIV, Bus::None)]).table;
    assert_eq!(
        [Setting::OPTIMISTIC, Setting::NOMINAL, Setting::PESSIMISTIC].map(of),
        [2, 7, 12]
    );
}

#[test]
fn others_run_beside_a_division_of_the_floating_point_unit_and_its_own_wait() {
    let (beside, behind) = ([&[VDIV], [ADD; 13].as_slice()].concat(), [VDIV, ADD, VADD]);
    assert_eq!((table(&beside), table(&behind)), (14, 15));
    // What moves other registers does not wait, what moves the result does.
    assert_eq!(table(&[VDIV, ADD, VMOV]), 15);
    assert_eq!(table(&[VDIV, ADD, VLDR]), 16);
    assert_eq!(table(&[VDIV, VPUSH, ADD]), 14);
    // Its result is late once more for the instruction right behind it.
    assert_eq!(table(&[VDIV, VADD]), 15);
    assert_eq!(table(&[VDIV, VMUL]), 16);
    let code: Vec<_> = beside.iter().map(|code| (*code, Bus::None)).collect();
    assert_eq!(run_with(Setting::PESSIMISTIC, &code).table, 27);
}

/// Technical Reference Manual, 3.3.3: its own examples.
#[test]
fn loads_overlap_unless_the_next_address_hangs_on_them() {
    assert_eq!(table(&[LDR_R0, LDR_R2_R3]), 3);
    assert_eq!(table(&[LDR_R0, LDR_R2_R0]), 4);
    assert_eq!(table(&[LDR_R2_R3, LDR_R0, LDR_R2_R3]), 4);
    // A store of what was just loaded.
    assert_eq!(table(&[LDR_R0, STR]), 3);
    assert_eq!(table(&[LDR_R0, STR_INDEXED]), 3);
    // Nothing overlaps with a store before it, nor with several words.
    assert_eq!(table(&[STR, LDR_R2_R3]), 3);
    assert_eq!(table(&[LDRD, LDR_R2_R3]), 5);
    assert_eq!(table(&[LDR_R2_R3, LDM]), 6);
    assert_eq!(table(&[LDR_R2_R3, ADD, LDR_R0]), 5);
}

/// The same, 7.2.
#[test]
fn a_result_of_floating_point_arithmetic_is_a_cycle_late_for_the_next_instruction_alone() {
    assert_eq!(table(&[VADD, VMUL]), 3);
    assert_eq!(table(&[VADD, ADD, VMUL]), 3);
    assert_eq!(table(&[VADD, VMOV]), 3);
    assert_eq!(table(&[VADD, VSTR]), 3);
    assert_eq!(table(&[VDIV, VMUL]), 16);
    // As a factor; as the addend it is taken a cycle later.
    assert_eq!(table(&[VADD, VMLA]), 5);
    assert_eq!(table(&[VADD, VMLA_OF_S0]), 4);
    // What is loaded is there.
    assert_eq!(table(&[VLDR, VMUL]), 3);
}

/// Where it jumps to is what comes next elsewhere.
fn jump(setting: Setting, code: &[u8], to: u64, then: &[u8]) -> Cycles {
    let (jump, target) = (decoded(code, START), decoded(then, to));
    let ran = [(START, &jump), (to, &target)].map(|(at, instruction)| Ran {
        at,
        instruction,
        bus: Bus::None,
    });
    Core::new(setting).run(ran, |_, _| {})
}

#[test]
fn a_jump_costs_the_refill_and_a_cycle_where_its_target_lies_in_two_words() {
    let free = Setting::WITHOUT_WAIT_STATES;
    for (refill, setting) in [1, 2, 3].map(|refill| (refill, Setting { refill, ..free })) {
        assert_eq!(jump(setting, BX, START + 0x100, ADD).refill, refill);
        assert_eq!(jump(setting, BX, START + 0x102, ADD).refill, refill);
        assert_eq!(jump(setting, BX, START + 0x100, ADD_WIDE).refill, refill);
        assert_eq!(
            jump(setting, BX, START + 0x102, ADD_WIDE).refill,
            refill + 1
        );
    }
    assert_eq!(
        run_with(free, &[(BEQ, Bus::None), (ADD, Bus::None)]).refill,
        0
    );
}

#[test]
fn a_jump_to_another_line_waits_for_the_flash() {
    let cycles = jump(Setting::NOMINAL, BX, START + 0x100, ADD);
    // The first line; then the read ahead of the second, which began in the cycle in which the first was there, is finished first.
    assert_eq!((cycles.table, cycles.refill), (2, 2));
    assert!(cycles.fetch >= 10 && cycles.fetch <= 15, "{cycles:?}");
    let within = jump(Setting::NOMINAL, BX, START + 8, ADD);
    assert_eq!((within.fetch, within.refill), (5, 2));
}

#[test]
fn straight_code_of_wide_instructions_waits_for_its_lines_and_of_narrow_ones_hardly() {
    let stalls = |code: &'static [u8], bytes: usize| {
        let code = vec![(code, Bus::None); bytes / code.len()];
        run_with(Setting::NOMINAL, &code).fetch
    };
    // A line of four instructions runs in 4 cycles and is read in 6: two for each of the 16, and five for the first.
    let wide = stalls(ADD_WIDE, 256);
    assert!((30..=40).contains(&wide), "{wide}");
    // Of eight in 8.
    let narrow = stalls(ADD, 256);
    assert!((5..=8).contains(&narrow), "{narrow}");
}

/// The same from RAM, at an address.
fn from_ram(setting: Setting, start: u64, code: &[u8], count: u64) -> Cycles {
    let length = code.len() as u64;
    let decoded = decoded(code, start);
    let ran = (0..count).map(|k| Ran {
        at: start + k * length,
        instruction: &decoded,
        bus: Bus::None,
    });
    Core::new(setting).run(ran, |_, _| {})
}

#[test]
fn code_in_ram_waits_for_nothing_over_the_instruction_bus_and_every_other_cycle_over_the_system_bus()
 {
    for setting in Setting::ALL {
        assert_eq!(from_ram(setting, 0x100, ADD_WIDE, 64).fetch, 0);
        let system = from_ram(setting, 0x2000_0100, ADD_WIDE, 64).fetch;
        assert!((60..=70).contains(&system), "{system}");
    }
    let flash = from_ram(Setting::NOMINAL, START, ADD_WIDE, 64).fetch;
    assert!((30..=40).contains(&flash), "{flash}");
}

#[test]
fn data_in_the_block_of_the_code_wait_for_a_fetch_each_word() {
    let code = [
        (LDR_R0, Bus::CodeBlock),
        (STR, Bus::CodeBlock),
        (LDM, Bus::CodeBlock),
    ];
    let of = |setting| run_with(setting, &code).data;
    assert_eq!(Setting::ALL.map(of), [0, 5, 10]);
}

#[test]
fn data_in_the_flash_wait_once_for_a_line_and_always_without_the_cache() {
    let code = [
        (LDR_R0, Bus::Flash(0x0808_0000)),
        (ADD, Bus::None),
        (LDR_R0, Bus::Flash(0x0808_0004)),
    ];
    let cached = run_with(Setting::NOMINAL, &code).data;
    assert!((5..=10).contains(&cached), "{cached}");
    assert!(run_with(Setting::NOMINAL.writing(), &code).data >= cached + 5);
}

#[test]
fn a_read_over_a_slow_bus_waits_and_a_store_only_for_the_one_before() {
    const TIM3: u32 = 0x4000_0400;
    const TIM1: u32 = 0x4001_0000;
    let setting = Setting::WITHOUT_WAIT_STATES;
    let of = |code: &[(&[u8], Bus)]| run_with(setting, code).peripherals;
    assert_eq!(of(&[(LDR_R0, Bus::Read(TIM3))]), 9);
    assert_eq!(of(&[(LDR_R0, Bus::Read(TIM1))]), 5);
    // GPIO and DMA are on the core's own bus.
    assert_eq!(of(&[(LDR_R0, Bus::Read(0x4002_0010))]), 0);
    assert_eq!(of(&[(STR, Bus::Write(TIM1))]), 0);
    assert_eq!(of(&[(STR, Bus::Write(TIM1)), (STR, Bus::Write(TIM1))]), 5);
    assert_eq!(
        of(&[
            (STR, Bus::Write(TIM1)),
            (ADD, Bus::None),
            (ADD, Bus::None),
            (STR, Bus::Write(TIM1))
        ]),
        3
    );
}

#[test]
fn entry_takes_12_cycles_and_the_first_instruction_of_the_floating_point_unit_puts_its_registers_away()
 {
    let of = |code: &[&[u8]]| {
        let code: Vec<_> = code.iter().map(|code| (*code, Bus::None)).collect();
        run_with(Setting::NOMINAL, &code).entry
    };
    assert_eq!(of(&[ADD]), 12);
    assert_eq!(of(&[ADD, VADD, VMUL]), 12 + 18);
    // The vector is in flash.
    assert_eq!(
        run_with(Setting::PESSIMISTIC, &[(ADD, Bus::None)]).entry,
        12 + 5
    );
}

#[test]
fn places_in_memory_are_those_of_the_registers() {
    let mut registers = [0; 16];
    (registers[1], registers[2], registers[15]) = (0x2000_0000, 5, 0x0800_1002);
    for (code, at) in [
        (LDR_R0, Some(0x2000_0000)),
        (LDR_INDEXED, Some(0x2000_0014)),
        (LDR_AFTER, Some(0x2000_0000)),
        // The program counter is two instructions ahead, rounded down.
        (LDR_LITERAL, Some(0x0800_1014)),
        (ADD, None),
        // The stack is RAM, whatever its pointer says.
        (PUSH, None),
    ] {
        let place = decoded(code, START).place;
        assert_eq!(
            place.map(|place| address(&place, &registers)),
            at,
            "{code:02X?}"
        );
    }
    (registers[0], registers[15]) = (6, START as u32);
    let table = |code| {
        decoded(code, START)
            .place
            .map(|place| address(&place, &registers))
    };
    assert_eq!(
        (table(TBB), table(TBH)),
        (Some(START as u32 + 4 + 6), Some(START as u32 + 4 + 12))
    );
}

#[test]
fn what_jumps_is_known() {
    for (code, kind) in [
        (BX, Kind::JumpRegister),
        (BEQ, Kind::Jump),
        (CBZ, Kind::Jump),
        (POP_PC, Kind::JumpLoaded(3)),
        (LDR_PC, Kind::JumpLoaded(1)),
        (TBH, Kind::JumpLoaded(1)),
    ] {
        assert_eq!(decoded(code, START).kind, kind, "{code:02X?}");
    }
}

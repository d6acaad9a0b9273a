//! The proofs on the image: that they hold, that they would not if something were wrong, and that a run under load agrees with
//! them. Needs `cargo stage` first, then `cargo chip-test`.

use image::chip::{elf_file, load};
use image::proof::{
    CONTROL_LOOP, Code, Depths, Edge, Engine, Function, LEVELS, NESTING, ProofError, STACK_LEFT,
    Stack, Step, faults, vector_faults,
};
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroU64;

const HANDLER: &str = "TIM3";
/// The handler's address in a made-up image; the functions after it follow in steps of 2.
const START: u64 = 0x1000;
const LAST: &str = LEVELS[4].handlers[0];
const PANIC: &str = "core::panicking::panic_fmt";

/// A made-up image: names, frames, and numbers of the functions that each calls.
fn made_up(functions: &[(&str, u32, &[u64])]) -> Code {
    let at = |number: u64| START + 2 * number;
    let function = |(number, (name, frame, calls)): (usize, &(&str, u32, &[u64]))| {
        let edges = calls.iter().map(|to| Edge {
            to: at(*to),
            tail: false,
        });
        let function = Function {
            name: (*name).to_owned(),
            frame: *frame,
            edges: edges.collect(),
            ..Function::default()
        };
        (at(number as u64), function)
    };
    Code {
        functions: functions
            .iter()
            .enumerate()
            .map(function)
            .collect::<BTreeMap<_, _>>(),
        taken: BTreeSet::new(),
        handlers: BTreeSet::from([START]),
        stack: 65_536,
    }
}

fn function(code: &mut Code, number: u64) -> &mut Function {
    let function = code.functions.get_mut(&(START + 2 * number));
    function.expect("one of the made-up ones")
}

/// What is found in a made-up image, in words.
fn found(code: &Code) -> Vec<String> {
    faults(code, &[HANDLER])
        .iter()
        .map(ToString::to_string)
        .collect()
}

fn image_code() -> Code {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    Code::read(&path).expect("an image that is understood")
}

#[test]
fn the_control_loop_of_the_image_cannot_fail() {
    assert_eq!(faults(&image_code(), CONTROL_LOOP), []);
}

#[test]
fn every_exception_of_the_image_ends_in_a_handler_of_its_own_and_the_last_one_uses_no_stack() {
    assert_eq!(vector_faults(&image_code()), []);
}

#[test]
fn a_vector_of_nobody_and_a_last_handler_with_a_frame_are_found() {
    let mut code = made_up(&[("DefaultHandler_", 0, &[]), (LAST, 8, &[])]);
    let told: Vec<_> = vector_faults(&code)
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        told,
        [
            "a vector of nobody: DefaultHandler_".to_owned(),
            format!("a stack is used by: {LAST}")
        ]
    );
    function(&mut code, 1).frame = 0;
    code.handlers.clear();
    assert_eq!(vector_faults(&code), []);
}

#[test]
fn the_stack_of_the_image_leaves_room_and_no_run_under_load_comes_near_its_bound() {
    let stack = Stack::of(&image_code(), NESTING).expect("a bound");
    assert!(stack.left() >= STACK_LEFT, "{stack:?}");
    let rate = NonZeroU64::new(168_000_000).expect("some");
    let load = load(5_000, rate).expect("a run");
    println!("{load:?}, bound {}", stack.bytes);
    assert!(load.stack > stack.levels[1].bytes, "{load:?}");
    assert!(load.stack <= stack.bytes, "{load:?} {stack:?}");
    // Nothing holds the tick back: it starts with the next instruction but one, whatever the other side does.
    let (first, last) = load.cost.start_ns.expect("ticks");
    assert!(last - first <= 100, "{load:?}");
    assert!(load.bytes[0] > 15_000 && load.refused > 0, "{load:?}");
}

#[test]
fn a_way_to_a_panic_is_found_however_long_and_one_from_elsewhere_is_not() {
    let ways = |last: &[u64]| {
        let handler: &[u64] = &[1];
        let idle: &[u64] = &[3];
        found(&made_up(&[
            (HANDLER, 0, handler),
            ("a", 0, &[2]),
            ("b", 0, last),
            (PANIC, 0, &[]),
            ("idle", 0, idle),
        ]))
    };
    assert_eq!(ways(&[]), Vec::<String>::new());
    assert_eq!(ways(&[3]), [format!("panic: TIM3 -> a -> b -> {PANIC}")]);
}

#[test]
fn an_image_without_panics_or_without_the_handler_proves_nothing() {
    assert_eq!(found(&made_up(&[(HANDLER, 0, &[])])).len(), 1);
    assert_eq!(found(&made_up(&[(PANIC, 0, &[])])).len(), 1);
}

#[test]
fn traps_pointers_recursion_f64_and_fused_multiply_adds_are_found() {
    let mut code = made_up(&[
        (HANDLER, 0, &[1, 2]),
        ("__aeabi_dmul", 0, &[]),
        ("again", 0, &[3]),
        ("and again", 0, &[2]),
        (PANIC, 0, &[]),
    ]);
    function(&mut code, 2).traps.push(0x10);
    function(&mut code, 3).pointers.push(0x20);
    function(&mut code, 4).fused.push(0x30);
    let mut found = found(&code);
    found.sort();
    assert_eq!(
        found,
        [
            "arithmetic in f64: TIM3 -> __aeabi_dmul".to_owned(),
            "call through a pointer at 0x00000020: TIM3 -> again -> and again".to_owned(),
            format!("fused multiply-add at 0x00000030: {PANIC}"),
            "recursion through again: TIM3 -> again -> and again".to_owned(),
            "recursion through and again: TIM3 -> again".to_owned(),
            "trap at 0x00000010: TIM3 -> again".to_owned(),
        ]
    );
}

#[test]
fn code_of_the_loop_in_flash_and_addresses_of_the_flash_in_it_are_found() {
    let mut code = made_up(&[(HANDLER, 0, &[1]), ("in RAM", 0, &[]), (PANIC, 0, &[])]);
    let in_flash = 0x0800_2000;
    let edge = |to| Edge { to, tail: false };
    function(&mut code, 1).edges.insert(edge(in_flash));
    let other = Function {
        name: "in flash".to_owned(),
        ..Function::default()
    };
    code.functions.insert(in_flash, other);
    function(&mut code, 0).flash.push(0x20);
    assert_eq!(
        found(&code),
        [
            "an address of the flash at 0x00000020: TIM3".to_owned(),
            "code in flash: TIM3 -> in RAM -> in flash".to_owned(),
        ]
    );
    // Elsewhere it may be.
    function(&mut code, 0).flash.clear();
    function(&mut code, 1).edges.clear();
    function(&mut code, 2).flash.push(0x20);
    assert_eq!(found(&code), Vec::<String>::new());
}

#[test]
fn the_deepest_way_counts_and_a_tail_call_starts_from_nothing() {
    let mut code = made_up(&[
        (HANDLER, 100, &[1, 2]),
        ("shallow", 500, &[]),
        ("deep", 50, &[3]),
        ("deeper", 1_000, &[]),
    ]);
    let depth = |code: &Code| Depths::new(code).of(START, 0).expect("a depth");
    assert_eq!(depth(&code).bytes, 1_150);
    assert_eq!(depth(&code).path, [START, START + 4, START + 6]);
    let tail = |edge: &Edge| Edge {
        tail: true,
        ..*edge
    };
    let edges = function(&mut code, 2).edges.iter().map(tail).collect();
    function(&mut code, 2).edges = edges;
    assert_eq!(depth(&code).bytes, 1_100);
}

#[test]
fn calls_through_pointers_reach_every_function_whose_address_is_taken_as_deep_as_they_nest() {
    let mut code = made_up(&[
        (HANDLER, 10, &[]),
        ("format", 100, &[]),
        ("never pointed to", 5_000, &[]),
    ]);
    function(&mut code, 0).pointers.push(START);
    function(&mut code, 1).pointers.push(START + 2);
    code.taken.insert(START + 2);
    for nesting in 0..5 {
        let depth = Depths::new(&code).of(START, nesting).expect("a depth");
        assert_eq!(depth.bytes, 10 + 100 * u64::from(nesting));
    }
}

#[test]
fn what_has_no_bound_or_is_not_understood_is_no_depth() {
    let mut code = made_up(&[(HANDLER, 8, &[1]), ("a", 8, &[0])]);
    let depth = |code: &Code| Depths::new(code).of(START, NESTING);
    assert!(matches!(depth(&code), Err(ProofError::Recursion(_))));
    function(&mut code, 1).edges.clear();
    assert_eq!(depth(&code).expect("a depth").bytes, 16);
    function(&mut code, 1).unknown.push(START + 2);
    assert!(matches!(depth(&code), Err(ProofError::StackPointer(..))));
}

#[test]
fn a_handler_that_the_levels_do_not_know_is_refused() {
    let mut code = made_up(&[(HANDLER, 8, &[]), ("TIM2", 8, &[])]);
    assert!(Stack::of(&code, NESTING).is_ok());
    code.handlers.insert(START + 2);
    let stack = Stack::of(&code, NESTING);
    assert!(matches!(stack, Err(ProofError::Handler(name)) if name == "TIM2"));
}

/// Machine code that lies at 0x1000, byte by byte, and what it means.
const STEPS: [(&[u8], Step); 30] = [
    (b"\x10\xb5", Step::Grow(8)),                 // push {r4, lr}
    (b"\x2d\xe9\xf0\x4f", Step::Grow(36)),        // push.w {r4-r11, lr}
    (b"\x2d\xed\x04\x8b", Step::Grow(16)),        // vpush {d8, d9}
    (b"\x2d\xed\x02\x8a", Step::Grow(8)),         // vpush {s16, s17}
    (b"\x84\xb0", Step::Grow(16)),                // sub sp, #16
    (b"\xad\xf5\x14\x7d", Step::Grow(592)),       // sub.w sp, sp, #592
    (b"\x4d\xf8\x04\x0d", Step::Grow(4)),         // str r0, [sp, #-4]!
    (b"\x6d\xe9\x02\x01", Step::Grow(8)),         // strd r0, r1, [sp, #-8]!
    (b"\x8d\xe8\x2e\x00", Step::Plain),           // stm.w sp, {r1, r2, r3, r5}
    (b"\x04\xb0", Step::Plain),                   // add sp, #16
    (b"\x10\xbd", Step::Plain),                   // pop {r4, pc}
    (b"\x70\x47", Step::Plain),                   // bx lr
    (b"\xdf\xe8\x00\xf0", Step::Plain),           // tbb [pc, r0]
    (b"\xbd\x46", Step::StackUnknown),            // mov sp, r7
    (b"\x90\x47", Step::CallPointer),             // blx r2
    (b"\x18\x47", Step::JumpPointer),             // bx r3
    (b"\x87\x46", Step::JumpPointer),             // mov pc, r0
    (b"\xd0\xf8\x00\xf0", Step::JumpPointer),     // ldr.w pc, [r0]
    (b"\x00\xf0\x00\xf8", Step::Call(0x1004)),    // bl
    (b"\xfe\xe7", Step::Jump(0x1000)),            // b
    (b"\xfe\xd1", Step::Jump(0x1000)),            // bne
    (b"\x00\xb1", Step::Jump(0x1004)),            // cbz r0
    (b"\x00\xde", Step::Trap),                    // udf #0
    (b"\x80\xf3\x11\x88", Step::Mask),            // msr basepri, r0
    (b"\x72\xb6", Step::Mask),                    // cpsid i
    (b"\xa0\xee\x81\x0a", Step::Fused),           // vfma.f32 s0, s1, s2
    (b"\x04\x48", Step::Literal(0x1014)),         // ldr r0, [pc, #16]
    (b"\x5f\xf8\x04\x00", Step::Literal(0x1000)), // ldr.w r0, [pc, #-4]
    (b"\xdf\xed\x04\x7a", Step::Plain),           // vldr s15, [pc, #16]
    (b"\x48\x68", Step::Plain),                   // ldr r0, [r1, #4]
];

#[test]
fn every_kind_of_instruction_means_what_it_does() {
    let engine = Engine::new().expect("an engine");
    for (bytes, expected) in STEPS {
        let decoded = engine.decode(bytes, 0x1000).expect("an instruction");
        assert_eq!(decoded.step, expected, "{}", decoded.text);
        assert_eq!(decoded.length, bytes.len() as u64, "{}", decoded.text);
    }
    // An address in two halves: movw r0, #1, then movt r0, #0x800.
    let half = |bytes: &[u8]| engine.decode(bytes, 0).expect("an instruction").step;
    let (lower, upper) = (half(b"\x40\xf2\x01\x00"), half(b"\xc0\xf6\x00\x00"));
    let one_register = matches!(
        (&lower, &upper),
        (Step::Lower(to, 1), Step::Upper(same, 0x800)) if to == same
    );
    assert!(one_register, "{lower:?} {upper:?}");
    assert!(matches!(
        engine.decode(b"\xff\xff\xff\xff", 8),
        Err(ProofError::Bytes(8))
    ));
}

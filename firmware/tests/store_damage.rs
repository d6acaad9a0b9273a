//! What is not settings is never taken for them: damage is found and told, another firmware's settings are not misread.

mod flash_bench;

use crc::{CRC_32_ISO_HDLC, Crc};
use firmware::fault::FaultKind;
use firmware::parameters::Parameters;
use firmware::settings_store::SettingsStore;
use flash_bench::gcs_bench::Bench;
use flash_bench::{Flash, Kept, KeptBench, Random, fresh, kept, restore, write};

const SECTOR: usize = 1024;
const SPEED: u32 = 0x5450_0100;
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Some settings, kept one after the other.
fn used() -> KeptBench<SECTOR> {
    let mut bench = KeptBench::start(Flash::<SECTOR>::new());
    for speed in [150, 140, 130, 120, 110] {
        let lines = format!("SPA 1 {SPEED} {speed}\nWPA 100");
        assert_eq!(bench.error_after(&lines), "0");
        assert_eq!(bench.error_after("MAC BEG A\nMOV X 1\nMAC END"), "0");
    }
    bench
}

fn restored(flash: &Flash<SECTOR>) -> (Option<FaultKind>, Kept) {
    let mut panel = fresh();
    let problem = restore(&mut SettingsStore::new(flash.powered()), &mut panel);
    let found = kept(&panel, panel.parameters());
    (problem, found)
}

fn nothing_kept() -> Kept {
    kept(&fresh(), &Parameters::REFERENCE)
}

#[test]
fn a_flipped_bit_is_told_or_does_no_harm() {
    let flash = used().keeper.flash().powered();
    let (problem, whole) = restored(&flash);
    assert_eq!(problem, None);
    let (mut told, mut harmless) = (0, 0);
    for bit in 0..flash.bytes.len() * 8 {
        let mut flash = flash.powered();
        flash.bytes[bit / 8] ^= 1 << (bit % 8);
        match restored(&flash) {
            (None, found) => {
                assert_eq!(found, whole, "bit {bit}");
                harmless += 1;
            }
            (problem, found) => {
                assert_eq!(problem, Some(FaultKind::SettingsDamaged), "bit {bit}");
                assert_eq!(found, nothing_kept(), "bit {bit}");
                told += 1;
            }
        }
    }
    // The newest record's image and CRC, and nothing else.
    assert!(told > 8 * 20 && told < 8 * 60, "{told} of {harmless}");
}

/// A record as the store's head describes it, written by other hands.
fn record(generation: u32, image: &[u8]) -> Vec<u8> {
    let words = [0x3153_5054, generation, image.len() as u32];
    let mut head: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    head.extend(CRC.checksum(&head).to_le_bytes());
    let sealed: Vec<u8> = head.iter().chain(image).copied().collect();
    let mut record = [head.clone(), head, image.to_vec()].concat();
    record.resize(record.len().next_multiple_of(4), 0);
    record.extend(CRC.checksum(&sealed).to_le_bytes());
    record.extend([0; 4]);
    record
}

fn image(version: u16, parameters: &[(u32, f64)]) -> Vec<u8> {
    let mut image = version.to_le_bytes().to_vec();
    image.extend((parameters.len() as u16).to_le_bytes());
    for (id, value) in parameters {
        image.extend(id.to_le_bytes());
        image.extend(value.to_le_bytes());
    }
    image.push(0);
    if version > 2 {
        image.push(0);
    }
    image
}

/// A table of a repeated move with so many points, of which each byte is what `volts` says.
fn table(points: u16, volts: u8) -> Vec<u8> {
    let mut table = vec![1, 3];
    table.extend(b"OUT");
    // Frozen; a quarter at a time; trials.
    table.extend([1, 2, 9, 0, 0, 0]);
    for counts in [12.5_f32, 0.5, 0.75] {
        table.extend(counts.to_le_bytes());
    }
    table.extend(0x0123_4567_89AB_CDEF_u64.to_le_bytes());
    table.extend((u64::from(points) * 20 - 40).to_le_bytes());
    table.extend(20_u32.to_le_bytes());
    table.extend(points.to_le_bytes());
    table.extend(vec![volts; 6 * usize::from(points)]);
    table
}

/// What a command side that starts with this image tells of its tables.
fn tables_of(image: &[u8]) -> (Option<FaultKind>, String) {
    let mut bench = Bench::with(fresh());
    let mut keeper = SettingsStore::new(flash_with(&record(7, image)));
    let problem = keeper.restore(&mut bench.contents());
    bench.run(2);
    (problem, bench.say("ILC?\n"))
}

#[test]
fn tables_of_repeated_moves_are_as_described() {
    let mut with_table = image(3, &[(SPEED, 123.5)]);
    with_table.pop();
    let told = |points: u16| tables_of(&[&with_table[..], &table(points, 3)].concat());
    assert_eq!(
        told(30),
        (
            None,
            "OUT=frozen TRIALS=9 FIRST=12.500 BEST=0.500 LAST=0.750 POINTS=30 TICKS=20 KEPT=1\n"
                .to_owned()
        )
    );
    // One point less or more than it says, and one table more than there is.
    let damaged = (Some(FaultKind::SettingsDamaged), "\n".to_owned());
    let whole = [&with_table[..], &table(30, 3)].concat();
    assert_eq!(tables_of(&whole[..whole.len() - 1]), damaged);
    assert_eq!(tables_of(&[&whole[..], &[0; 6]].concat()), damaged);
    // More points than the pool has, a duration that does not go with them, an error that is no number, a state that is none.
    for (at, bytes) in [
        (with_table.len() + 5, [3_u8].to_vec()),
        (with_table.len() + 6, [5].to_vec()),
        (with_table.len() + 11, f32::NAN.to_le_bytes().to_vec()),
        (with_table.len() + 31, 600_u64.to_le_bytes().to_vec()),
        (with_table.len() + 39, 15_u32.to_le_bytes().to_vec()),
    ] {
        let mut wrong = whole.clone();
        wrong[at..at + bytes.len()].copy_from_slice(&bytes);
        assert_eq!(tables_of(&wrong), damaged, "{bytes:?} at {at}");
    }
}

fn flash_with(record: &[u8]) -> Flash<SECTOR> {
    let mut flash = Flash::new();
    flash.bytes[..record.len()].copy_from_slice(record);
    flash
}

fn value(found: &Kept, id: u32) -> f64 {
    let parameter = found.parameters.iter().find(|(other, _)| *other == id);
    parameter.expect("a parameter").1
}

#[test]
fn the_format_is_the_one_described() {
    // And the versions before, which an older firmware has left.
    for version in [3, 2, 1] {
        let flash = flash_with(&record(7, &image(version, &[(SPEED, 123.5)])));
        let (problem, found) = restored(&flash);
        assert_eq!(problem, None);
        assert_eq!(value(&found, SPEED), 123.5);
    }
}

#[test]
fn settings_of_a_newer_firmware_are_refused() {
    let flash = flash_with(&record(7, &image(5, &[(SPEED, 123.5)])));
    assert_eq!(
        restored(&flash),
        (Some(FaultKind::SettingsNewer), nothing_kept())
    );
}

#[test]
fn what_no_firmware_writes_is_damage() {
    let mut noise = Flash::new();
    noise.bytes.fill(0x5A);
    let too_many = flash_with(&record(0x8000_0000, &image(1, &[(SPEED, 123.5)])));
    for flash in [noise, too_many] {
        assert_eq!(
            restored(&flash),
            (Some(FaultKind::SettingsDamaged), nothing_kept())
        );
    }
}

#[test]
fn a_parameter_that_is_unknown_here_is_ignored_and_told() {
    let image = image(1, &[(0x5450_FFFF, 1.0), (SPEED, 123.5)]);
    let mut bench = KeptBench::start(flash_with(&record(7, &image)));
    assert_eq!(bench.bench.value(&format!("SPA? 1 {SPEED}")), 123.5);
    let events = bench.say("EVT?\n");
    assert!(
        events.contains("1 kept parameters are unknown here"),
        "{events}"
    );
}

/// The range of learning ended at 20 once, where no loop is stable.
#[test]
fn learning_that_is_too_fast_is_not_in_force() {
    const LEARNING: u32 = 0x5450_0303;
    let image = image(1, &[(LEARNING, 4.0), (SPEED, 123.5)]);
    let mut bench = KeptBench::start(flash_with(&record(7, &image)));
    assert_eq!(bench.bench.value(&format!("SPA? 1 {LEARNING}")), 1.0);
    assert_eq!(bench.bench.value(&format!("SPA? 1 {SPEED}")), 123.5);
    let told = "kept, not in force: 0x54500303 = 4, which may be 0 to 1\n";
    assert_eq!(bench.say("FLT?\n"), format!("0 no fault \n{told}"));
}

/// Firmware that did not look at what the drives bear has kept it.
#[test]
fn limits_that_the_drives_do_not_bear_are_in_force_and_told() {
    const PAYLOAD: u32 = 0x5450_0702;
    let image = image(1, &[(PAYLOAD, 5.0), (SPEED, 123.5)]);
    let mut bench = KeptBench::start(flash_with(&record(7, &image)));
    assert_eq!(bench.bench.value(&format!("SPA? 1 {PAYLOAD}")), 5.0);
    assert_eq!(bench.bench.value(&format!("SPA? 1 {SPEED}")), 123.5);
    let events = bench.say("EVT?\n");
    assert!(
        events.contains("limits over what motors and supply bear with this load"),
        "{events}"
    );
}

#[test]
fn a_value_out_of_its_range_is_told_and_the_others_are_taken() {
    const FOLLOWING_ERROR: u32 = 0x5450_0500;
    let image = image(1, &[(FOLLOWING_ERROR, 0.2), (SPEED, 123.5)]);
    let mut bench = KeptBench::start(flash_with(&record(7, &image)));
    let read = |bench: &mut KeptBench<SECTOR>, id: u32| bench.bench.value(&format!("SPA? 1 {id}"));
    assert_eq!(read(&mut bench, SPEED), 123.5);
    assert_eq!(read(&mut bench, FOLLOWING_ERROR), 2e-3);
    let told = "kept, not in force: 0x54500500 = 0.2, which may be 0.00002 to 0.05\n";
    assert_eq!(bench.say("FLT?\n"), format!("0 no fault \n{told}"));
    let event = "kept parameter 0x54500500 = 0.2 is out of its range: not in force";
    assert!(bench.say("EVT?\n").contains(event));
    // A macro is kept besides, and nothing is lost by that: all of it is there after the next start.
    bench.say("MAC BEG a\nMOV X 1\nMAC END\n");
    bench.say("");
    let mut bench = KeptBench::start(bench.keeper.flash().powered());
    assert_eq!(bench.say("MAC?\n"), "a\n");
    assert_eq!(bench.say("FLT?\n"), format!("0 no fault \n{told}"));
    // Nor by a table of a repeated move.
    assert_eq!(bench.error_after("ILC LEARN a\nMOV X 0.1"), "0");
    bench.bench.run(2_000);
    assert_eq!(bench.error_after("ILC KEEP a"), "0");
    let mut bench = KeptBench::start(bench.keeper.flash().powered());
    assert!(bench.say("ILC?\n").starts_with("a=learning "));
    assert_eq!(bench.say("FLT?\n"), format!("0 no fault \n{told}"));
    // What is in force is kept when somebody asks for that, and then that is all.
    assert_eq!(bench.bench.error_after("WPA 100"), "");
    bench.say("");
    assert_eq!(bench.say("ERR?\nFLT?\n"), "0\n0 no fault\n");
    let mut bench = KeptBench::start(bench.keeper.flash().powered());
    assert_eq!(bench.say("FLT?\n"), "0 no fault\n");
    assert_eq!(read(&mut bench, SPEED), 123.5);
}

#[test]
fn what_cannot_be_in_force_is_damage() {
    // Not a number; two that do not go together; an image that goes on; one that ends early.
    let mut longer = image(1, &[(SPEED, 123.5)]);
    longer.push(0);
    let mut shorter = image(1, &[(SPEED, 123.5)]);
    shorter.pop();
    // A macro, and a byte too many behind it.
    let mut with_macro = image(1, &[]);
    with_macro.pop();
    with_macro.extend([1, 1, b'A', 8, 0]);
    with_macro.extend(b"MOV X 1\n\0");
    let images = [
        with_macro,
        image(1, &[(SPEED, f64::NAN)]),
        image(1, &[(0x1600_0201, 100.0), (0x5450_0900, 200.0)]),
        longer,
        shorter,
        Vec::new(),
    ];
    for image in images {
        let flash = flash_with(&record(7, &image));
        assert_eq!(
            restored(&flash),
            (Some(FaultKind::SettingsDamaged), nothing_kept()),
            "{image:?}"
        );
    }
}

#[test]
fn any_content_at_all_leaves_parameters_that_go_together() {
    let mut random = Random(5);
    let seed = used().keeper.flash().powered();
    for case in 0..3_000 {
        let mut flash = seed.powered();
        match case % 3 {
            // Noise, noise that is short, and settings with a stretch of noise.
            0 => flash
                .bytes
                .iter_mut()
                .for_each(|byte| *byte = random.bits() as u8),
            1 => {
                flash = Flash::new();
                let length = 1 + random.below(200);
                let at = random.below(flash.bytes.len() - length);
                for byte in &mut flash.bytes[at..at + length] {
                    *byte = random.bits() as u8;
                }
            }
            _ => {
                let at = random.below(flash.bytes.len() - 64);
                for byte in &mut flash.bytes[at..at + 1 + random.below(63)] {
                    *byte = random.bits() as u8;
                }
            }
        }
        let mut panel = fresh();
        let mut keeper = SettingsStore::new(flash);
        let problem = restore(&mut keeper, &mut panel);
        assert!(panel.parameters().are_sound(), "case {case}");
        if problem.is_some() {
            assert_eq!(kept(&panel, panel.parameters()), nothing_kept());
        }
        // Whatever was there, settings can be kept from now on.
        assert_eq!(write(&mut keeper, &mut panel), Ok(()), "case {case}");
        assert_eq!(restore(&mut keeper, &mut fresh()), None, "case {case}");
    }
}

/// A byte that does not take what is written is found by reading back, wherever it lies.
#[test]
fn a_byte_that_is_stuck_is_passed_over() {
    for stuck in 0..80 {
        let mut flash = Flash::<SECTOR>::new();
        flash.stuck = Some(stuck);
        let mut bench = KeptBench::start(flash);
        let lines = format!("SPA 1 {SPEED} 123\nWPA 100");
        assert_eq!(bench.error_after(&lines), "0", "byte {stuck}");
        let (problem, found) = restored(bench.keeper.flash());
        assert_eq!(
            (problem, value(&found, SPEED)),
            (None, 123.0),
            "byte {stuck}"
        );
    }
}

#[test]
fn a_sector_that_is_worn_out_is_passed_over() {
    for worn in 0..flash_bench::SECTORS {
        let mut flash = Flash::<SECTOR>::new();
        flash.worn = Some(worn);
        let mut bench = KeptBench::start(flash);
        for speed in 100..180 {
            let lines = format!("SPA 1 {SPEED} {speed}\nWPA 100");
            assert_eq!(bench.error_after(&lines), "0", "{speed}, sector {worn}");
            let (problem, found) = restored(bench.keeper.flash());
            assert_eq!(problem, None);
            assert_eq!(value(&found, SPEED), f64::from(speed));
        }
    }
}

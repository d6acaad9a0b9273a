//! A fuzz target: a controller that starts with any content of its flash, above all with what is nearly settings.
//!
//! Nothing panics, parameters are sound and each in its range, macros can be printed; what cannot be used leaves the
//! controller's own settings; and settings can be kept afterwards, whatever was there.

use crc::{CRC_32_ISO_HDLC, Crc};
use firmware::fault::FaultKind;
use firmware::gcs::{Interpreter, PARAMETERS};
use firmware::iterative_learning::TrialControl;
use firmware::parameters::Parameters;
use firmware::settings_store::SettingsStore;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::random::Random;
use hal_sim::rig::{ControllerMemory, IDENTITY};

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
const SECTOR: usize = 16 << 10;

/// Carries out a case.
///
/// # Panics
/// When something did not hold; the message says what.
pub fn run(seed: u64) {
    let mut random = Random::new(seed);
    let mut content = Vec::new();
    for _ in 0..=random.index(4) {
        let image = image(&mut random);
        content.extend(record(&mut random, &image));
        if random.once_in(4) {
            content.resize(content.len().next_multiple_of(SECTOR), 0xFF);
        }
    }
    for _ in 0..random.index(4) {
        let at = random.index(content.len());
        content[at] = random.bits() as u8;
    }
    let mut settings_store = SettingsStore::new(SettingsFlash::holding(&content));
    let [mut memory, mut other] = [ControllerMemory::new(), ControllerMemory::new()];
    let (mut trial, mut other) = (memory.split().1.trial, other.split().1.trial);
    let (mut interpreter, problem) = started(&mut settings_store, &mut trial);
    check(&interpreter, problem);
    let contents = interpreter.contents(&mut trial);
    assert_eq!(settings_store.write(&contents), Ok(()));
    let (again, problem) = started(&mut settings_store, &mut other);
    assert_eq!(problem, None);
    for parameter in PARAMETERS {
        let [now, before] =
            [&again, &interpreter].map(|p| parameter.number(p.parameters_to_store()));
        assert_eq!(now, before, "{:x}", parameter.id);
    }
    assert!(again.macros().eq(interpreter.macros()));
    assert!((again.repeated_moves()).eq(interpreter.repeated_moves()));
}

fn started(
    settings_store: &mut SettingsStore<SettingsFlash>,
    trial: &mut TrialControl<'_>,
) -> (Interpreter, Option<FaultKind>) {
    let mut interpreter = Interpreter::new(&Parameters::REFERENCE, IDENTITY);
    let problem = settings_store.restore(&mut interpreter.contents(trial));
    (interpreter, problem)
}

fn check(interpreter: &Interpreter, problem: Option<FaultKind>) {
    let parameters = interpreter.parameters();
    assert!(parameters.are_sound());
    for parameter in PARAMETERS.iter().filter(|p| !p.is_read_only()) {
        let value = parameter.number(parameters).expect("a number");
        // Units are changed on the way, so an end of a range may be rounded past.
        let [lowest, highest] = parameter.range;
        let slack = 1e-9 * (highest - lowest);
        let within = (lowest - slack..=highest + slack).contains(&value);
        assert!(within, "{:x}: {value}", parameter.id);
    }
    for (_, text) in interpreter.macros() {
        assert!(text.iter().all(|byte| matches!(byte, b' '..=b'~' | b'\n')));
    }
    if problem.is_some() {
        assert_eq!(*parameters, Parameters::REFERENCE);
        assert_eq!(interpreter.macros().count(), 0);
        assert_eq!(interpreter.repeated_moves().count(), 0);
    }
}

/// An image in an envelope that is whole, as a rule.
fn record(random: &mut Random, image: &[u8]) -> Vec<u8> {
    let generation = match random.index(8) {
        0 => random.bits() as u32,
        _ => random.index(10) as u32,
    };
    let words = [0x3153_5054, generation, image.len() as u32];
    let mut head: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    head.extend(CRC.checksum(&head).to_le_bytes());
    let sealed = [&head[..], image].concat();
    let mut record = [&head[..], &head[..], image].concat();
    record.resize(record.len().next_multiple_of(4), 0);
    record.extend(CRC.checksum(&sealed).to_le_bytes());
    record.extend(if random.once_in(8) { [0xFF; 4] } else { [0; 4] });
    record
}

fn image(random: &mut Random) -> Vec<u8> {
    let version = if random.once_in(10) {
        random.bits() as u16
    } else {
        1 + random.index(3) as u16
    };
    let mut image = version.to_le_bytes().to_vec();
    let count = random.index(12);
    image.extend((count as u16).to_le_bytes());
    for _ in 0..count {
        let parameter = random.pick(PARAMETERS);
        let id = if random.once_in(10) {
            random.bits() as u32
        } else {
            parameter.id
        };
        let [lowest, highest] = parameter.range;
        let value = match random.index(40) {
            0 => f64::from_bits(random.bits()),
            1 => highest * 2.0,
            2 => lowest,
            3 => highest,
            _ => parameter.number(&Parameters::REFERENCE).unwrap_or_default(),
        };
        image.extend(id.to_le_bytes());
        image.extend(value.to_le_bytes());
    }
    let count = random.index(20);
    image.push(count as u8);
    for _ in 0..count {
        let name = format!("macro_{}", random.index(40));
        let text = "MOV X 1\n".repeat(random.index(100));
        image.push(name.len() as u8);
        image.extend(name.as_bytes());
        image.extend((text.len() as u16).to_le_bytes());
        image.extend(text.as_bytes());
    }
    if version == 3 {
        moves(random, &mut image);
    }
    for _ in 0..random.index(2) {
        let at = random.index(image.len());
        image[at] = random.bits() as u8;
    }
    image
}

/// Tables of repeated moves, nearly as they are stored.
fn moves(random: &mut Random, image: &mut Vec<u8>) {
    let count = random.index(10);
    image.push(count as u8);
    for number in 0..count {
        let (ticks, spacing) = (
            random.index(3_000) as u64,
            10 * (1 + random.index(9)) as u32,
        );
        let points = (ticks + 40).div_ceil(spacing.into());
        let name = format!("move_{number}");
        image.push(name.len() as u8);
        image.extend(name.as_bytes());
        image.extend([random.index(3) as u8, random.index(5) as u8]);
        image.extend(7_u32.to_le_bytes());
        for counts in [5.0_f32, 1.0, 1.5] {
            image.extend(counts.to_le_bytes());
        }
        image.extend(random.bits().to_le_bytes());
        image.extend(ticks.to_le_bytes());
        image.extend(spacing.to_le_bytes());
        image.extend((points as u16).to_le_bytes());
        for _ in 0..3 * points {
            image.extend((random.bits() as u16).to_le_bytes());
        }
    }
}

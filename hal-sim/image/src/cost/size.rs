//! What the image `stage` takes of flash and RAM, by part: the sizes of its symbols, summed by crate and, of the firmware,
//! by module.
//!
//! What the compiler has inlined counts where it was inlined to. Constants without a symbol of their own have no owner.

use object::{Object, ObjectSection, ObjectSymbol, SectionKind};
use std::collections::BTreeMap;
use std::path::Path;

/// Bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bytes {
    /// In flash: code, constants, and what RAM starts from.
    pub flash: u64,
    /// In RAM, without the stack, which has a memory of its own.
    pub ram: u64,
}

/// An image's sizes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// By part.
    pub parts: BTreeMap<String, Bytes>,
    /// All of it.
    pub total: Bytes,
    /// Who built it, as the image says.
    pub compiler: String,
}

/// The motion generator's parts.
pub const GENERATOR: [&str; 2] = ["motion", "planners"];
/// The section of what runs from RAM.
const CONTROL_LOOP: &str = ".control_loop";
const NAMELESS: &str = "constants and fill";
const RUNTIME: &str = "compiler's runtime";

impl Sizes {
    /// Reads an image.
    ///
    /// # Errors
    /// What is wrong with the file, in words.
    pub fn read(path: &Path) -> Result<Self, String> {
        let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
        let file = object::File::parse(&*bytes).map_err(|error| error.to_string())?;
        let total = (file.sections())
            .map(|section| taken(&section, section.size()))
            .fold(Bytes::default(), Bytes::plus);
        Ok(Self {
            parts: parts(&file, total),
            total,
            compiler: compiler(&file),
        })
    }

    /// Code of the motion generator, with the constants that have a name.
    pub fn generator(&self) -> u64 {
        let bytes = |part| self.parts.get(part).map_or(0, |bytes: &Bytes| bytes.flash);
        GENERATOR.into_iter().map(bytes).sum()
    }
}

impl Bytes {
    fn plus(self, other: Self) -> Self {
        Self {
            flash: self.flash + other.flash,
            ram: self.ram + other.ram,
        }
    }

    fn minus(self, other: Self) -> Self {
        Self {
            flash: self.flash.saturating_sub(other.flash),
            ram: self.ram.saturating_sub(other.ram),
        }
    }
}

/// What so many bytes of a section take. What RAM starts from lies in flash too, and so does code that is copied there.
fn taken(section: &object::Section<'_, '_>, bytes: u64) -> Bytes {
    let (flash, ram) = match section.kind() {
        _ if section.name() == Ok(CONTROL_LOOP) => (bytes, bytes),
        SectionKind::Text | SectionKind::ReadOnlyData | SectionKind::ReadOnlyString => (bytes, 0),
        SectionKind::Data => (bytes, bytes),
        SectionKind::UninitializedData => (0, bytes),
        _ => (0, 0),
    };
    Bytes { flash, ram }
}

fn parts(file: &object::File<'_>, total: Bytes) -> BTreeMap<String, Bytes> {
    // Aliases share an address.
    let mut symbols = BTreeMap::new();
    for symbol in file.symbols().filter(|symbol| symbol.size() > 0) {
        // The compiler's own names, some of which span named variables.
        if symbol.name().is_ok_and(|name| name.starts_with(".L")) {
            continue;
        }
        let section = symbol.section_index();
        let Some(section) = section.and_then(|index| file.section_by_index(index).ok()) else {
            continue;
        };
        let part = part(symbol.name().unwrap_or_default());
        let bytes = taken(&section, symbol.size());
        symbols.entry(symbol.address()).or_insert((part, bytes));
    }
    let mut parts: BTreeMap<String, Bytes> = BTreeMap::new();
    let mut named = Bytes::default();
    for (part, bytes) in symbols.into_values() {
        named = named.plus(bytes);
        let sum = parts.entry(part).or_default();
        *sum = sum.plus(bytes);
    }
    parts.insert(NAMELESS.to_owned(), total.minus(named));
    parts
}

/// The part a symbol belongs to: its crate, and of the firmware its module.
fn part(symbol: &str) -> String {
    let name = format!("{:#}", rustc_demangle::demangle(symbol));
    // `<firmware::motion::Motion as core::clone::Clone>::clone` belongs to the type, `<f64 as core::fmt::Debug>::fmt` to the
    // trait: a primitive type has no crate.
    let name = name.trim_start_matches(['<', '&', '[', '(']);
    let path = match name.split_once(" as ") {
        Some((primitive, of_trait)) if !primitive.contains("::") => of_trait,
        _ => name,
    };
    let mut steps = path.split("::");
    let first = steps.next().unwrap_or_default();
    match (first, steps.next()) {
        ("compiler_builtins", _) | (_, None) => RUNTIME.to_owned(),
        ("firmware", Some(module)) => format!("firmware::{module}"),
        (first, _) => first.to_owned(),
    }
}

/// Who built the image: the compiler's line in `.comment`.
fn compiler(file: &object::File<'_>) -> String {
    let comment = file.section_by_name(".comment");
    let text = comment.and_then(|section| section.data().ok().map(<[u8]>::to_vec));
    let text = String::from_utf8_lossy(&text.unwrap_or_default()).into_owned();
    (text.split('\0'))
        .find(|line| line.starts_with("rustc"))
        .unwrap_or("unknown compiler")
        .to_owned()
}

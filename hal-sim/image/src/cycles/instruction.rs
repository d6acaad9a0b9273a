//! What the model of the core has to know of an instruction: its row of ARM's table, the registers it waits for and makes others
//! wait for, and where it goes in memory.

use super::registers::Registers;
use crate::proof::{Engine, ProofError};
use capstone::arch::DetailsArchInsn;
use capstone::arch::arm::{ArmInsn, ArmInsnDetail, ArmOperand, ArmOperandType, ArmReg, ArmShift};
use capstone::{Insn, RegId};

/// A row of ARM's table of cycles (Cortex-M4 Technical Reference Manual, 3.3 and 7.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// So many cycles, whatever comes before and after.
    Plain(u32),
    /// Arithmetic of the floating-point unit in so many cycles: its result is there a cycle after.
    Float(u32),
    /// Division of integers: 2 to 12 cycles, by the numbers.
    Divide,
    /// A division or a root of the floating-point unit.
    FloatDivide,
    /// Loads one word, or less: two cycles, one behind another load.
    Load,
    /// Stores one word, or less, at a place known by a register and a number: one cycle.
    Store,
    /// The same, the place known by two registers: two cycles, one behind a load.
    StoreIndexed,
    /// Loads or stores several words, one cycle and one each.
    Many(u32),
    /// A jump whose distance stands in it: a cycle, and the refill when it is taken.
    Jump,
    /// A jump to what a register says.
    JumpRegister,
    /// A jump to what memory says: so many words are loaded on the way.
    JumpLoaded(u32),
}

/// Where an instruction goes in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the register that it counts from; 15, the program counter, rounded down to a word.
    pub base: usize,
    /// A register that is added, shifted left so far.
    pub index: Option<(usize, u32)>,
    /// What is added.
    pub offset: i32,
    /// Whether it writes.
    pub writes: bool,
}

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Its length, bytes.
    pub length: u32,
    /// Its row of the table.
    pub kind: Kind,
    /// What it needs when it begins.
    pub reads: Registers,
    /// What it writes.
    pub writes: Registers,
    /// What makes its address.
    pub address: Registers,
    /// Where it goes in memory; `None` if it does not, or only over the stack pointer.
    pub place: Option<Place>,
    /// Whether it belongs to the floating-point unit.
    pub float: bool,
}

impl Instruction {
    /// Whether it moves words from or to memory.
    #[must_use]
    pub const fn is_transfer(&self) -> bool {
        matches!(
            self.kind,
            Kind::Load | Kind::Store | Kind::StoreIndexed | Kind::Many(_) | Kind::JumpLoaded(_)
        )
    }

    /// Whether it is one load that overlaps with a load or store behind it.
    #[must_use]
    pub const fn is_load(&self) -> bool {
        matches!(self.kind, Kind::Load)
    }

    /// Whether it may jump.
    #[must_use]
    pub const fn is_jump(&self) -> bool {
        matches!(
            self.kind,
            Kind::Jump | Kind::JumpRegister | Kind::JumpLoaded(_)
        )
    }

    /// Takes the first instruction of these bytes, which lie at an address, apart.
    ///
    /// # Errors
    /// Where they are none.
    pub fn decode(engine: &Engine, bytes: &[u8], at: u64) -> Result<Self, ProofError> {
        engine.look(bytes, at, instruction)
    }
}

const SP: usize = 13;
const PC: usize = 15;

fn instruction(insn: &Insn<'_>, detail: &ArmInsnDetail<'_>) -> Instruction {
    let operands: Vec<ArmOperand> = detail.operands().collect();
    let text = insn.op_str().unwrap_or_default();
    let name = insn.mnemonic().unwrap_or_default();
    let all: Vec<Registers> = operands.iter().map(register).collect();
    let place = place(name, text, &operands);
    let kind = kind(insn, name, &operands, &all);
    let address = place.map_or(Registers::default(), |place| {
        let index = place.index.map_or(Registers::default(), |(index, _)| {
            Registers::core(index as u32)
        });
        Registers::core(place.base as u32).with(index)
    });
    let (reads, writes) = reads_and_writes(name, kind, &all);
    Instruction {
        length: insn.bytes().len() as u32,
        kind,
        reads,
        writes,
        address,
        place: place.filter(|place| place.base != SP),
        float: name.starts_with('v'),
    }
}

fn kind(insn: &Insn<'_>, name: &str, operands: &[ArmOperand], all: &[Registers]) -> Kind {
    let of_list = |from: usize| all.iter().skip(from).map(|it| it.words()).sum();
    let to_pc = |from: usize| {
        all.iter()
            .skip(from)
            .any(|it| it.meets(Registers::core(PC as u32)))
    };
    let indexed = operands.iter().any(|operand| match operand.op_type {
        ArmOperandType::Mem(place) => place.index().0 != 0,
        _ => false,
    });
    match ArmInsn::from(insn.id().0) {
        ArmInsn::ARM_INS_B | ArmInsn::ARM_INS_BL | ArmInsn::ARM_INS_CBZ | ArmInsn::ARM_INS_CBNZ => {
            return Kind::Jump;
        }
        ArmInsn::ARM_INS_BX | ArmInsn::ARM_INS_BLX => return Kind::JumpRegister,
        ArmInsn::ARM_INS_TBB | ArmInsn::ARM_INS_TBH => return Kind::JumpLoaded(1),
        _ => {}
    }
    let starts = |names: &[&str]| names.iter().any(|it| name.starts_with(it));
    match name {
        _ if starts(&["pop"]) && to_pc(0) => Kind::JumpLoaded(of_list(0)),
        _ if starts(&["ldm"]) && to_pc(1) => Kind::JumpLoaded(of_list(1)),
        _ if starts(&["ldr"]) && to_pc(0) && !to_pc(1) => Kind::JumpLoaded(1),
        _ if starts(&["pop", "push", "vpop", "vpush"]) => Kind::Many(of_list(0)),
        _ if starts(&["ldm", "stm", "vldm", "vstm"]) => Kind::Many(of_list(1)),
        _ if starts(&["ldrd", "strd"]) => Kind::Many(2),
        _ if starts(&["vldr", "vstr"]) && of_list(0) > 1 => Kind::Many(2),
        _ if starts(&["ldr", "vldr"]) => Kind::Load,
        _ if starts(&["str", "vstr"]) && indexed => Kind::StoreIndexed,
        _ if starts(&["str", "vstr"]) => Kind::Store,
        _ if starts(&["sdiv", "udiv"]) => Kind::Divide,
        _ if starts(&["mla", "mls"]) => Kind::Plain(2),
        _ if starts(&["vdiv", "vsqrt"]) => Kind::FloatDivide,
        _ if starts(&[
            "vmla", "vmls", "vnmla", "vnmls", "vfma", "vfms", "vfnma", "vfnms",
        ]) =>
        {
            Kind::Float(3)
        }
        _ if starts(&["vadd", "vsub", "vmul", "vnmul", "vcvt"]) => Kind::Float(1),
        // Two words go over.
        _ if starts(&["vmov"]) && of_list(0) > 2 => Kind::Plain(2),
        _ if starts(&["dsb", "dmb", "isb"]) => Kind::Plain(4),
        _ if to_pc(0) && starts(&["mov", "add"]) => Kind::JumpRegister,
        _ => Kind::Plain(1),
    }
}

/// The registers of the floating-point unit that an instruction needs, and all that it writes.
fn reads_and_writes(name: &str, kind: Kind, all: &[Registers]) -> (Registers, Registers) {
    let union = |part: &[Registers]| {
        part.iter()
            .fold(Registers::default(), |sum, it| sum.with(*it))
    };
    let starts = |names: &[&str]| names.iter().any(|it| name.starts_with(it));
    let split = match kind {
        Kind::Store | Kind::StoreIndexed => 0,
        _ if starts(&[
            "vstm", "vpush", "push", "stm", "str", "vstr", "vcmp", "vmsr",
        ]) =>
        {
            0
        }
        _ if starts(&["vldm", "vpop", "pop", "ldm"]) => all.len(),
        _ if starts(&["ldrd"]) => 2,
        _ if starts(&["vmov"]) && all.len() > 2 => all.len() / 2,
        _ => 1,
    };
    let (written, read) = all.split_at(split.min(all.len()));
    // The addend of a multiplication with addition is its first register, and is taken a cycle later: none waits for it.
    (union(read), union(written))
}

fn place(name: &str, text: &str, operands: &[ArmOperand]) -> Option<Place> {
    let writes = name.starts_with("st") || name.starts_with("vst");
    if ["ldm", "vldm", "stm", "vstm"]
        .iter()
        .any(|it| name.starts_with(it))
    {
        let base = operands.first().and_then(number)?;
        return Some(Place {
            base,
            index: None,
            offset: 0,
            writes,
        });
    }
    let mem = operands.iter().find_map(|operand| match operand.op_type {
        ArmOperandType::Mem(mem) => Some((mem, operand.shift)),
        _ => None,
    });
    let (mem, shift) = mem?;
    let index = core(mem.index()).map(|index| match shift {
        ArmShift::Lsl(by) => (index, by),
        _ if name.starts_with("tbh") => (index, 1),
        _ => (index, 0),
    });
    // What is behind the bracket is added afterwards.
    let after = text.contains("], ");
    Some(Place {
        base: core(mem.base())?,
        index,
        offset: if after { 0 } else { mem.disp() },
        writes,
    })
}

fn register(operand: &ArmOperand) -> Registers {
    let ArmOperandType::Reg(RegId(id)) = operand.op_type else {
        return Registers::default();
    };
    let within = |first: u32, last: u32| {
        (first..=last)
            .contains(&u32::from(id))
            .then(|| u32::from(id) - first)
    };
    if let Some(single) = within(ArmReg::ARM_REG_S0, ArmReg::ARM_REG_S31) {
        Registers::single(single)
    } else if let Some(double) = within(ArmReg::ARM_REG_D0, ArmReg::ARM_REG_D15) {
        Registers::double(double)
    } else {
        core(RegId(id)).map_or(Registers::default(), |number| {
            Registers::core(number as u32)
        })
    }
}

fn number(operand: &ArmOperand) -> Option<usize> {
    match operand.op_type {
        ArmOperandType::Reg(id) => core(id),
        _ => None,
    }
}

/// The number of a register of the core.
fn core(RegId(id): RegId) -> Option<usize> {
    match u32::from(id) {
        ArmReg::ARM_REG_SP => Some(SP),
        ArmReg::ARM_REG_LR => Some(14),
        ArmReg::ARM_REG_PC => Some(PC),
        id @ ArmReg::ARM_REG_R0..=ArmReg::ARM_REG_R12 => Some((id - ArmReg::ARM_REG_R0) as usize),
        _ => None,
    }
}

/// Where a place lies, with the registers as they were when its instruction began, `r15` the instruction's own address.
#[must_use]
pub fn address(place: &Place, registers: &[u32; 16]) -> u32 {
    let base = match place.base {
        PC => (registers[PC] + 4) & !3,
        base => registers[base],
    };
    let index = place
        .index
        .map_or(0, |(index, shift)| registers[index] << shift);
    base.wrapping_add(index).wrapping_add_signed(place.offset)
}

//! What one instruction means to the proofs.

use super::error::ProofError;
use capstone::arch::arm::{
    ArchExtraMode, ArchMode, ArmInsn, ArmInsnDetail, ArmOperand, ArmOperandType, ArmReg,
};
use capstone::arch::{ArchDetail, BuildsCapstone, BuildsCapstoneExtraMode, DetailsArchInsn};
use capstone::{Capstone, Insn};

/// See the module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// A call of the function at an address.
    Call(u64),
    /// A jump, conditional or not.
    Jump(u64),
    /// A call through a register.
    CallPointer,
    /// A jump to what a register or a word of memory says; not a return.
    JumpPointer,
    /// The stack grows by so many bytes.
    Grow(u32),
    /// The stack pointer changes in a way that is not understood.
    StackUnknown,
    /// An instruction that raises a fault or a supervisor call.
    Trap,
    /// Interrupts are held back from here, or let through.
    Mask,
    /// A fused multiply-add.
    Fused,
    /// The lower half of an address goes into a register.
    Lower(u16, u32),
    /// The upper half of an address goes into a register.
    Upper(u16, u32),
    /// A word of the code, at an address, goes into a register.
    Literal(u64),
    /// Nothing of interest.
    Plain,
}

const SP: u16 = ArmReg::ARM_REG_SP as u16;
const PC: u16 = ArmReg::ARM_REG_PC as u16;
const LR: u16 = ArmReg::ARM_REG_LR as u16;

/// Takes machine code apart.
pub struct Engine(Capstone);

/// One instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// What it means.
    pub step: Step,
    /// Its length, bytes.
    pub length: u64,
    /// As it stands in memory, as many bytes as it has.
    pub bytes: [u8; 4],
    /// As it is written.
    pub text: String,
}

impl Engine {
    /// For the chip's core.
    ///
    /// # Errors
    /// None that the proofs can do anything about.
    pub fn new() -> Result<Self, ProofError> {
        let engine = Capstone::new()
            .arm()
            .mode(ArchMode::Thumb)
            .extra_mode([ArchExtraMode::MClass].into_iter())
            .detail(true)
            .build();
        let engine = engine.map_err(|error| ProofError::File(error.to_string()))?;
        Ok(Self(engine))
    }

    /// The first instruction of these bytes, which lie at an address.
    ///
    /// # Errors
    /// Where they are none.
    pub fn decode(&self, bytes: &[u8], at: u64) -> Result<Decoded, ProofError> {
        self.look(bytes, at, |instruction, arm| {
            let name = instruction.mnemonic().unwrap_or_default();
            let mut bytes = [0; 4];
            for (place, byte) in bytes.iter_mut().zip(instruction.bytes()) {
                *place = *byte;
            }
            Decoded {
                step: literal(instruction, arm, at).unwrap_or_else(|| step(instruction, arm)),
                bytes,
                length: instruction.bytes().len() as u64,
                text: format!("{name} {}", instruction.op_str().unwrap_or_default()),
            }
        })
    }

    /// What somebody makes of the first instruction of these bytes.
    ///
    /// # Errors
    /// Where they are none.
    pub fn look<T>(
        &self,
        bytes: &[u8],
        at: u64,
        make: impl FnOnce(&Insn<'_>, &ArmInsnDetail<'_>) -> T,
    ) -> Result<T, ProofError> {
        let none = || ProofError::Bytes(at);
        let found = self.0.disasm_count(bytes, at, 1).map_err(|_| none())?;
        let instruction = found.iter().next().ok_or_else(none)?;
        let detail = self.0.insn_detail(instruction).map_err(|_| none())?;
        let ArchDetail::ArmDetail(arm) = detail.arch_detail();
        Ok(make(instruction, &arm))
    }
}

/// Bytes of a general register, and of a double one of the floating-point unit.
const WORD: u32 = 4;

fn step(instruction: &Insn<'_>, detail: &ArmInsnDetail<'_>) -> Step {
    let operands: Vec<ArmOperand> = detail.operands().collect();
    let register = |at: usize| match operands.get(at)?.op_type {
        ArmOperandType::Reg(register) => Some(register.0),
        _ => None,
    };
    let number = || {
        operands
            .iter()
            .rev()
            .find_map(|operand| match operand.op_type {
                ArmOperandType::Imm(number) => Some(number as u32),
                _ => None,
            })
    };
    let target = number().map_or(0, u64::from);
    let first = register(0);
    let name = instruction.mnemonic().unwrap_or_default();
    match ArmInsn::from(instruction.id().0) {
        ArmInsn::ARM_INS_BL => Step::Call(target),
        ArmInsn::ARM_INS_B | ArmInsn::ARM_INS_CBZ | ArmInsn::ARM_INS_CBNZ => Step::Jump(target),
        ArmInsn::ARM_INS_BLX => Step::CallPointer,
        ArmInsn::ARM_INS_BX if first == Some(LR) => Step::Plain,
        ArmInsn::ARM_INS_BX => Step::JumpPointer,
        // A table of distances: they lead on within the function.
        ArmInsn::ARM_INS_TBB | ArmInsn::ARM_INS_TBH => Step::Plain,
        ArmInsn::ARM_INS_UDF | ArmInsn::ARM_INS_BKPT | ArmInsn::ARM_INS_SVC => Step::Trap,
        ArmInsn::ARM_INS_CPS => Step::Mask,
        ArmInsn::ARM_INS_MSR => special(instruction),
        ArmInsn::ARM_INS_PUSH => Step::Grow(WORD * operands.len() as u32),
        ArmInsn::ARM_INS_VPUSH => Step::Grow(operands.iter().map(float_bytes).sum()),
        ArmInsn::ARM_INS_STMDB if first == Some(SP) => {
            Step::Grow(WORD * (operands.len() as u32 - 1))
        }
        ArmInsn::ARM_INS_VSTMDB if first == Some(SP) => {
            Step::Grow(operands[1..].iter().map(float_bytes).sum())
        }
        ArmInsn::ARM_INS_SUB | ArmInsn::ARM_INS_SUBW if first == Some(SP) => {
            match (register(1), number()) {
                (None | Some(SP), Some(bytes)) => Step::Grow(bytes),
                _ => Step::StackUnknown,
            }
        }
        ArmInsn::ARM_INS_ADD | ArmInsn::ARM_INS_ADDW if first == Some(SP) => Step::Plain,
        ArmInsn::ARM_INS_POP | ArmInsn::ARM_INS_VPOP | ArmInsn::ARM_INS_LDM => Step::Plain,
        // To the disassembler `movw` is a `mov`, now and then.
        _ if name.starts_with("movw") => lower_or_upper(first, number(), Step::Lower),
        ArmInsn::ARM_INS_MOVT => lower_or_upper(first, number(), Step::Upper),
        _ if ["vfma", "vfms", "vfnma", "vfnms"]
            .iter()
            .any(|fused| name.starts_with(fused)) =>
        {
            Step::Fused
        }
        // A store has its source first, whatever it writes.
        _ if name.starts_with("str") || name.starts_with("vstr") || name.starts_with("stm") => {
            pushed(detail, &operands)
        }
        _ if first == Some(SP) && !compares(name) => Step::StackUnknown,
        _ if first == Some(PC) && !compares(name) => Step::JumpPointer,
        _ => Step::Plain,
    }
}

/// A load of a word of the code; not of the floating-point unit, whose words are no addresses.
fn literal(instruction: &Insn<'_>, detail: &ArmInsnDetail<'_>, at: u64) -> Option<Step> {
    let mut operands = detail.operands();
    let first = operands.next()?.op_type;
    let ArmOperandType::Mem(place) = operands.next()?.op_type else {
        return None;
    };
    let name = instruction.mnemonic().unwrap_or_default();
    let jumps = matches!(first, ArmOperandType::Reg(register) if register.0 == PC);
    // The program counter is two instructions ahead, rounded down.
    (name.starts_with("ldr") && place.base().0 == PC && !jumps)
        .then(|| Step::Literal(((at + 4) & !3).wrapping_add_signed(place.disp().into())))
}

/// A store that moves the stack pointer with it, `[sp, #-n]!`.
fn pushed(detail: &ArmInsnDetail<'_>, operands: &[ArmOperand]) -> Step {
    let place = operands.iter().find_map(|operand| match operand.op_type {
        ArmOperandType::Mem(place) => Some(place),
        _ => None,
    });
    match place {
        Some(place) if detail.writeback() && place.base().0 == SP => {
            if place.disp() < 0 {
                Step::Grow(place.disp().unsigned_abs())
            } else {
                Step::StackUnknown
            }
        }
        _ => Step::Plain,
    }
}

/// A write to a special register: those that hold interrupts back, and the stack pointers.
fn special(instruction: &Insn<'_>) -> Step {
    let operands = instruction.op_str().unwrap_or_default();
    if ["basepri", "primask", "faultmask"]
        .iter()
        .any(|mask| operands.starts_with(mask))
    {
        Step::Mask
    } else if operands.starts_with("msp") || operands.starts_with("psp") {
        Step::StackUnknown
    } else {
        Step::Plain
    }
}

fn lower_or_upper(register: Option<u16>, number: Option<u32>, half: fn(u16, u32) -> Step) -> Step {
    match (register, number) {
        (Some(register), Some(number)) => half(register, number),
        _ => Step::Plain,
    }
}

fn compares(name: &str) -> bool {
    ["cmp", "cmn", "tst", "teq"]
        .iter()
        .any(|it| name.starts_with(it))
}

/// Bytes of a register of the floating-point unit: `d0` to `d31` are two words.
fn float_bytes(operand: &ArmOperand) -> u32 {
    let double = ArmReg::ARM_REG_D0 as u16..=ArmReg::ARM_REG_D31 as u16;
    match operand.op_type {
        ArmOperandType::Reg(register) if double.contains(&register.0) => 2 * WORD,
        _ => WORD,
    }
}

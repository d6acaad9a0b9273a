#!/usr/bin/env python3
"""The image's copy of words (`__aeabi_memcpy4` and `8`), on its own: every length up to 300 bytes and some as long as a plan. It has to
copy those bytes, no other, and to keep the registers that a function keeps.

    word_copy.py IMAGE
"""

import argparse
import pathlib
import random
import sys

from elftools.elf.elffile import ELFFile
from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn import arm_const as arm

CODE_BYTES, DATA, DATA_BYTES, STACK = 1 << 20, 0x2000_0000, 1 << 16, 0x1000_0000
# Where it returns to, and what stands there.
RETURN, ENDLESS = 0x6000_0000, b"\xfe\xe7"
GIVEN = (arm.UC_ARM_REG_R0, arm.UC_ARM_REG_R1, arm.UC_ARM_REG_R2, arm.UC_ARM_REG_LR)
KEPT = (*range(arm.UC_ARM_REG_R4, arm.UC_ARM_REG_R11 + 1), arm.UC_ARM_REG_SP)
FROM, TO = DATA + 0x100, DATA + 0x4000
SEED = 1


def check(uc, function, length, source, target):
    """What is wrong with a copy of so many bytes, or nothing."""
    before = random.randbytes(DATA_BYTES)
    uc.mem_write(DATA, before)
    for number, register in enumerate(KEPT[:-1]):
        uc.reg_write(register, 0xA5A5_0000 + number)
    uc.reg_write(arm.UC_ARM_REG_SP, STACK + 0x800)
    for register, value in zip(GIVEN, (target, source, length, RETURN | 1)):
        uc.reg_write(register, value)
    kept = [uc.reg_read(register) for register in KEPT]
    uc.emu_start(function | 1, 0xFFFF_FFFF)
    wanted = bytearray(before)
    wanted[target - DATA : target - DATA + length] = before[source - DATA : source - DATA + length]
    if uc.mem_read(DATA, DATA_BYTES) != wanted:
        return "other bytes"
    if [uc.reg_read(register) for register in KEPT] != kept:
        return "other registers"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("image", type=pathlib.Path)
    elf = ELFFile(parser.parse_args().image.open("rb"))
    uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
    uc.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M4)
    for start, size in ((0, CODE_BYTES), (DATA, DATA_BYTES), (STACK, 0x1000), (RETURN, 0x1000)):
        uc.mem_map(start, size)
    uc.mem_write(RETURN, ENDLESS)
    uc.hook_add(UC_HOOK_BLOCK, lambda uc, *_: uc.emu_stop(), begin=RETURN, end=RETURN)
    loop = elf.get_section_by_name(".control_loop")
    uc.mem_write(loop["sh_addr"], loop.data())
    random.seed(SEED)
    lengths = list(range(301)) + [random.randrange(301, 2000) for _ in range(40)]
    for name in ("__aeabi_memcpy4", "__aeabi_memcpy8"):
        function = elf.get_section_by_name(".symtab").get_symbol_by_name(name)[0]["st_value"]
        for length in lengths:
            source, target = FROM + 4 * random.randrange(16), TO + 4 * random.randrange(16)
            wrong = check(uc, function, length, source, target)
            if wrong:
                print(f"{name}: {wrong}, {length} bytes from {source:#x} to {target:#x}, seed {SEED}")
                return 1
    print(f"copies of words: {len(lengths)} lengths by each of the two, bytes and registers as they have to be")
    return 0


if __name__ == "__main__":
    sys.exit(main())

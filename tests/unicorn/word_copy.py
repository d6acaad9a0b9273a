#!/usr/bin/env python3
"""The image's copy of words (`__aeabi_memcpy4` and `8`), on its own: every length up to 300 bytes and some as long as a plan. It has to
copy those bytes, no other, and to keep the registers that a function keeps.

    word_copy.py IMAGE
"""

import argparse
import pathlib
import random
import struct
import sys

from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_R0,
    UC_ARM_REG_R1,
    UC_ARM_REG_R2,
    UC_ARM_REG_R4,
    UC_ARM_REG_R5,
    UC_ARM_REG_R6,
    UC_ARM_REG_R7,
    UC_ARM_REG_R8,
    UC_ARM_REG_R9,
    UC_ARM_REG_R10,
    UC_ARM_REG_R11,
    UC_ARM_REG_SP,
    UC_CPU_ARM_CORTEX_M4,
)

CODE_BYTES, DATA, DATA_BYTES, STACK = 1 << 20, 0x2000_0000, 1 << 16, 0x1000_0000
# Where it returns to, and what stands there.
RETURN, ENDLESS = 0x6000_0000, b"\xfe\xe7"
KEPT = (
    UC_ARM_REG_R4,
    UC_ARM_REG_R5,
    UC_ARM_REG_R6,
    UC_ARM_REG_R7,
    UC_ARM_REG_R8,
    UC_ARM_REG_R9,
    UC_ARM_REG_R10,
    UC_ARM_REG_R11,
    UC_ARM_REG_SP,
)
FROM, TO = DATA + 0x100, DATA + 0x4000
SEED = 1
# Of sections: with bytes, the table of symbols; and code that is loaded.
PROGBITS, SYMTAB, CODE = 1, 2, 2 | 4


def sections(elf):
    """Type, flags, address, offset, size, link and bytes of an entry of all sections."""
    start, = struct.unpack_from("<I", elf, 32)
    size, count = struct.unpack_from("<HH", elf, 46)
    entries = (struct.unpack_from("<10I", elf, start + index * size) for index in range(count))
    return [(kind, flags, address, offset, length, link, each) for _, kind, flags, address, offset, length, link, _, _, each in entries]


def symbol(elf, name):
    """Where a function stands."""
    found = sections(elf)
    for kind, _, _, offset, length, link, each in found:
        if kind != SYMTAB:
            continue
        texts = found[link][3]
        for at in range(offset, offset + length, each):
            text, value = struct.unpack_from("<II", elf, at)
            end = elf.index(b"\0", texts + text)
            if elf[texts + text : end].decode() == name:
                return value
    raise SystemExit(f"{name} is not in the image")


def check(uc, function, length, source, target):
    """What is wrong with a copy of so many bytes, or nothing."""
    before = random.randbytes(DATA_BYTES)
    uc.mem_write(DATA, before)
    for number, register in enumerate(KEPT[:-1]):
        uc.reg_write(register, 0xA5A5_0000 + number)
    uc.reg_write(UC_ARM_REG_SP, STACK + 0x800)
    for register, value in ((UC_ARM_REG_R0, target), (UC_ARM_REG_R1, source), (UC_ARM_REG_R2, length), (UC_ARM_REG_LR, RETURN | 1)):
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
    elf = parser.parse_args().image.read_bytes()
    uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
    uc.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
    for start, size in ((0, CODE_BYTES), (DATA, DATA_BYTES), (STACK, 0x1000), (RETURN, 0x1000)):
        uc.mem_map(start, size)
    uc.mem_write(RETURN, ENDLESS)
    uc.hook_add(UC_HOOK_BLOCK, lambda uc, *_: uc.emu_stop(), begin=RETURN, end=RETURN)
    for kind, flags, address, offset, length, _, _ in sections(elf):
        if kind == PROGBITS and flags & CODE == CODE and address + length <= CODE_BYTES:
            uc.mem_write(address, elf[offset : offset + length])
    random.seed(SEED)
    lengths = list(range(301)) + [random.randrange(301, 2000) for _ in range(40)]
    for name in ("__aeabi_memcpy4", "__aeabi_memcpy8"):
        function = symbol(elf, name)
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

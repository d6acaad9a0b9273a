#!/usr/bin/env python3
"""The image's test of its RAM at the start (`__pre_init`), on its own: sound memories pass and hold what they held, but for the
control loop's code, which is copied there. With a bit that stays set, or clear, wherever it is, the program must end at
`tripivot_ram_fault` with that word's address.

    ram_test.py IMAGE
"""

import argparse
import pathlib
import random
import struct
import sys

from elftools.elf.elffile import ELFFile
from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_HOOK_MEM_READ, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn import arm_const as arm

FLASH, PERIPHERALS = (0x0800_0000, 1 << 20), (0x4000_0000, 0x8_0000)
MEMORIES = ((0x2000_0000, 192 << 10), (0x1000_0000, 64 << 10))
# Where it returns to, and what stands there.
RETURN, ENDLESS = 0x6000_0000, b"\xfe\xe7"
BITS = 40
SEED = 1


class Chip:
    """As a reset leaves it."""

    def __init__(self, elf, contents):
        self.uc = uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        uc.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M4)
        for start, size in (FLASH, PERIPHERALS, *MEMORIES, (RETURN, 0x1000)):
            uc.mem_map(start, size)
        uc.mem_write(RETURN, ENDLESS)
        for segment in elf.iter_segments("PT_LOAD"):
            uc.mem_write(segment["p_paddr"], segment.data())
        for (start, _), content in zip(MEMORIES, contents):
            uc.mem_write(start, content)
        self.symbols = elf.get_section_by_name(".symtab")
        for end in (RETURN, self.address("tripivot_ram_fault")):
            uc.hook_add(UC_HOOK_BLOCK, lambda uc, *_: uc.emu_stop(), begin=end, end=end)

    def address(self, name):
        return self.symbols.get_symbol_by_name(name)[0]["st_value"] & ~1

    def hold(self, address, bit, value):
        """A bit that stays so, whatever is written."""

        def read(uc, *_):
            (word,) = struct.unpack("<I", uc.mem_read(address, 4))
            word = word | 1 << bit if value else word & ~(1 << bit)
            uc.mem_write(address, struct.pack("<I", word))

        self.uc.hook_add(UC_HOOK_MEM_READ, read, begin=address, end=address + 3)

    def run(self):
        """Where it ends, and what is in r0 then."""
        self.uc.reg_write(arm.UC_ARM_REG_LR, RETURN | 1)
        self.uc.emu_start(self.address("__pre_init") | 1, 0xFFFF_FFFF)
        return self.uc.reg_read(arm.UC_ARM_REG_PC) & ~1, self.uc.reg_read(arm.UC_ARM_REG_R0)


def wrong_with_sound(elf, contents):
    """What is wrong with the run of a sound chip, or nothing."""
    chip = Chip(elf, contents)
    if chip.run()[0] != RETURN:
        return "a sound chip does not come through"
    loop = elf.get_section_by_name(".control_loop")
    wanted = [bytearray(content) for content in contents]
    wanted[0][loop["sh_addr"] : loop["sh_addr"] + loop["sh_size"]] = loop.data()
    for (start, size), content in zip(MEMORIES, wanted):
        if chip.uc.mem_read(start, size) != content:
            return f"other contents from {start:#x} on"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("image", type=pathlib.Path)
    elf = ELFFile(parser.parse_args().image.open("rb"))
    random.seed(SEED)
    contents = [random.randbytes(size) for _, size in MEMORIES]
    wrong = wrong_with_sound(elf, contents)
    edges = [address for start, size in MEMORIES for address in (start, start + size - 4)]
    somewhere = [start + 4 * random.randrange(size // 4) for start, size in MEMORIES * (BITS // 2)]
    for address in edges + somewhere:
        if wrong:
            break
        bit, value = random.randrange(32), random.randrange(2)
        chip = Chip(elf, contents)
        chip.hold(address, bit, value)
        end, told = chip.run()
        if (end, told) != (chip.address("tripivot_ram_fault"), address):
            wrong = f"bit {bit} at {address:#x} stays {value}: ends at {end:#x} with {told:#x}, seed {SEED}"
    if wrong:
        print(wrong)
        return 1
    print(f"test of the RAM: a sound chip comes through, {len(edges + somewhere)} bits that stay are found where they are")
    return 0


if __name__ == "__main__":
    sys.exit(main())

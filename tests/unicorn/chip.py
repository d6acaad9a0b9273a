"""An STM32F427 around Unicorn's Cortex-M4F: memories, time, interrupts, and what hangs on the pins.

Unicorn runs blocks of instructions; a hook counts them, and stops it at the next event. An interrupt keeps the core's whole state
aside and runs the handler until it returns; so nothing here knows how a core stacks its registers.
"""

import ctypes
import struct

from unicorn import UC_PROT_ALL, UC_ARCH_ARM, UC_HOOK_BLOCK, UC_MODE_MCLASS, UC_MODE_THUMB, Uc, UcError
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_BASEPRI,
    UC_ARM_REG_PRIMASK,
    UC_ARM_REG_SP,
    UC_ARM_REG_XPSR,
    UC_CPU_ARM_CORTEX_M4,
)

import peripherals as part

FLASH, FLASH_BYTES = 0x0800_0000, 2 << 20
MEMORIES = ((FLASH, FLASH_BYTES), (0x1000_0000, 64 << 10), (0x1FFF_0000, 64 << 10))
# RAM, and how much of it answers at address 0 when the program says so. Until then nothing is there.
SRAM, SRAM_BYTES, SRAM1_BYTES = 0x2000_0000, 192 << 10, 112 << 10
# Where handlers return to, and what stands there.
RETURN, ENDLESS = 0x6000_0000, b"\xfe\xe7"
FLASH_SIZE_KIB = (0x1FFF_7A22, 2048)
WFI = b"\x30\xbf"
# What an exception leaves on the stack, floating-point registers and all.
FRAME_BYTES = 104
# Of the program status: how far an IT block has come. An exception begins outside of any.
IT_STATE = 0b11 << 25 | 0b111111 << 10
TIM1_UPDATE, TIM1_COMPARE, TIM3 = 25, 27, 29
BITS_A_BYTE = 10
# Of port D: bridges without a fault; of port E: the emergency stop released.
NO_FAULT, NO_STOP = 0b111 << 8, 1 << 15


class Failed(Exception):
    """The program did what it must not."""


class Chip:
    """The chip. `now` is in instructions since the start."""

    def __init__(self, segments, memory):
        self.uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
        for start, size in MEMORIES:
            self.uc.mem_map(start, size)
        self.sram, self.sram1_wanted = ctypes.create_string_buffer(SRAM_BYTES), False
        self.uc.mem_map_ptr(SRAM, SRAM_BYTES, UC_PROT_ALL, ctypes.addressof(self.sram))
        self.uc.mem_map(RETURN, 0x1000)
        self.uc.mem_write(RETURN, ENDLESS)
        self.uc.mem_write(FLASH, b"\xff" * FLASH_BYTES)
        self.uc.mem_write(FLASH_SIZE_KIB[0], struct.pack("<H", FLASH_SIZE_KIB[1]))
        for address, data in segments + memory:
            self.uc.mem_write(address, data)
        self.now, self.stop_at, self.failure = 0, 0, None
        self.block, self.lengths = (0, 0), {}
        self.kept, self.sleeping, self.started_at = [], False, None
        self.sending, self.sent = [], bytearray()
        self.make_peripherals()
        self.uc.mmio_map(0x4000_0000, 0x8_0000, self.read, 0x4000_0000, self.write, 0x4000_0000)
        self.uc.mmio_map(0x4200_0000, 0x200_0000, self.read_bit, None, self.write_bit, None)
        self.uc.mmio_map(0xE000_0000, 0x10_0000, self.read, 0xE000_0000, self.write, 0xE000_0000)
        self.uc.hook_add(UC_HOOK_BLOCK, self.on_block)
        stack, reset = struct.unpack("<II", self.uc.mem_read(FLASH, 8))
        self.uc.reg_write(UC_ARM_REG_SP, stack)
        self.pc = reset | 1

    def make_peripherals(self):
        self.tim1, self.tim3 = part.Timer(self, 1), part.Timer(self, 2)
        self.dma1, self.dma2 = part.Dma(self), part.Dma(self)
        self.spis = [part.Spi(self, self.dma2, 0, 3), part.Spi(self, self.dma1, 3, 4), part.Spi(self, self.dma1, 0, 5)]
        self.adc, self.usart, self.interrupts = part.Adc(), part.Usart(), part.Interrupts(self)
        self.port_d, self.port_e = part.Port(NO_FAULT), part.Port(NO_STOP)
        ports = [part.Port(), part.Port(), part.Port(), self.port_d, self.port_e]
        self.parts = {0x4002_0000 + 0x400 * number: port for number, port in enumerate(ports)}
        self.parts |= {
            0x4001_0000: self.tim1,
            0x4000_0400: self.tim3,
            0x4001_3000: self.spis[0],
            0x4000_3800: self.spis[1],
            0x4000_3C00: self.spis[2],
            0x4002_6000: self.dma1,
            0x4002_6400: self.dma2,
            0x4001_2000: self.adc,
            0x4001_1000: self.usart,
            0x4002_3800: part.Rcc(),
            0x4002_3C00: part.Flash(),
            0x4000_7000: part.Pwr(),
            0x4001_3800: part.Syscfg(self),
            0xE000_1000: part.Cycles(self),
            0xE000_E000: self.interrupts,
        }
        identity = part.Registers()
        identity.write(0, 0x2003_6419)
        self.parts[0xE004_2000] = identity

    # What the core does.

    def find(self, address):
        """The peripheral at an address and the register's place in it."""
        size = 0x1000 if address >= 0xE000_0000 else 0x400
        base = address & -size
        if base not in self.parts:
            self.parts[base] = part.Registers()
        return self.parts[base], address - base

    def read(self, _uc, offset, size, base):
        peripheral, at = self.find(base + offset)
        value = peripheral.read(at & ~3) >> 8 * (at & 3)
        return value & (1 << 8 * size) - 1

    def write(self, _uc, offset, size, value, base):
        peripheral, at = self.find(base + offset)
        if size < 4:
            shift, mask = 8 * (at & 3), (1 << 8 * size) - 1
            value = peripheral.read(at & ~3) & ~(mask << shift) | (value & mask) << shift
        peripheral.write(at & ~3, value)

    def read_bit(self, _uc, offset, _size, _data):
        """A word of the bit band is a bit of a peripheral."""
        at, bit = 0x4000_0000 + offset // 128 * 4, offset // 4 % 32
        peripheral, register = self.find(at)
        return peripheral.read(register) >> bit & 1

    def write_bit(self, _uc, offset, _size, value, _data):
        at, bit = 0x4000_0000 + offset // 128 * 4, offset // 4 % 32
        peripheral, register = self.find(at)
        peripheral.write(register, peripheral.read(register) & ~(1 << bit) | (value & 1) << bit)

    def instructions(self, start, end):
        """How many stand from one address to another."""
        key = (start, end)
        if key not in self.lengths:
            code, at, count = self.uc.mem_read(start, end - start), 0, 0
            while at < len(code):
                at += 4 if code[at + 1] >> 3 in (0b11101, 0b11110, 0b11111) else 2
                count += 1
            self.lengths[key] = count
        return self.lengths[key]

    def on_block(self, uc, address, size, _data):
        if self.now >= self.stop_at or address == RETURN:
            uc.emu_stop()
        self.now += self.instructions(address, address + size)
        self.block = (address, address + size)

    def run(self):
        """Runs on until the next event, a return, or sleep."""
        try:
            self.uc.emu_start(self.pc, 0xFFFF_FFFF)
        except UcError as error:
            at = self.uc.reg_read(UC_ARM_REG_PC)
            raise Failed(f"{error} at {at:#x}") from error
        at = self.uc.reg_read(UC_ARM_REG_PC)
        start, end = self.block
        self.sleeping = False
        if at == RETURN:
            self.now -= self.instructions(start, end) if start == RETURN else 0
            self.uc.context_restore(self.kept.pop()[0])
            at = self.uc.reg_read(UC_ARM_REG_PC)
        elif start <= at < end:
            # Stopped before its end: the rest comes again as a block of its own.
            self.now -= self.instructions(at, end)
        else:
            self.sleeping = bytes(self.uc.mem_read(at - 2, 2)) == WFI
        self.pc = at | 1

    # Interrupts and time.

    def look(self):
        """Something has changed that may interrupt: the core is to be asked after the block under way."""
        self.stop_at = 0

    def map_sram1(self):
        """SRAM1 is wanted at address 0: it is there from the block after the one under way."""
        self.sram1_wanted = True
        self.look()

    def fail(self, why):
        self.failure = why
        self.look()

    def requested(self):
        """Lines that ask for an interrupt, the most urgent first."""
        lines = set(self.interrupts.pending)
        if self.tim1.requests(part.Timer.UPDATE):
            lines.add(TIM1_UPDATE)
        if self.tim1.requests(part.Timer.COMPARE_4):
            lines.add(TIM1_COMPARE)
        if self.tim3.requests(part.Timer.UPDATE):
            lines.add(TIM3)
        return sorted(lines & self.interrupts.enabled, key=lambda line: (self.interrupts.priority(line), line))

    def interrupt(self):
        """Enters the handler of the most urgent line, if it may interrupt what runs."""
        lines = self.requested()
        if not lines:
            return
        self.sleeping = False
        running = self.kept[-1][1] if self.kept else 0x100
        priority = self.interrupts.priority(lines[0])
        # A ceiling of 0 is none.
        ceiling = self.uc.reg_read(UC_ARM_REG_BASEPRI) or 0x100
        if priority >= min(running, ceiling) or self.uc.reg_read(UC_ARM_REG_PRIMASK):
            return
        self.interrupts.pending.discard(lines[0])
        self.uc.reg_write(UC_ARM_REG_PC, self.pc)
        self.kept.append((self.uc.context_save(), priority))
        self.uc.reg_write(UC_ARM_REG_XPSR, self.uc.reg_read(UC_ARM_REG_XPSR) & ~IT_STATE)
        table = self.interrupts.read(part.Interrupts.VTOR) or FLASH
        vector = struct.unpack("<I", self.uc.mem_read(table + 4 * (16 + lines[0]), 4))[0]
        self.uc.reg_write(UC_ARM_REG_SP, (self.uc.reg_read(UC_ARM_REG_SP) - FRAME_BYTES) & ~7)
        self.uc.reg_write(UC_ARM_REG_LR, RETURN | 1)
        self.pc = vector | 1

    def run_until(self, time):
        """Lets the chip live until a time."""
        while self.now < time:
            self.interrupt()
            due = (self.tim1.next_interrupt(), self.tim3.next_interrupt(), time)
            self.stop_at = min(at for at in due if at is not None)
            if self.sleeping:
                self.now = max(self.now, self.stop_at)
                self.sleeping = False if self.requested() else self.sleeping
            else:
                self.run()
            if self.sram1_wanted:
                self.sram1_wanted = False
                self.uc.mem_map_ptr(0, SRAM1_BYTES, UC_PROT_ALL, ctypes.addressof(self.sram))
            if self.failure:
                raise Failed(self.failure)

    def started(self, timer):
        if timer is self.tim1:
            self.started_at = self.now

    def at(self, ns):
        """A time from the start of the timers, in instructions since the start of the chip."""
        return self.started_at + ns * (part.CORE_HZ // 1_000_000) // 1000

    # What hangs on the pins.

    def store(self, address, data):
        self.uc.mem_write(address, data)

    def stream_begins(self, dma, number):
        for port in self.spis:
            port.transfer()
        if dma is self.dma2 and number == 7:
            _, count, memory = dma.stream(number)
            byte = self.usart.read(part.Usart.BRR) * 2 * BITS_A_BYTE
            begins = max(self.now, self.sending[-1][0] if self.sending else 0)
            data = self.uc.mem_read(memory, count)
            self.sending += [(begins + (index + 1) * byte, value) for index, value in enumerate(data)]

    def settle_sending(self):
        """Takes the bytes that are through off the line; the stream is done when its last one is in the port."""
        while self.sending and self.sending[0][0] <= self.now:
            self.sent.append(self.sending.pop(0)[1])
        if len(self.sending) <= 2 and self.dma2.enabled(7):
            self.dma2.complete(7)

    def receive(self, value):
        """A byte has come over the line: the stream puts it into its ring."""
        control, count, memory = self.dma2.stream(5)
        if not control & 1:
            return
        if not hasattr(self, "ring_bytes"):
            self.ring_bytes = count
        self.store(memory + self.ring_bytes - count, bytes([value]))
        count -= 1
        if count == self.ring_bytes // 2:
            self.dma2.flag(5, part.Dma.HALF)
        if count == 0:
            self.dma2.flag(5, part.Dma.COMPLETE)
            count = self.ring_bytes
        self.dma2.set_count(5, count)

    def pins(self):
        """Duties, or None while they are cut; levels of the phase pins and of the sleep pins."""
        connected = self.tim1.read(part.Timer.BDTR) & 1 << 15
        duty = [self.tim1.read(part.Timer.CCR1 + 4 * axis) for axis in range(3)] if connected else None
        return duty, [self.port_d.level(pin) for pin in (0, 1, 2)], [self.port_d.level(pin) for pin in (4, 5, 6)]

"""The peripherals of the STM32F427 that the image uses, as far as it uses them. Registers without a meaning here are memory.

Time is counted in instructions, one a cycle of the core. Written from the reference manual (RM0090), without a look at the first
emulator.
"""

CORE_HZ = 168_000_000


class Registers:
    """Registers that keep what is written."""

    reset = {}

    def __init__(self):
        self.values = dict(self.reset)

    def read(self, offset):
        return self.values.get(offset, 0)

    def write(self, offset, value):
        self.values[offset] = value


class Rcc(Registers):
    """Oscillators are ready when they are on, and the switch of the clock is done at once."""

    reset = {0x00: 0x83, 0x30: 0x0010_0000, 0x74: 0x0E00_0000}
    CR, CFGR, BDCR, CSR = 0x00, 0x08, 0x70, 0x74

    def read(self, offset):
        value = self.values.get(offset, 0)
        if offset == self.CR:
            ready = sum(1 << (bit + 1) for bit in (0, 16, 24, 26, 28) if value >> bit & 1)
            return value | ready
        if offset == self.CFGR:
            return value & ~0b1100 | (value & 0b11) << 2
        if offset in (self.BDCR, self.CSR):
            return value | (value & 1) << 1
        return value


class Pwr(Registers):
    """Regulator and over-drive are ready."""

    reset = {0x00: 0xC000}

    def read(self, offset):
        return self.values.get(offset, 0) | (0x3_4000 if offset == 0x04 else 0)


class Flash(Registers):
    """Never busy, no error, both banks, brown-out level 3."""

    reset = {0x10: 0x8000_0000, 0x14: 0x0FFF_AAE1}

    def read(self, offset):
        return 0 if offset == 0x0C else self.values.get(offset, 0)


class Syscfg(Registers):
    """What answers at address 0: nothing, until it is the first block of RAM."""

    MEMRMP, SRAM1 = 0x00, 0b011

    def __init__(self, chip):
        super().__init__()
        self.chip = chip

    def write(self, offset, value):
        super().write(offset, value)
        if offset == self.MEMRMP and value & 0b111 == self.SRAM1:
            self.chip.map_sram1()


class Port(Registers):
    """A GPIO port: what is driven from outside, and what is put out."""

    IDR, ODR, BSRR = 0x10, 0x14, 0x18

    def __init__(self, levels=0):
        super().__init__()
        self.levels = levels

    def read(self, offset):
        return self.levels if offset == self.IDR else self.values.get(offset, 0)

    def write(self, offset, value):
        if offset == self.BSRR:
            out = self.values.get(self.ODR, 0) & ~(value >> 16)
            self.values[self.ODR] = out | value & 0xFFFF
        else:
            self.values[offset] = value

    def level(self, pin):
        return self.values.get(self.ODR, 0) >> pin & 1


class Adc(Registers):
    """The injected group is converted as soon as it is started."""

    CR2, JDR1 = 0x08, 0x3C
    START = 1 << 22

    def __init__(self):
        super().__init__()
        self.counts = [0] * 4

    def write(self, offset, value):
        if offset == self.CR2 and value & self.START:
            value &= ~self.START
            for index, counts in enumerate(self.counts):
                self.values[self.JDR1 + 4 * index] = counts
        self.values[offset] = value


class Timer(Registers):
    """A timer that counts up: update and compare event of channel 4."""

    CR1, DIER, SR, EGR, CNT, ARR, CCR1, CCR4, BDTR = 0x00, 0x0C, 0x10, 0x14, 0x24, 0x2C, 0x34, 0x40, 0x44
    UPDATE, COMPARE_4 = 1 << 0, 1 << 4
    reset = {0x2C: 0xFFFF}

    def __init__(self, chip, cycles_per_count):
        super().__init__()
        self.chip = chip
        self.cycles_per_count = cycles_per_count
        self.zero_at = 0
        self.seen_at = 0

    def running(self):
        return self.values.get(self.CR1, 0) & 1

    def period(self):
        return (self.values[self.ARR] + 1) * self.cycles_per_count

    def phases(self):
        """Events of a period: flag, and cycles from the count of 0."""
        yield self.UPDATE, 0
        yield self.COMPARE_4, self.values.get(self.CCR4, 0) * self.cycles_per_count

    def next(self, phase, after):
        """The first such event after a time."""
        periods = (after - self.zero_at - phase) // self.period() + 1
        return self.zero_at + phase + periods * self.period()

    def settle(self):
        """Sets the flags of what has come until now."""
        if self.running():
            for flag, phase in self.phases():
                if self.next(phase, self.seen_at) <= self.chip.now:
                    self.values[self.SR] = self.values.get(self.SR, 0) | flag
        self.seen_at = self.chip.now

    def next_interrupt(self):
        """When the next flag comes that interrupts."""
        wanted = self.values.get(self.DIER, 0) & ~self.values.get(self.SR, 0)
        times = [self.next(phase, self.seen_at) for flag, phase in self.phases() if wanted & flag]
        return min(times) if times and self.running() else None

    def requests(self, flag):
        self.settle()
        return self.values.get(self.DIER, 0) & self.values.get(self.SR, 0) & flag

    def read(self, offset):
        self.settle()
        if offset == self.CNT and self.running():
            return (self.chip.now - self.zero_at) % self.period() // self.cycles_per_count
        return self.values.get(offset, 0)

    def write(self, offset, value):
        self.settle()
        if offset == self.SR:
            value &= self.values.get(self.SR, 0)
        elif offset == self.EGR:
            self.values[self.CNT] = 0
            return
        elif offset == self.CR1 and value & 1 and not self.running():
            self.zero_at = self.chip.now - self.values.get(self.CNT, 0) * self.cycles_per_count
            self.chip.started(self)
        self.values[offset] = value
        self.chip.look()


class Dma(Registers):
    """A controller of eight streams. What moves bytes is the peripheral's: `start` is called when a stream is switched on."""

    LISR, HISR, LIFCR, HIFCR = 0x00, 0x04, 0x08, 0x0C
    HALF, COMPLETE = 1 << 4, 1 << 5
    SHIFTS = (0, 6, 16, 22)

    def __init__(self, chip):
        super().__init__()
        self.chip = chip

    def stream(self, number):
        """Control, count and memory address of a stream."""
        return (self.values.get(0x10 + 0x18 * number + at, 0) for at in (0x00, 0x04, 0x0C))

    def enabled(self, number):
        return self.values.get(0x10 + 0x18 * number, 0) & 1

    def set_count(self, number, count):
        self.values[0x14 + 0x18 * number] = count

    def flag(self, number, flag):
        register = self.HISR if number >= 4 else self.LISR
        self.values[register] = self.values.get(register, 0) | flag << self.SHIFTS[number % 4]

    def complete(self, number):
        """The stream has moved all of its bytes."""
        self.values[0x10 + 0x18 * number] &= ~1
        self.set_count(number, 0)
        self.flag(number, self.COMPLETE)

    def read(self, offset):
        self.chip.settle_sending()
        return self.values.get(offset, 0)

    def write(self, offset, value):
        if offset in (self.LIFCR, self.HIFCR):
            self.values[offset - 8] = self.values.get(offset - 8, 0) & ~value
            return
        if offset >= 0x10 and (offset - 0x10) % 0x18 == 0:
            number = (offset - 0x10) // 0x18
            begins = value & 1 and not self.enabled(number)
            self.values[offset] = value
            if begins:
                self.chip.stream_begins(self, number)
            return
        self.values[offset] = value


class Spi(Registers):
    """A port with an encoder on it. The frame is moved at once when both its streams and both requests are on."""

    CR1, CR2 = 0x00, 0x04
    reset = {0x08: 0x02}

    def __init__(self, chip, dma, receive, transmit):
        super().__init__()
        self.chip, self.dma, self.streams = chip, dma, (receive, transmit)
        self.frame = b"\xff" * 8

    def write(self, offset, value):
        self.values[offset] = value
        self.transfer()

    def transfer(self):
        receive, transmit = self.streams
        requests = self.values.get(self.CR2, 0) & 0b11 == 0b11
        ready = self.values.get(self.CR1, 0) & 1 << 6
        if not (requests and ready and self.dma.enabled(receive) and self.dma.enabled(transmit)):
            return
        _, count, memory = self.dma.stream(receive)
        frame = self.frame[:count]
        self.chip.store(memory, frame + b"\xff" * (count - len(frame)))
        self.frame = b""
        self.dma.complete(receive)
        self.dma.complete(transmit)


class Usart(Registers):
    """Status: everything has been sent, nothing is damaged."""

    BRR = 0x08
    reset = {0x00: 0xC0}

    def write(self, offset, value):
        if offset:
            self.values[offset] = value


class Cycles(Registers):
    """The core's counter of cycles (DWT)."""

    def __init__(self, chip):
        super().__init__()
        self.chip = chip

    def read(self, offset):
        return self.chip.now & 0xFFFF_FFFF if offset == 4 else self.values.get(offset, 0)


class Interrupts(Registers):
    """The interrupt controller and the system control block."""

    reset = {0xD00: 0x410F_C241, 0xD14: 0x200}
    ENABLE, DISABLE, PEND, UNPEND, PRIORITY = 0x100, 0x180, 0x200, 0x280, 0x400
    VTOR, AIRCR = 0xD08, 0xD0C

    def __init__(self, chip):
        super().__init__()
        self.chip = chip
        self.enabled, self.pending = set(), set()

    @staticmethod
    def lines(offset, value):
        return {8 * offset + bit for bit in range(32) if value >> bit & 1}

    def priority(self, line):
        return self.values.get(self.PRIORITY + (line & ~3), 0) >> 8 * (line % 4) & 0xF0

    def write(self, offset, value):
        for first, change in (
            (self.ENABLE, self.enabled.update),
            (self.DISABLE, self.enabled.difference_update),
            (self.PEND, self.pending.update),
            (self.UNPEND, self.pending.difference_update),
        ):
            if first <= offset < first + 0x20:
                change(self.lines(offset - first, value))
                self.chip.look()
                return
        if offset == self.AIRCR and value & 4:
            self.chip.fail("the program asked for a reset")
        self.values[offset] = value

#!/usr/bin/env python3
"""The image on a second emulator: given tick by tick what the first one was given, it has to put out the same.

    witness.py IMAGE PINS [--flip TICK]

PINS is what `cargo image chip-pins` wrote. With --flip one bit of the first encoder's frames differs from that tick on: the comparison
has to find it, exit code 1. A single bad frame is bridged, often by the very count that it had.
"""

import argparse
import pathlib
import struct
import sys
import time

from chip import Chip, Failed

BOOT_CYCLES = 400_000_000
# A byte on the line, ns.
BYTE_NS = 10_833
# Bytes that may still be on the line on one side: the two count the end of a stop bit differently.
BYTES_APART = 2


def segments(path):
    """What an ELF file puts where: its loadable segments."""
    elf = path.read_bytes()
    start, = struct.unpack_from("<I", elf, 28)
    size, count = struct.unpack_from("<HH", elf, 42)
    found = []
    for index in range(count):
        kind, offset, _, physical, length = struct.unpack_from("<5I", elf, start + index * size)
        if kind == 1 and length:
            found.append((physical, elf[offset : offset + length]))
    return found


def hexadecimal(text):
    return b"" if text == "-" else bytes.fromhex(text)


def events(lines):
    """Time and words of all lines, bytes at the time at which they are there."""
    found = []
    for number, (kind, at, *words) in enumerate(lines):
        arrives = int(at) + (BYTE_NS if kind == "byte" else 0)
        found.append((arrives, number, kind, words))
    return sorted(found)


class Witness:
    def __init__(self, image, path, flip):
        lines = [line.split() for line in path.read_text().splitlines()]
        memory = [(int(at, 16), bytes.fromhex(data)) for kind, at, *rest in lines if kind == "memory" for data in rest]
        self.events = events(line for line in lines if line[0] != "memory")
        self.chip = Chip(segments(image), memory)
        self.flip, self.ticks, self.received = flip, 0, bytearray()

    def run(self):
        while self.chip.started_at is None:
            if self.chip.now > BOOT_CYCLES:
                raise Failed("the timers were not started")
            self.chip.run_until(self.chip.now + 10_000)
        for at, _, kind, words in self.events:
            self.chip.run_until(self.chip.at(at))
            {"byte": self.byte, "pins": self.pins, "sent": self.answers, "inputs": self.inputs}[kind](*words)

    def byte(self, value):
        self.chip.receive(int(value, 16))

    def pins(self, duty, phase, sleep):
        ours = self.chip.pins()
        duty = None if duty == "-" else [int(counts) for counts in duty.split(",")]
        theirs = duty, [int(level) for level in phase], [int(level) for level in sleep]
        if ours != theirs:
            raise Failed(f"tick {self.ticks}: duty, phase, sleep are {theirs} on the first, {ours} on the second")

    def sent_so_far(self):
        self.chip.settle_sending()
        return bytes(self.chip.sent)

    def inputs(self, frames, counts):
        frames = [bytearray.fromhex(frame) for frame in frames.split(",")]
        if self.flip is not None and self.ticks >= self.flip:
            frames[0][3] ^= 0x10
        for port, frame in zip(self.chip.spis, frames):
            port.frame = bytes(frame)
        self.chip.adc.counts = [int(count) for count in counts.split(",")]
        self.ticks += 1

    def answers(self, data):
        self.received += hexadecimal(data)
        ours = self.sent_so_far()
        theirs = bytes(self.received)
        both = min(len(ours), len(theirs))
        if ours[:both] != theirs[:both] or abs(len(ours) - len(theirs)) > BYTES_APART:
            raise Failed(f"tick {self.ticks}: answers differ: {theirs[-40:]} on the first, {ours[-40:]} on the second")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("image", type=pathlib.Path)
    parser.add_argument("pins", type=pathlib.Path)
    parser.add_argument("--flip", type=int)
    arguments = parser.parse_args()
    begun = time.monotonic()
    witness = Witness(arguments.image, arguments.pins, arguments.flip)
    try:
        witness.run()
    except Failed as failed:
        print(f"the emulators differ, or the second one failed: {failed}")
        return 1
    print(
        f"{witness.ticks} ticks: duties, phases, sleep pins and {len(witness.received)} bytes of answers the same on both emulators "
        f"({time.monotonic() - begun:.0f} s)"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())

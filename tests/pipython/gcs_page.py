"""What `firmware/GCS.md` shows: its example for Python is run as it stands there, the bytes that it shows are those that went over the
wire, and the commands that it lists are those that `HLP?` lists."""

import pathlib
import re
import socket
import unittest
from unittest import mock

from pipython.pidevice.interfaces import pisocket
from wire import overheard

PAGE = pathlib.Path(__file__).parents[2] / "firmware" / "GCS.md"
LEFT_OUT = "..."
"""Stands in the page for lines that it does not show."""


def section_of_page(title):
    """What stands under a heading, up to the next of its level."""
    return PAGE.read_text(encoding="utf-8").split(f"\n## {title}\n")[1].split("\n## ")[0]


def name_of(line):
    """The command's name: what stands before its parameters. `MAC`, `ILC`, `EXC` and `CAL` have a second word."""
    words = line.split()
    return " ".join(words[:2]) if words[0] in ("MAC", "ILC", "EXC", "CAL") else words[0]


class GcsPage(unittest.TestCase):
    """On a stage that has just been started."""

    port = None

    def setUp(self):
        section = section_of_page("From Python")
        self.program, self.shown = re.findall(r"```(?:python)?\n(.*?)```", section, re.DOTALL)[:2]

    def test_its_program_runs_and_its_transcript_is_what_was_said(self):
        messages = []
        real = pisocket.PISocket

        def hear(sign, text):
            # However many pieces a reply has come in.
            if sign == "<" and messages and messages[-1][0] == "<":
                text = messages.pop()[1] + text
            messages.append((sign, text))

        def here(host, port):
            self.assertEqual((host, port), ("127.0.0.1", 50000))
            return overheard(real(host=host, port=self.port), hear)

        names = {}
        with mock.patch.object(pisocket, "PISocket", here), mock.patch("builtins.print") as printed:
            exec(compile(self.program, PAGE.name, "exec"), names)
        self.addCleanup(names["stage"].close)
        place = printed.call_args.args[0]
        for axis, target in (("X", 30), ("Y", -20), ("W", 45)):
            self.assertAlmostEqual(place[axis], target, delta=1e-3)
        self.assert_parts_of(self.shown, [f"{sign} {text!r}" for sign, text in messages])

    def test_it_lists_the_commands_that_there_are(self):
        rows = [line for line in section_of_page("Commands").splitlines() if line.startswith("| `")]
        listed = [name_of(text) for row in rows for text in re.findall(r"`([^`]*)`", row.split(" | ")[0])]
        with socket.create_connection(("127.0.0.1", self.port), timeout=10) as client:
            client.sendall(b"HLP?\n")
            lines = client.makefile(encoding="ascii")
            next(lines)
            there = [name_of(line) for line in iter(lambda: next(lines), "end of help\n")]
        self.assertEqual(sorted(set(listed)), sorted(there))

    def assert_parts_of(self, shown, said):
        """Without the lines left out, what is shown stands in what was said, word by word and in order."""
        start = 0
        for part in shown.split(f"\n{LEFT_OUT}\n"):
            lines = part.splitlines()
            found = [i for i in range(start, len(said)) if said[i:i + len(lines)] == lines]
            self.assertTrue(found, f"the page shows what was not said:\n{part}\nSaid was:\n" + "\n".join(said[start:]))
            start = found[0] + len(lines)

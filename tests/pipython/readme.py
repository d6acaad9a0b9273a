"""The README's example for Python is run as it stands there, and the bytes that it shows are those that went over the wire."""

import pathlib
import re
import unittest
from unittest import mock

from pipython.pidevice.interfaces import pisocket
from wire import overheard

README = pathlib.Path(__file__).parents[2] / "README.md"
LEFT_OUT = "..."
"""Stands in the README for lines that it does not show."""


class Readme(unittest.TestCase):
    """On a stage that has just been started."""

    port = None

    def setUp(self):
        section = README.read_text(encoding="utf-8").split("\n## From Python\n")[1].split("\n## ")[0]
        self.program, self.shown = re.findall(r"```(?:python)?\n(.*?)```", section, re.DOTALL)[:2]

    def test_its_program_runs_and_its_transcript_is_what_was_said(self):
        messages = []
        socket = pisocket.PISocket

        def hear(sign, text):
            # However many pieces a reply has come in.
            if sign == "<" and messages and messages[-1][0] == "<":
                text = messages.pop()[1] + text
            messages.append((sign, text))

        def here(host, port):
            self.assertEqual((host, port), ("127.0.0.1", 50000))
            return overheard(socket(host=host, port=self.port), hear)

        names = {}
        with mock.patch.object(pisocket, "PISocket", here), mock.patch("builtins.print") as printed:
            exec(compile(self.program, "README.md", "exec"), names)
        self.addCleanup(names["stage"].close)
        place = printed.call_args.args[0]
        for axis, target in (("X", 30), ("Y", -20), ("W", 45)):
            self.assertAlmostEqual(place[axis], target, delta=1e-3)
        self.assert_parts_of(self.shown, [f"{sign} {text!r}" for sign, text in messages])

    def assert_parts_of(self, shown, said):
        """Without the lines left out, what is shown stands in what was said, word by word and in order."""
        start = 0
        for part in shown.split(f"\n{LEFT_OUT}\n"):
            lines = part.splitlines()
            found = [i for i in range(start, len(said)) if said[i:i + len(lines)] == lines]
            self.assertTrue(found, f"the README shows what was not said:\n{part}\nSaid was:\n" + "\n".join(said[start:]))
            start = found[0] + len(lines)

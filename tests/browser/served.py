"""The program's servers as processes of the tests, which end as Ctrl-C ends them."""

import re
import signal
import subprocess

PATIENCE_S = 180
"""Far longer than one takes to end, on a busy machine too."""


class Process:
    """The program with a command that serves, whose first lines say where."""

    def __init__(self, program, *arguments):
        self.process = subprocess.Popen([program, *arguments], stdout=subprocess.PIPE, text=True)

    def said(self, pattern):
        """What the next line says where the pattern has its group."""
        line = self.process.stdout.readline()
        found = re.match(pattern, line)
        if not found:
            self.process.kill()
            self.process.communicate()
            raise RuntimeError(f"{' '.join(self.process.args)} says “{line.strip()}”")
        return found[1]

    def freeze(self):
        """It does nothing any more, and nobody is told."""
        self.process.send_signal(signal.SIGSTOP)

    def thaw(self):
        self.process.send_signal(signal.SIGCONT)

    def close(self):
        """Ends it; once more does nothing."""
        if self.process.stdout.closed:
            return
        self.thaw()
        self.process.send_signal(signal.SIGINT)
        # What it prints meanwhile must not hold it up.
        self.process.stdout.read()
        self.process.stdout.close()
        if self.process.wait(PATIENCE_S) != 0:
            raise RuntimeError(f"{' '.join(self.process.args)} did not end cleanly")


class Served(Process):
    """A simulated stage whose settings are the reference's, its GCS port and its page."""

    def __init__(self, program, gcs="127.0.0.1:0", page="127.0.0.1:0", stage=("--kind",)):
        super().__init__(program, "serve", *stage, "--listen", gcs, "--web", page)
        self.gcs = self.said(r"listening at (\S+)")
        if page == "off":
            return
        self.page = self.said(r"page at http://(\S+)/")
        self.url = f"http://{self.page}/"


class Line(Process):
    """A simulated stage without a page, at a terminal."""

    def __init__(self, program):
        super().__init__(program, "serve", "--kind", "--listen", "127.0.0.1:0", "--web", "off", "--pty")
        self.said("(listening)")
        self.way = ("--port", self.said(r"terminal at (\S+)"))


class ChipLine(Process):
    """The serial line of the emulated chip."""

    def __init__(self, program):
        super().__init__(program, "chip-serve", "--kind", "--listen", "127.0.0.1:0")
        self.way = ("--connect", self.said(r"listening at (\S+)"))


class Viewed(Process):
    """The page for a controller that runs already."""

    def __init__(self, program, *way):
        super().__init__(program, "view", *way, "--web", "127.0.0.1:0")
        self.url = self.said(r"page at (\S+) for the controller")

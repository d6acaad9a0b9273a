"""`tripivot serve` as a process of the tests, which can be ended and started again at the same places."""

import re
import signal
import subprocess


class Served:
    """A simulated stage, its GCS port and its page."""

    def __init__(self, program, gcs="127.0.0.1:0", page="127.0.0.1:0"):
        self.program = program
        self.process = subprocess.Popen(
            [program, "serve", "--listen", gcs, "--web", page], stdout=subprocess.PIPE, text=True)
        self.gcs = re.match(r"listening at (\S+)", self.process.stdout.readline())[1]
        self.page = re.match(r"page at http://(\S+)/", self.process.stdout.readline())[1]
        self.url = f"http://{self.page}/"

    def close(self):
        """Ends it as Ctrl-C does."""
        self.process.send_signal(signal.SIGINT)
        # What it prints meanwhile must not hold it up.
        self.process.stdout.read()
        self.process.stdout.close()
        if self.process.wait() != 0:
            raise RuntimeError("tripivot serve did not end cleanly")

    def restarted(self):
        """Another one in its place."""
        self.close()
        return Served(self.program, self.gcs, self.page)

"""Scripts that run in the server of the page: to their end, by steps, paused by hand and by the loss of their page, ended by a stop."""

import os
import signal
import time

from page import SOFT_SERVO, OnServed

STEADY = "FRF\nWAC ONT? W = 1\n# A comment.\nVLS 20\nMOV X 20\nWAC ONT? X = 1\nDEL 100\nPOS? X\nMOV X 0\nWAC ONT? X = 1\n"
ENDLESS = "FRF\nVLS 5\n" + "MOV X 10\nWAC ONT? X = 1\nMOV X -10\nWAC ONT? X = 1\n" * 50


class Sequence(OnServed):
    """Scripts in the server."""

    def load(self, browser, text):
        browser.run("document.getElementById('sequence').open = true")
        browser.run("""
            const text = document.getElementById('sequence-text');
            text.value = arguments[0]; text.dispatchEvent(new Event('change'))""", text)

    def line(self, browser):
        """The line that is marked."""
        return browser.run("return document.querySelector('#sequence-lines [aria-current]')?.textContent ?? ''")

    def runs_on(self, browser):
        """A sequence that moves to and fro for minutes."""
        self.load(browser, ENDLESS)
        browser.click("#sequence-run")
        browser.wait_text("#mode", "moving")
        browser.wait(lambda: "WAC" in self.line(browser), "a line that is marked")

    def test_runs_to_its_end_and_reports(self):
        browser = self.page()
        self.load(browser, STEADY)
        browser.click("#sequence-run")
        browser.wait_text("#sequence-state", "running, line")
        browser.wait(lambda: self.line(browser) == "WAC ONT? X = 1", "the line under way")
        self.picture(browser, "sequence")
        browser.wait_text("#sequence-said", "done: 9 lines in ")
        report = browser.text("#sequence-report")
        self.assertIn("POS? X", report)
        self.assertAlmostEqual(float(report.split("X=")[1]), 20, delta=0.01)
        self.arrive(browser, x=0)
        # Who did it is told, queries are not.
        browser.run("document.getElementById('log').open = true")
        browser.wait_text("#log-list", "MOV X 20")
        self.assertIn("sequence untitled", browser.text("#log-list"))
        self.assertNotIn("POS?", browser.text("#log-list"))
        self.assertEqual(browser.errors(), [])

    def test_a_bad_line_is_named_before_anything_moves(self):
        browser = self.page()
        self.load(browser, "FRF\nMOV X 1o\n")
        browser.click("#sequence-run")
        browser.wait_text("#sequence-said", "untitled:2:8: expected ")
        browser.wait_text("#sequence-said", "nothing was sent")
        self.assertFalse(self.lit(browser, "referenced"))

    def test_a_refused_line_ends_it(self):
        browser = self.page()
        self.load(browser, "FRF\nMOV X 200\nMOV X 1\n")
        browser.click("#sequence-run")
        browser.wait_text("#sequence-said", "line 2: MOV X 200: out of the stage’s reach or of the soft limits (error 7)")
        self.near(browser, "x", 0, 0.1, "target")

    def test_steps(self):
        browser = self.page()
        self.load(browser, "FRF\nMOV X 5\nMOV X 10\n")
        browser.click("#sequence-step")
        browser.wait_text("#sequence-state", "paused, line 2; 1 of 3 lines done")
        self.assertEqual(self.line(browser), "MOV X 5")
        browser.click("#sequence-step")
        browser.wait_text("#sequence-state", "paused, line 3; 2 of 3 lines done")
        self.arrive(browser, x=5)
        browser.click("#sequence-run")
        browser.wait_text("#sequence-said", "done: 3 lines")
        self.arrive(browser, x=10)

    def test_pauses_and_goes_on(self):
        browser = self.page()
        self.runs_on(browser)
        browser.click("#sequence-pause")
        browser.wait_text("#sequence-state", "paused")
        self.light(browser, "settled")
        place = self.shown(browser, "x")
        browser.run("return new Promise((done) => setTimeout(done, 1000))")
        self.assertAlmostEqual(self.shown(browser, "x"), place, delta=0.01)
        browser.click("#sequence-run")
        browser.wait_text("#sequence-state", "running")
        browser.wait_text("#mode", "moving")
        browser.click("#sequence-end")
        browser.wait_text("#sequence-said", "ended by an operator, and the stage halted")
        browser.wait_text("#mode", "holding")

    def test_a_stop_ends_it(self):
        browser, other = self.page(), self.page("phone", touch=True)
        self.runs_on(browser)
        other.click("#stop")
        other.wait_text("#stop-said", "stopped, as the controller says")
        browser.wait_text("#sequence-said", "STOP by ")
        browser.run("return new Promise((done) => setTimeout(done, 1000))")
        self.assertEqual(browser.text("#mode"), "holding")

    def test_a_stop_of_another_client_ends_it(self):
        browser = self.page()
        self.runs_on(browser)
        self.say_past(b"\x18")
        browser.wait_text("#sequence-said", "somebody else has stopped or moved the stage")
        browser.wait_text("#mode", "holding")

    def say_past(self, data):
        """Bytes of a client of the controller itself."""
        import socket
        host, port = self.served.gcs.rsplit(":", 1)
        with socket.create_connection((host, int(port))) as line:
            line.sendall(data + b"\n*IDN?\n")
            line.recv(1000)

    def test_a_fault_ends_it(self):
        browser = self.page()
        self.load(browser, "\n".join(("FRF", "WAC ONT? W = 1", *SOFT_SERVO, "MOV X 60 W 180", "WAC ONT? X = 1\n")))
        browser.click("#sequence-run")
        browser.wait_text("#sequence-said", "fault: ")
        browser.wait_text("#alarm-text", "following error too large")

    def test_an_order_that_nobody_answers_is_told(self):
        browser = self.page()
        self.runs_on(browser)
        self.served.freeze()
        try:
            browser.click("#sequence-end")
            browser.wait_text("#sequence-said", "no answer: whether it was carried out is not known")
            # For longer than a page may be silent: it was not the page.
            time.sleep(2)
        finally:
            self.served.thaw()
        browser.wait_text("#sequence-said", "ended by an operator")

    def test_the_page_that_owns_the_stage_runs_it(self):
        browser, other = self.page(), self.page()
        browser.click("#own")
        browser.wait_text("#owner-who", "Only this page may command.")
        self.load(other, "FRF\n")
        other.click("#sequence-run")
        other.wait_text("#sequence-said", "another connection owns the stage")
        self.load(browser, STEADY)
        browser.click("#sequence-run")
        browser.wait_text("#sequence-said", "done: 9 lines in ")

    def test_a_page_that_is_closed_pauses_it(self):
        browser, other = self.page(), self.page()
        self.runs_on(browser)
        browser.close()
        self.is_paused_in(other)

    def test_a_page_that_answers_no_more_pauses_it(self):
        browser, other = self.page(), self.page()
        self.runs_on(browser)
        frozen = browser.processes()
        self.assertTrue(frozen)
        for process in frozen:
            os.kill(process, signal.SIGSTOP)
        try:
            self.is_paused_in(other)
        finally:
            for process in frozen:
                os.kill(process, signal.SIGCONT)

    def is_paused_in(self, other):
        """Another page is told, and may have it go on."""
        other.run("document.getElementById('sequence').open = true")
        other.wait_text("#sequence-said", "the page that ran it is gone")
        other.wait_text("#sequence-state", "paused")
        other.wait_text("#mode", "holding")
        other.click("#sequence-run")
        other.wait_text("#mode", "moving")
        other.click("#sequence-end")
        other.wait_text("#sequence-said", "ended by an operator")

"""Calibration from the page: with the simulated instruments of a simulated stage, and with an instrument that a person reads."""

from page import OnPage
from served import Served, Viewed
from settings import ARGUMENTS
from webdriver import ESCAPE

SPEED = "8"
"""Simulated seconds in a second, as far as this computer is that fast."""
STATE = """
    const item = [...document.querySelectorAll('#calibrate-steps > li')].find((li) => li.querySelector('b').textContent === arguments[0]);
    return item?.dataset.state ?? ''"""
FOUND = """
    const item = [...document.querySelectorAll('#calibrate-steps > li')].find((li) => li.querySelector('b').textContent === arguments[0]);
    return [...item.querySelectorAll('tr')].map((row) => [...row.children].map((cell) => cell.textContent))"""
OPEN = "document.getElementById('calibration').open = true; document.getElementById('calibration').scrollIntoView()"
MADE = "return document.getElementById('calibrate-bar').value"


class Calibration(OnPage):
    """As somebody does it whose machine is not the drawing's."""

    def serve(self, *stage, page="127.0.0.1:0"):
        self.served = Served(ARGUMENTS.program, page=page, stage=[*stage, "--speed", SPEED])
        self.addCleanup(lambda: self.served.close())

    @property
    def url(self):
        return self.viewed.url if hasattr(self, "viewed") else self.served.url

    def opened(self):
        browser = self.page()
        browser.run(OPEN)
        return browser

    def ends(self, browser, step, state="done"):
        browser.wait(lambda: browser.run(STATE, step) == state, lambda: f"step {step} {state}, which is {browser.run(STATE, step)}: {browser.text('#calibrate-said')}")

    def found(self, browser, step):
        return {row[0]: row[1] for row in browser.run(FOUND, step)}

    def test_measured_paused_applied_and_verified(self):
        self.serve()
        browser = self.opened()
        browser.wait_text("#calibrate-reads", "the simulated instrument")
        # Before anything moves it is told what will come of it; and what is no number.
        browser.type("#calibrate-noise", "much")
        browser.click("#calibrate-plan")
        browser.wait_text("#calibrate-said", "noise of a length: much is no number")
        browser.type("#calibrate-noise", "50")
        browser.type("#calibrate-poses", "5")
        browser.click("#calibrate-plan")
        browser.wait_text("#calibrate-said", "12 to 3000")
        browser.type("#calibrate-poses", "60")
        browser.click("#calibrate-plan")
        self.ends(browser, "plan")
        self.assertIn("xyt, 60 poses", self.found(browser, "plan")["instrument"])
        browser.wait_text("#calibrate-said", "nothing has moved")
        browser.click("#calibrate-measure")
        browser.wait(lambda: browser.run(MADE) >= 14, "14 visits")
        # What they say so far is looked at while it goes on.
        browser.wait(lambda: "chi^2 a row" in self.found(browser, "measure"), "the fit so far")
        browser.click("#calibrate-pause")
        browser.wait_text("#calibrate-far", "paused")
        self.assert_accessible(browser, "calibration")
        self.picture(browser, "calibration-measures")
        made = browser.run(MADE)
        self.say(browser, "OWN?")
        browser.wait_text("#console-log", "calibration")
        self.assertLessEqual(browser.run(MADE), made + 1)
        browser.click("#calibrate-pause")
        self.ends(browser, "fit")
        browser.wait_text("#calibrate-said", "what is in force is what it was before")
        self.assertIn("63 poses", self.found(browser, "fit")["measured"])
        # The simulated stage comes with a calibration of its own, of which nobody here knows what it is worth.
        browser.click("#calibrate-apply")
        browser.wait_text("#calibrate-said", "another calibration is in force")
        browser.click("#calibrate-undo")
        browser.wait_text("#calibrate-said", "no calibration is in force")
        browser.click("#calibrate-apply")
        self.ends(browser, "apply")
        self.assertEqual(self.found(browser, "apply")["STATE"], "ON")
        browser.type("#calibrate-fresh", "12")
        browser.click("#calibrate-verify")
        browser.wait(lambda: browser.run(STATE, "verify") in ("done", "failed"), "the verification")
        verified = self.found(browser, "verify")
        self.assertEqual((browser.run(STATE, "verify"), verified["verified"]), ("done", "xyt, 12 fresh poses, each from both sides"), verified)
        self.picture(browser, "calibration")
        browser.run("document.querySelector('#calibrate-steps img').scrollIntoView({ block: 'center' })")
        self.picture(browser, "calibration-left")
        for name in ("report.html", "measured.csv", "calibration.toml"):
            kind = browser.run("return fetch(arguments[0]).then((answer) => answer.ok && answer.text()).then((text) => text.length)", f"/calibration/{name}")
            self.assertGreater(kind, 1000, name)
        browser.click("#calibrate-undo")
        browser.wait_text("#calibrate-said", "no calibration is in force")
        self.say(browser, "CAL?")
        browser.wait_text("#console-log", "STATE=OFF")

    def test_what_a_person_reads_and_goes_on_with(self):
        self.serve(page="off")
        self.viewed = Viewed(ARGUMENTS.program, "--connect", self.served.gcs)
        self.addCleanup(self.viewed.close)
        browser = self.opened()
        browser.wait_text("#calibrate-reads", "you: type what it reads")
        browser.type("#calibrate-poses", "12")
        browser.click("#calibrate-measure")
        self.agree(browser)
        browser.wait_text("#calibrate-where", "Visit 1: the stage is at x")
        browser.type("#calibrate-reading", "here\n")
        browser.wait_text("#calibrate-wrong", "'here' is no reading of this instrument")
        self.read(browser, 1)
        self.read(browser, 2)
        browser.wait_text("#calibrate-where", "Visit 3")
        self.picture(browser, "calibration-by-hand")
        browser.press(ESCAPE)
        browser.wait_text("#calibrate-said", "2 of 13 visits are kept")
        browser.wait_text("#calibrate-said", "ended by STOP by")
        self.ends(browser, "measure", "failed")
        browser.click("#calibrate-resume")
        for visit in range(3, 14):
            self.read(browser, visit)
        self.ends(browser, "fit")

    def agree(self, browser):
        """To the first move of this machine."""
        visible = "return document.getElementById('first-move').open"
        browser.wait(lambda: browser.run(visible) or browser.text("#calibrate-where"), "the question or the first visit")
        if browser.run(visible):
            browser.click("#first-move button[value=move]")

    def read(self, browser, visit):
        """The instrument sees the stage where it was sent."""
        asked = "return !document.getElementById('calibrate-ask').hidden && document.getElementById('calibrate-where').textContent"
        browser.wait(lambda: (browser.run(asked) or "").startswith(f"Visit {visit}:"), f"visit {visit}")
        words = browser.run("return document.getElementById('calibrate-where').textContent.match(/-?\\d+\\.\\d+/g)")
        browser.type("#calibrate-reading", " ".join(words[:3]) + "\n")

"""Commissioning from the page, and gains by hand: on an unknown machine with a simulated person beside it, and on one that is tuned."""

from page import OnPage
from served import Served
from settings import ARGUMENTS
from webdriver import ESCAPE

SPEED = "8"
"""Simulated seconds in a second, as far as this computer is that fast."""
STATE = """
    const item = [...document.querySelectorAll('#commission-steps > li')].find((li) => li.querySelector('b').textContent === arguments[0]);
    return item?.dataset.state ?? ''"""
OPEN = "document.getElementById(arguments[0]).open = true; document.getElementById(arguments[0]).scrollIntoView()"


class Commissioning(OnPage):
    """As somebody does it who has never seen the machine."""

    def serve(self, *stage):
        self.served = Served(ARGUMENTS.program, stage=[*stage, "--speed", SPEED])
        self.addCleanup(lambda: self.served.close())
        browser = self.page()
        return browser

    @property
    def url(self):
        return self.served.url

    def ends(self, browser, step, state="done"):
        browser.wait(lambda: browser.run(STATE, step) == state, lambda: f"step {step} {state}, which is {browser.run(STATE, step)}")

    def test_an_unknown_machine_until_it_is_stopped(self):
        browser = self.serve("--unknown", "1")
        browser.wait_text("#alarm-text", "not commissioned")
        browser.click("#commission-open")
        browser.click("#commission-start")
        browser.wait_text("#commission-words", "turn it by hand to the left")
        browser.wait_text("#commission-waits", "simulated person")
        self.picture(browser, "commissioning-task")
        self.ends(browser, "hand")
        self.ends(browser, "nudges")
        # Which plug is whose, drawn.
        browser.run("document.querySelectorAll('#commission-steps details')[2].open = true")
        loaded = "const image = document.querySelector('#commission-steps img'); return !!image && image.complete && image.naturalWidth > 0"
        browser.wait(lambda: browser.run(loaded), "the drawing of the plugs")
        browser.run("document.querySelector('#commission-steps img').scrollIntoView({ block: 'center' })")
        self.picture(browser, "commissioning-wiring")
        self.assert_accessible(browser, "commissioning")
        # It has the stage for itself, and whoever looks may stop it.
        self.say(browser, "OWN?")
        browser.wait_text("#console-log", "commissioning")
        self.ends(browser, "zeros")
        self.ends(browser, "reference", "runs")
        browser.press(ESCAPE)
        browser.wait_text("#commission-said", "ended by STOP by")
        browser.wait_text("#commission-said", "the motors are off, and nothing was kept")
        self.say(browser, "CMS?")
        browser.wait_text("#console-log", "0")
        self.assertFalse(self.lit(browser, "servo"))

    def test_gains_by_hand(self):
        browser = self.serve()
        browser.run(OPEN, "tuning")
        browser.click("#tuning-measure")
        browser.wait_text("#tuning-said", "everything is as it was")
        field = "return document.querySelectorAll('#tuning-gains tr')[2].querySelectorAll('input')[arguments[0]].value"
        velocity = [float(browser.run(field, pivot)) for pivot in range(3)]
        self.assertGreater(min(velocity), 1)
        rows = "return [...document.querySelectorAll('#tuning-worth tr')].map((row) => [...row.children].map((cell) => cell.textContent))"
        measured = browser.run(rows)[1:]
        self.assertEqual([row[0] for row in measured], ["measured, in the middle", "measured, at X 66 Y 38"])
        for row in measured:
            self.assertTrue(1 < float(row[1]) < 3, row)
        # Ten times the gain: it is told before it is in force, and not put in force.
        self.velocity(browser, [10 * value for value in velocity])
        browser.click("#tuning-predict")
        browser.wait_text("#tuning-worth", "unstable")
        browser.click("#tuning-put")
        browser.wait_text("#tuning-said", "unstable with these gains: they are not put in force")
        self.say(browser, "SPA? 1 0x54500311")
        # The page shows it rounded.
        browser.wait_text("#console-log", f"0x54500311={str(velocity[0])[:5]}")
        # A tenth less.
        less = [0.9 * value for value in velocity]
        self.velocity(browser, less)
        browser.click("#tuning-predict")
        browser.wait(lambda: len(browser.run(rows)) == 5, "two predicted loops and no more")
        loaded = "return [...document.querySelectorAll('#tuning-plots img')].slice(0, 2).every((image) => image.complete && image.naturalWidth > 0)"
        browser.run("document.getElementById('tuning-plots').scrollIntoView()")
        browser.wait(lambda: browser.run(loaded), "the plots")
        self.picture(browser, "tuning-plots")
        browser.run(OPEN, "tuning")
        self.picture(browser, "tuning")
        browser.click("#tuning-put")
        browser.wait_text("#tuning-said", "in force, and not kept")
        self.say(browser, "SPA? 1 0x54500311")
        browser.wait_text("#console-log", f"0x54500311={float(f'{less[0]:.6g}'):g}")
        self.assert_accessible(browser, "tuning")
        # No number is told by its name, and nothing is sent.
        self.velocity(browser, ["fast", *less[1:]])
        browser.click("#tuning-predict")
        browser.wait_text("#tuning-said", "velocity gain, V s/rad of pivot 1 is no number")

    def velocity(self, browser, values):
        browser.run("""
            const fields = document.querySelectorAll('#tuning-gains tr')[2].querySelectorAll('input');
            arguments[0].forEach((value, pivot) => { fields[pivot].value = value; })""",
                    [value if isinstance(value, str) else f"{value:.6g}" for value in values])

"""A stage that is no simulated one, as far as its identity says: the page shows that first, and asks before the first move."""

from page import OnPage
from relay import Relay
from served import Served, Viewed
from settings import ARGUMENTS

DIALOG = "return document.getElementById('first-move').open"


class Real(OnPage):
    """A simulated stage whose line gives it a serial number."""

    def setUp(self):
        stage = Served(ARGUMENTS.program, page="off")
        self.addCleanup(stage.close)
        self.line = Relay(stage.gcs, serial="0117")
        self.addCleanup(self.line.close)
        viewed = Viewed(ARGUMENTS.program, "--connect", self.line.place)
        self.addCleanup(viewed.close)
        self.url = viewed.url

    def asked(self, browser):
        browser.wait(lambda: browser.run(DIALOG), "the question")
        self.assertIn("0117", browser.text("#first-move-machine"))
        self.assertIn(self.line.place, browser.text("#first-move-machine"))

    def test_asks_before_the_first_move_and_only_then(self):
        browser = self.ready()
        self.assertEqual(browser.text("#machine-kind"), "REAL STAGE")
        self.assertEqual(browser.text("#machine-line"), self.line.place)
        self.enter(browser, x="30")
        self.asked(browser)
        self.picture(browser, "first-move")
        self.assert_accessible(browser, "the question before the first move")
        # STOP can be pressed meanwhile, and is an answer.
        browser.click("#stop")
        browser.wait_text("#stop-said", "stopped, as the controller says")
        browser.wait_text("#said", "not moved: not confirmed")
        self.assertFalse(browser.run(DIALOG))
        browser.click("#target button[type=submit]")
        self.asked(browser)
        browser.click("#first-move button[value=no]")
        browser.wait(lambda: not browser.run(DIALOG), "an answer")
        browser.wait_text("#said", "not moved: not confirmed")
        self.assertAlmostEqual(self.shown(browser, "x", "target"), 0, delta=0.1)
        # What was typed is still there.
        browser.click("#target button[type=submit]")
        self.asked(browser)
        browser.click("#first-move button[value=move]")
        self.arrive(browser, x=30)
        browser.click("#home")
        self.arrive(browser, x=0)
        self.assertFalse(browser.run(DIALOG))
        self.assertEqual(browser.errors(), [])

    def test_a_jog_is_not_begun_by_the_answer(self):
        browser = self.ready()
        browser.click("#jog")
        browser.run("document.querySelector('[data-step=\"X+\"]').scrollIntoView({ block: 'center' })")
        browser.hold("[data-step='X+']")
        self.asked(browser)
        browser.release()
        browser.click("#first-move button[value=move]")
        browser.wait_text("#said", "press again")
        self.assertNotEqual(browser.text("#mode"), "moving")
        self.assertAlmostEqual(self.shown(browser, "x"), 0, delta=0.1)

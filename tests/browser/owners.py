"""Who may command: two pages of one stage, over connections of their own and over one serial line; and a stage out of its reach."""

from page import OnPage
from served import Line, Served, Viewed
from settings import ARGUMENTS
from webdriver import ESCAPE


class Owners(OnPage):
    """Each test has a stage of its own."""

    def serve(self):
        served = Served(ARGUMENTS.program)
        self.addCleanup(served.close)
        self.url = served.url

    def on_a_line(self):
        line = Line(ARGUMENTS.program)
        self.addCleanup(line.close)
        viewed = Viewed(ARGUMENTS.program, *line.way)
        self.addCleanup(viewed.close)
        self.url = viewed.url

    def test_one_page_takes_the_stage_and_gives_it_back(self):
        for setup in (self.serve, self.on_a_line):
            setup()
            one, other = self.ready(), self.page()
            for browser in (one, other):
                browser.wait_text("#owner-who", "Everybody may command.")
            one.wait_text("#owner-last", "this page, just now")
            other.wait_text("#owner-last", "page 1, just now")
            one.run("document.getElementById('log-who').value = 'Anna B.'; document.getElementById('log-who').dispatchEvent(new Event('change'))")
            one.click("#own")
            one.wait_text("#owner-who", "Only this page may command.")
            other.wait_text("#owner-who", "Only Anna B may command; stopping works.")
            self.assertTrue(other.run("return document.getElementById('own').disabled"))
            self.picture(other, f"owned-by-another-{setup.__name__}")
            # Refused with the reason; and the one who owns is shown to have commanded last.
            self.enter(other, x="5")
            other.wait_text("#said", "another connection owns the stage")
            self.slow_down(one, 1)
            self.enter(one, x="60")
            for browser in (one, other):
                browser.wait_text("#mode", "moving")
            other.wait_text("#owner-last", "Anna B, just now")
            # Everybody may stop.
            other.press(ESCAPE)
            one.wait_text("#mode", "holding")
            one.click("#own")
            for browser in (one, other):
                browser.wait_text("#owner-who", "Everybody may command.")
            other.click("#own")
            other.wait_text("#owner-who", "Only this page may command.")
            one.wait_text("#owner-who", "may command; stopping works.")
            # Gone, it owns no more.
            other.close()
            one.wait_text("#owner-who", "Everybody may command.")
            self.assertEqual(one.errors(), [])
            one.close()

    def test_a_stage_out_of_its_reach_is_driven_back_in_as_long_as_a_button_is_held(self):
        self.serve()
        browser = self.ready()
        self.enter(browser, x="75")
        self.arrive(browser, x=75)
        browser.click("#servo")
        browser.wait_text("#mode", "servo off")
        # Guides that begin further out leave a disk of 68 mm.
        for line in ("CCL 1 ADVANCED", "SPA 1 0x54500201 0.32"):
            self.say(browser, line)
        self.assertFalse(browser.run("return document.getElementById('recover').checkVisibility()"))
        browser.click("#servo")
        browser.wait_text("#said", "out of the stage’s reach")
        browser.wait(lambda: browser.run("return document.getElementById('recover').checkVisibility()"), "the way back in")
        self.picture(browser, "out-of-reach")
        held = "document.getElementById('recover').dispatchEvent(new KeyboardEvent(arguments[0], { key: ' ', bubbles: true }))"
        browser.run(held, "keydown")
        browser.wait_text("#mode", "moving")
        browser.run(held, "keyup")
        # Let go, the stage is let go too, where it is.
        browser.wait_text("#mode", "servo off")
        self.assertGreater(self.shown(browser, "x"), 68.5)
        self.assertLess(self.shown(browser, "x"), 75)
        browser.run(held, "keydown")
        browser.wait_text("#mode", "holding")
        browser.wait(lambda: not browser.run("return document.getElementById('recover').checkVisibility()"), "a stage in reach")
        browser.run(held, "keyup")
        self.assertLess(self.shown(browser, "x"), 68.1)
        self.light(browser, "settled")
        self.assertEqual(browser.errors(), [])

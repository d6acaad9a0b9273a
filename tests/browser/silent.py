"""What the page says when nobody answers: controller frozen, page server frozen, line cut or silent, each while the stage moves."""

import time

from page import OnPage
from relay import Relay
from served import Served, Viewed
from settings import ARGUMENTS
from webdriver import ESCAPE

STALE = "document.body.classList.contains('stale')"


class Silent(OnPage):
    """A page in a process of its own, behind a line of its own."""

    def setUp(self):
        self.stage = Served(ARGUMENTS.program, page="off")
        self.addCleanup(lambda: self.stage.close())
        self.line = Relay(self.stage.gcs)
        self.addCleanup(lambda: self.line.close())
        self.viewed = Viewed(ARGUMENTS.program, "--connect", self.line.place)
        self.addCleanup(lambda: self.viewed.close())
        self.url = self.viewed.url

    def moving(self):
        """A page before a stage that moves for a minute."""
        browser = self.ready()
        self.slow_down(browser, 1)
        self.enter(browser, x="60")
        browser.wait_text("#mode", "moving")
        self.assertFalse(browser.run(f"return {STALE}"))
        # When each of the page's words came, by the page's own clock: a slow machine may look late.
        browser.run("""
            window.seen = {};
            window.lag = 0;
            let looked = performance.now();
            setInterval(() => { const now = performance.now(); window.lag = Math.max(window.lag, now - looked - 50); looked = now; }, 50);
            const note = () => {
              if (document.body.classList.contains('stale')) window.seen.stale ??= performance.now();
              const stop = document.getElementById('stop-said');
              if (!stop.hidden) window.seen[stop.textContent.split(',')[0]] ??= performance.now();
              const said = document.getElementById('said').textContent;
              if (said) window.seen[said.split(':')[0]] ??= performance.now();
            };
            new MutationObserver(note).observe(document.body, { subtree: true, attributes: true, childList: true, characterData: true });""")
        return browser

    def lag(self, browser):
        """What a busy machine adds to what the page does in its time, ms: each of two looks may be as late as the latest was."""
        return 2 * browser.run("return window.lag")

    def falls_silent(self, browser):
        """Says so at once; the stop is not confirmed; requests end. The request is made before the page knows."""
        begun = browser.run("""
            const begun = performance.now(); document.getElementById('halt').click(); return begun""")
        browser.wait(lambda: browser.run("return 'stale' in window.seen"), "a page that knows it is stale")
        # 500 ms from the last status, which may have come when the line fell silent, and two looks of 100 ms.
        self.assertLess(browser.run("return window.seen.stale") - begun, 900 + self.lag(browser))
        browser.wait_text("#mode", "no")
        for dimmed in ("main", "#machine", "#mode", "#notices"):
            self.assertEqual(browser.run(f"return getComputedStyle(document.querySelector('{dimmed}')).filter"), "grayscale(1) opacity(0.45)", dimmed)
        self.assertEqual(browser.run("return getComputedStyle(document.getElementById('stop')).filter"), "none")
        pressed = browser.run("const at = performance.now(); document.getElementById('stop').click(); return at")
        browser.wait_text("#stop-said", "NOT CONFIRMED: use the emergency stop")
        self.assertNotIn("stopped", browser.text("#stop-said"))
        words = browser.run("return window.seen")
        unconfirmed = next(at for text, at in words.items() if "NOT CONFIRMED" in text)
        self.assertLess(unconfirmed - pressed, 1400 + self.lag(browser))
        browser.wait(lambda: browser.text("#said") and browser.run("return document.getElementById('said').className") == "said bad",
                     "an end of the request")
        ended = browser.wait(lambda: browser.run("return window.seen['no answer within 2 s']"), "the page's own end of the request")
        self.assertLess(ended - begun, 3500)
        # What is asked for now is not kept for later.
        browser.click("#home")
        browser.wait_text("#said", "not sent: ")

    def comes_back(self, browser):
        """What has become of the stop is told, once the controller says it."""
        browser.wait_text("#stop-said", "stopped, as the controller says")
        browser.wait(lambda: not browser.run(f"return {STALE}"), "a new status")
        browser.wait_text("#mode", "holding")
        self.assertLess(abs(self.shown(browser, "x")), 50)

    def test_a_stop_is_confirmed_by_a_later_status(self):
        browser = self.moving()
        browser.press(ESCAPE)
        browser.wait_text("#stop-said", "stopped, as the controller says")
        words = browser.run("return window.seen")
        self.assertIn("stop sent", words)
        self.assertFalse([text for text in words if "NOT" in text], words)
        self.assertLess(words["stop sent"], words["stopped"])
        browser.wait_text("#mode", "holding")
        # Something else is asked for: what was said of the stop is no longer news.
        browser.click("#home")
        browser.wait(lambda: browser.run("return document.getElementById('stop-said').hidden"), "a page that forgets the stop")

    def test_a_stop_that_gets_lost_is_not_confirmed(self):
        """Status after status comes, and all say that the stage moves on."""
        browser = self.moving()
        self.line.swallow(b"\x18")
        browser.press(ESCAPE)
        browser.wait_text("#stop-said", "NOT CONFIRMED: use the emergency stop")
        browser.run("return new Promise((done) => setTimeout(done, 1000))")
        words = browser.run("return window.seen")
        self.assertNotIn("stopped", words)
        self.assertNotIn("stale", words)
        self.assertEqual(browser.text("#mode"), "moving")
        self.line.swallow(b"")
        browser.press(ESCAPE)
        browser.wait_text("#stop-said", "stopped, as the controller says")

    def test_the_controller_is_frozen(self):
        browser = self.moving()
        self.stage.freeze()
        try:
            self.falls_silent(browser)
            self.picture(browser, "stale")
        finally:
            self.stage.thaw()
        self.comes_back(browser)

    def test_the_server_of_the_page_is_frozen(self):
        browser = self.moving()
        self.viewed.freeze()
        try:
            self.falls_silent(browser)
            browser.wait_text("#said", "not sent: no status for ")
            browser.wait_text("#stale-text", "No status from the controller: what is shown is old, the stage may move.")
        finally:
            self.viewed.thaw()
        self.comes_back(browser)

    def test_the_line_is_silent(self):
        browser = self.moving()
        self.line.silence()
        self.falls_silent(browser)
        # The server gives up in its own time, and says that.
        browser.wait_text("#stale-text", "the controller")
        self.assertIn("s ago", browser.text("#stale-age"))

    def test_the_line_is_cut(self):
        browser = self.moving()
        self.line.close()
        browser.run("document.getElementById('stop').click()")
        browser.wait_text("#stop-said", "NOT CONFIRMED: use the emergency stop")
        browser.wait_text("#mode", "not connected")
        browser.wait(lambda: browser.run(f"return {STALE}"), "a page that knows it is stale")
        browser.click("#home")
        browser.wait_text("#said", "not ")
        self.assertNotIn("stopped", browser.text("#stop-said"))

    def test_the_page_itself_is_killed(self):
        browser = self.moving()
        self.viewed.close()
        browser.wait_text("#stale-text", "The server of this page does not answer")
        browser.press(ESCAPE)
        browser.wait_text("#stop-said", "stop NOT SENT, not connected. NOT CONFIRMED: use the emergency stop")
        time.sleep(0.2)
        self.assertNotIn("stopped", browser.text("#stop-said"))

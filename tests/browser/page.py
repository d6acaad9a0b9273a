"""Windows, and the live page in them, for all tests."""

import pathlib
import unittest

from served import Served
from settings import ARGUMENTS
from webdriver import Browser, Driver

SIZES = {"desk": (1280, 900), "phone": (390, 844), "large": (1600, 1000), "wide": (2200, 1300)}
README = (1360, 1480)
PLACE = 2e-3
"""How near a settled stage is to its target, mm or deg, in the decimals that the page shows."""


SOFT_SERVO = ("CCL 1 ADVANCED", "SVO X 0", "SPA 1 0x54500500 0.00002", "SPA 1 0x54500300 1", "SPA 1 0x54500301 1", "SPA 1 0x54500302 0", "SVO X 1")
"""What makes the next fast move a fault that is a real one: a servo too soft for the following error that is allowed."""


class WithDriver(unittest.TestCase):
    """Each class has a browser driver, and closes whatever windows its tests have opened."""

    @classmethod
    def setUpClass(cls):
        cls.driver = Driver()
        cls.addClassCleanup(cls.driver.close)

    def window(self, size="desk", **options):
        width, height = SIZES.get(size, README)
        browser = Browser(self.driver, width, height, **options)
        self.addCleanup(browser.close)
        return browser

    def picture(self, browser, name, **options):
        browser.picture(str(pathlib.Path(ARGUMENTS.pictures) / f"{name}.png"), **options)

    def assert_accessible(self, browser, state):
        """The rules of axe-core have nothing serious against what the window shows; what else they have is printed."""
        axe = pathlib.Path(ARGUMENTS.axe).read_text(encoding="utf-8")
        browser.run(axe + "; window.axe = axe")
        found = browser.run("""
            return axe.run(document, { resultTypes: ['violations'] }).then(({ violations }) => violations.map(
              ({ id, impact, nodes }) => [impact, id, nodes.slice(0, 3).map(({ html, failureSummary }) => html.slice(0, 160) + ' ' + failureSummary.slice(0, 300))]))""")
        serious = [one for one in found if one[0] in ("serious", "critical")]
        self.assertEqual(serious, [], state)
        for impact, rule, _ in found:
            print(f"{state}: axe says {impact}: {rule}")


class OnPage(WithDriver):
    """What a person does on the live page, and sees there. Conditions that are waited for stay true once they are: a slow
    machine may look late."""

    url = None

    def page(self, size="desk", **options):
        """A window with the page, connected."""
        browser = self.window(size, **options)
        browser.open(self.url)
        browser.wait_text("#place", "XYT-1")
        return browser

    def ready(self, size="desk", **options):
        """The same, referenced and holding."""
        browser = self.page(size, **options)
        self.reference(browser)
        return browser

    def reference(self, browser):
        visible = "return ['#reference', '#reference-again'].find((id) => document.querySelector(id).checkVisibility())"
        browser.click(browser.wait(lambda: browser.run(visible), "a way to reference"))
        for lamp in ("referenced", "servo", "settled"):
            self.light(browser, lamp)

    def lit(self, browser, lamp):
        return browser.run("return document.getElementById(arguments[0]).classList.contains('on')", f"lamp-{lamp}")

    def light(self, browser, lamp):
        """Waits for it."""
        browser.wait(lambda: self.lit(browser, lamp), f"the lamp “{lamp}”")

    def shown(self, browser, what, column="measured"):
        """A number of the pose; not a number while the page does not know it."""
        text = browser.text(f"#{what}-{column}").replace("−", "-")
        return float(text) if text != "–" else float("nan")

    def near(self, browser, what, place, within, column="measured"):
        """Waits until a number of the pose is near a place."""
        browser.wait(lambda: abs(self.shown(browser, what, column) - place) < within,
                     lambda: f"{column} {what} near {place}, which is {self.shown(browser, what, column)}")

    def enter(self, browser, **places):
        """Types targets and has the stage go there."""
        for name, text in places.items():
            browser.type(f"#{name}", str(text))
        browser.click("#target button[type=submit]")

    def aim(self, browser, x, y, says, touch=False):
        """Points at a place, mm, until the page says what it thinks of it. A finger has to touch for that."""
        browser.point("#scene", *self.pixel(browser, x, y), click=touch, touch=touch)
        browser.wait_text("#aim", says)

    def arrive(self, browser, **places):
        """Waits until the stage has settled there."""
        def there():
            near = all(abs(self.shown(browser, name) - place) < PLACE for name, place in places.items())
            return near and self.lit(browser, "settled")
        browser.wait(there, lambda: f"the stage at {places}, which is at {[self.shown(browser, name) for name in places]}")

    def slow_down(self, browser, speed):
        """So slow that nothing arrives while the test looks, mm/s."""
        browser.type("#vls", str(speed))
        browser.click("#speed button")
        browser.wait(lambda: browser.run("return document.getElementById('vls').placeholder") == str(speed), f"the speed {speed} mm/s")

    def pixel(self, browser, x, y):
        """Where a place, mm, is on the canvas, from its middle, all of which is brought into view."""
        browser.run("document.querySelector('main').scrollTo(0, 0)")
        scale = browser.run(
            "const c = document.getElementById('scene'); return Math.min(c.clientWidth, c.clientHeight) / (2 * 100 * 1.72)")
        return x * scale, -y * scale

    def say(self, browser, line):
        """A line at the page's own command line."""
        browser.run("document.getElementById('console').open = true")
        browser.type("#console-line", line + "\n")
        browser.wait_text("#console-log", f"> {line}")


class OnServed(OnPage):
    """The page that `tripivot serve` serves: each test has a stage of its own."""

    def setUp(self):
        self.served = Served(ARGUMENTS.program)
        self.addCleanup(lambda: self.served.close())

    @property
    def url(self):
        return self.served.url

"""`tripivot view`: the page for a controller that runs already, behind a serial line or on the emulated chip."""

from page import OnPage
from served import ChipLine, Line, Viewed
from settings import ARGUMENTS
from webdriver import ESCAPE


class View:
    """The same for each way to the controller."""

    def controller(self):
        """Starts it."""
        raise NotImplementedError

    def setUp(self):
        controller = self.controller()
        self.addCleanup(controller.close)
        viewed = Viewed(ARGUMENTS.program, *controller.way)
        self.addCleanup(viewed.close)
        self.url = viewed.url
        self.place = controller.way[1]

    def test_loads_moves_arrives_and_stops(self):
        browser = self.page()
        self.assertEqual(browser.text("#machine-line"), self.place)
        self.reference(browser)
        self.enter(browser, x="20", y="-10", w="30")
        self.assertEqual(browser.text("#machine-kind"), "SIMULATED")
        self.arrive(browser, x=20, y=-10, w=30)
        self.aim(browser, 70, 60, "outside the usable disk")
        self.aim(browser, -10, 5, "mm: reachable")
        browser.point("#scene", *self.pixel(browser, -10, 5), click=True)
        self.near(browser, "x", -10, 1)
        self.picture(browser, f"view-{self.id().split('.')[1]}")
        self.slow_down(browser, 2)
        self.enter(browser, x="60", y="0", w="0")
        browser.wait_text("#mode", "moving")
        browser.press(ESCAPE)
        browser.wait_text("#mode", "holding")
        self.assertLess(self.shown(browser, "x"), 50)
        browser.wait_text("#stop-said", "stopped, as the controller says")
        # Waiting in a sequence holds nobody up, though all share the line.
        self.slow_down(browser, 100)
        browser.run("""
            document.getElementById('sequence').open = true;
            const text = document.getElementById('sequence-text');
            text.value = 'MOV X 5 Y 0 W 0\\nWAC ONT? X = 1\\nDEL 50\\nPOS? X'; text.dispatchEvent(new Event('change'))""")
        browser.click("#sequence-run")
        browser.wait_text("#sequence-said", "done: 4 lines")
        self.arrive(browser, x=5, y=0, w=0)
        self.assertEqual(browser.errors(), [])


class OnTerminal(View, OnPage):
    """A pseudo-terminal in place of a serial line."""

    def controller(self):
        return Line(ARGUMENTS.program)


class OnChip(View, OnPage):
    """The image `stage` on the emulated chip, which is some times slower than the real one."""

    def controller(self):
        return ChipLine(ARGUMENTS.image)

"""Drives page and report in headless Chromium as a person would. Started by `run`, which says where everything is."""

import argparse
import csv
import pathlib
import re
import unittest

from served import Served
from webdriver import Browser, Driver

ARGUMENTS = argparse.Namespace()
ESCAPE, ENTER, UP, RIGHT = "\ue00c", "\ue007", "\ue013", "\ue014"
SIZES = {"desk": (1280, 900), "phone": (360, 740), "large": (2200, 1300)}
README = (1360, 1480)


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


class Live(WithDriver):
    """The live page in front of a simulated stage of its own."""

    def setUp(self):
        self.served = Served(ARGUMENTS.program)
        self.addCleanup(lambda: self.served.close())

    def page(self, size="desk", **options):
        """A window with the page, connected."""
        browser = self.window(size, **options)
        browser.open(self.served.url)
        browser.wait_text("#place", "XYT-1")
        return browser

    def ready(self, size="desk", **options):
        """The same, referenced."""
        browser = self.page(size, **options)
        browser.click("#reference")
        browser.wait(lambda: self.lit(browser, "referenced"), "the reference")
        return browser

    def lit(self, browser, lamp):
        return browser.run("return document.getElementById(arguments[0]).classList.contains('on')", f"lamp-{lamp}")

    def shown(self, browser, what, column="measured"):
        text = browser.text(f"#{what}-{column}").replace("−", "-")
        return float(text) if text != "–" else None

    def arrive(self, browser, **places):
        def there():
            near = all(abs(self.shown(browser, name) - place) < 2e-3 for name, place in places.items())
            return near and self.lit(browser, "settled")
        browser.wait(there, f"the stage at {places}")

    def pixel(self, browser, x, y):
        """Where a place, mm, is on the canvas, from its middle."""
        scale = browser.run(
            "const c = document.getElementById('scene'); return Math.min(c.clientWidth, c.clientHeight) / (2 * 100 * 1.72)")
        return x * scale, -y * scale

    def say(self, browser, line):
        """A line at the page's own command line."""
        browser.run("document.getElementById('console').open = true")
        browser.type("#console-line", line + "\n")
        browser.wait_text("#console-log", f"> {line}")

    def test_loads_and_complains_of_nothing(self):
        browser = self.page()
        browser.wait_text("#mode", "servo off")
        self.assertIn("127.0.0.1", browser.text("#place"))
        self.assertEqual(browser.errors(), [])

    def test_moves_by_entry_and_is_seen_to_arrive(self):
        browser = self.ready()
        for field, value in (("#x", "30"), ("#y", "-20,5"), ("#w", "90")):
            browser.type(field, value)
        browser.click("#target button[type=submit]")
        self.arrive(browser, x=30, y=-20.5, w=90)
        self.picture(browser, "entry")
        self.assertEqual(browser.errors(), [])

    def test_moves_by_click_once_it_is_known_to_be_reachable(self):
        browser = self.ready()
        browser.point("#scene", *self.pixel(browser, 50, 30))
        browser.wait_text("#aim", "reachable")
        self.picture(browser, "aim")
        browser.point("#scene", *self.pixel(browser, 50, 30), click=True)
        browser.wait(lambda: abs(self.shown(browser, "x") - 50) < 1, "the stage near the click")
        browser.wait(lambda: self.lit(browser, "settled"), "the end of the motion")
        self.assertAlmostEqual(self.shown(browser, "y"), 30, delta=1)

    def test_refuses_what_cannot_be_reached_and_says_why(self):
        browser = self.ready()
        browser.point("#scene", *self.pixel(browser, 70, 60))
        browser.wait_text("#aim", "outside the usable disk")
        self.picture(browser, "unreachable")
        browser.point("#scene", *self.pixel(browser, 70, 60), click=True)
        browser.type("#x", "200")
        browser.click("#target button[type=submit]")
        browser.wait_text("#said", "out of the stage’s reach")
        browser.type("#x", "1o")
        browser.click("#target button[type=submit]")
        browser.wait_text("#said", "“1o” is not a number")
        self.assertAlmostEqual(self.shown(browser, "x", "target"), 0, delta=0.1)
        self.assertAlmostEqual(self.shown(browser, "x"), 0, delta=0.1)

    def test_stops_a_motion_by_button_and_by_key(self):
        browser = self.ready()
        browser.type("#vls", "5")
        browser.click("#speed button")
        browser.wait_text("#vls-now", "5 mm/s")
        for field, stop in (("60", lambda: browser.click("#stop")), ("-60", lambda: browser.press(ESCAPE))):
            browser.type("#x", field)
            browser.click("#target button[type=submit]")
            browser.wait_text("#mode", "moving")
            stop()
            browser.wait_text("#mode", "holding")
            browser.wait_text("#said", "stopped")
            self.assertLess(abs(self.shown(browser, "x")), 50)
        # What comes after a stop is no error of its own.
        browser.click("#home")
        self.arrive(browser, x=0, y=0, w=0)

    def test_shows_a_fault_in_words_and_has_it_acknowledged(self):
        browser = self.ready()
        # A fault that is a real one: the largest following error allowed is set to less than a fast move has.
        for line in ("CCL 1 ADVANCED", "SVO X 0", "SPA 1 0x54500500 0.00002", "SVO X 1", "MOV X 60 Y 0 W 180"):
            self.say(browser, line)
        browser.wait_text("#alarm-text", "Fault: following error too large, pivot ")
        self.assertIn("rad, limit", browser.text("#alarm-text"))
        browser.wait_text("#mode", "fault")
        self.picture(browser, "fault")
        browser.click("#home")
        browser.wait_text("#said", "a fault is latched")
        browser.click("#acknowledge")
        browser.wait_text("#mode", "servo off")
        browser.wait(lambda: browser.run("return document.getElementById('alarm').hidden"), "the alarm's end")

    def test_survives_the_servers_restart(self):
        browser = self.ready()
        self.served.close()
        browser.wait_text("#mode", "not connected")
        browser.wait_text("#alarm-text", "Trying again")
        self.picture(browser, "offline")
        self.served = Served(ARGUMENTS.program, self.served.gcs, self.served.page)
        browser.wait_text("#mode", "servo off")
        browser.wait(lambda: not self.lit(browser, "referenced"), "a stage that has just started")
        browser.click("#reference")
        browser.wait(lambda: self.lit(browser, "referenced"), "the reference")
        browser.type("#x", "12")
        browser.click("#target button[type=submit]")
        self.arrive(browser, x=12)

    def test_several_viewers_see_the_same_stage(self):
        one, other, third = self.ready(), self.page("phone", touch=True), self.page(dark=True)
        one.type("#x", "-33")
        one.click("#target button[type=submit]")
        for browser in (one, other, third):
            self.arrive(browser, x=-33)
        # An error is the business of the one who made it.
        one.type("#x", "333")
        one.click("#target button[type=submit]")
        one.wait_text("#said", "out of the stage’s reach")
        self.assertNotIn("reach", other.text("#said"))

    def test_keys_do_what_the_pointer_does(self):
        browser = self.ready()
        browser.run("document.getElementById('scene').focus()")
        browser.press(RIGHT)
        browser.press(RIGHT)
        browser.press(UP)
        browser.wait_text("#aim", "x 2.0, y 1.0 mm: reachable")
        browser.press(ENTER)
        self.arrive(browser, x=2, y=1)
        # Every control is reached with the tab key, and what has the focus can be seen.
        names = browser.run("""
            return [...document.querySelectorAll('button, input, select, summary, canvas[tabindex]')]
              .filter((e) => e.checkVisibility() && e.tabIndex < 0).map((e) => e.id || e.textContent)""")
        self.assertEqual(names, [])

    def test_a_finger_sees_first_and_then_moves(self):
        browser = self.ready("phone", touch=True)
        browser.point("#scene", *self.pixel(browser, -40, 0), click=True, touch=True)
        browser.wait_text("#aim", "reachable")
        self.assertAlmostEqual(self.shown(browser, "x", "target"), 0, delta=0.1)
        browser.click("#aim-go")
        browser.wait(lambda: abs(self.shown(browser, "x") + 40) < 1, "the stage near the tap")

    def test_steps(self):
        browser = self.ready()
        browser.click("[data-step='X+']")
        browser.wait(lambda: abs(self.shown(browser, "x", "target") - 5) < 0.1, "the step")
        browser.click("[data-step='W-']")
        browser.wait(lambda: abs(self.shown(browser, "w", "target") + 15) < 0.1, "the turn")
        browser.wait(lambda: self.lit(browser, "settled"), "the end of the motion")
        self.assertAlmostEqual(self.shown(browser, "x"), 5, delta=0.1)

    def test_jogs_as_long_as_a_button_is_held(self):
        browser = self.ready()
        browser.click("#jog")
        browser.run("document.querySelector('[data-step=\"X+\"]').scrollIntoView({ block: 'center' })")
        browser.hold("[data-step='X+']")
        browser.wait_text("#mode", "moving")
        browser.wait(lambda: self.shown(browser, "x") > 1, "the stage under way")
        browser.release()
        browser.wait_text("#mode", "holding")
        place = self.shown(browser, "x")
        self.assertLess(place, 79)
        browser.wait(lambda: self.lit(browser, "settled"), "rest")
        self.assertAlmostEqual(self.shown(browser, "x"), place, delta=0.5)

    def test_clicks_are_meant_in_the_frame_in_force(self):
        browser = self.ready()
        for line in ("KSW TABLE X 20 Y 10 W 90", "KEN TABLE"):
            self.say(browser, line)
        # The frame's x axis is the stage's y axis.
        browser.wait(lambda: abs(self.shown(browser, "x") + 10) < 0.1, "the pose in the frame")
        browser.run("document.getElementById('console').open = false; scrollTo(0, 0)")
        browser.point("#scene", *self.pixel(browser, 20, 40))
        browser.wait_text("#aim", "reachable")
        browser.point("#scene", *self.pixel(browser, 20, 40), click=True)
        browser.wait(lambda: abs(self.shown(browser, "x") - 30) < 1, "the stage 30 mm along the frame’s x axis")
        self.assertAlmostEqual(self.shown(browser, "y", "target"), 0, delta=1)
        self.picture(browser, "frame")
        self.assertEqual(browser.errors(), [])

    def test_a_bad_parameter_value_is_refused_in_words(self):
        browser = self.page()
        browser.run("document.getElementById('parameters').open = true")
        field = "#parameters input[aria-label='speed of rotation']"
        browser.wait(lambda: browser.run("return !!document.querySelector(arguments[0])", field), "the parameters")
        before = browser.run("return document.querySelector(arguments[0]).value", field)
        self.picture(browser, "parameters", whole=True)
        for text, reason in (("abc", "is not a number; nothing was changed"), ("1e9", "out of range; nothing was changed")):
            browser.type(field, text + "\t")
            browser.wait_text("#parameters .said", reason)
        browser.type(field, "100\t")
        browser.wait_text("#parameters .said", "set")
        self.say(browser, "SPA? 1 0x54500103")
        browser.wait_text("#console-log", "1 0x54500103=100")
        self.assertEqual(before, "360")
        # What can break a machine asks for more.
        window = "#parameters input[aria-label='largest following error']"
        browser.type(window, "0.01\t")
        browser.wait_text("#parameters .said", "this needs command level 1; nothing was changed")
        browser.type("#parameters input[type=password]", "ADVANCED\n")
        browser.wait_text("#parameters .said", "unlocked")
        browser.type(window, "0.01\t")
        browser.wait_text("#parameters .said", "largest following error: set")

    def test_records_a_move_looks_at_it_and_saves_it(self):
        browser = self.ready()
        browser.run("document.getElementById('recorder').open = true")
        browser.wait(lambda: browser.run("return !!document.querySelector('#recorder form')"), "the recorder's form")
        browser.click("#recorder button[type=submit]")
        browser.wait_text("#recorder .said", "armed")
        browser.type("#x", "20")
        browser.click("#target button[type=submit]")
        browser.wait_text("#recorder .said", "fetched")
        # What would be saved.
        browser.run("""
            window.saved = null;
            const make = URL.createObjectURL;
            URL.createObjectURL = (blob) => { blob.text().then((text) => { window.saved = text; }); return make.call(URL, blob); }""")
        browser.run("document.querySelector('#recorder').scrollIntoView()")
        self.picture(browser, "recorder")
        browser.run("[...document.querySelectorAll('#recorder button')].find((b) => b.textContent.includes('CSV')).click()")
        text = browser.wait(lambda: browser.run("return window.saved"), "the file")
        head, *rows = text.strip().split("\n")
        self.assertTrue(head.startswith("time_s,"), head)
        columns = [[float(cell) for cell in row.split(",")] for row in rows]
        self.assertGreater(len(columns), 100)
        self.assertEqual({len(row) for row in columns}, {7})
        self.assertGreater(columns[-1][0], columns[0][0])
        # Set and measured x leave where they were.
        self.assertGreater(abs(columns[-1][1] - columns[0][1]), 0.1)
        self.assertAlmostEqual(columns[-1][1], columns[-1][2], delta=0.01)
        self.assertEqual(browser.errors(), [])

    def test_statistics_of_the_loop(self):
        browser = self.page()
        browser.run("document.getElementById('statistics').open = true")
        browser.wait_text("#statistics-body", "late ticks")
        self.picture(browser, "statistics", whole=True)
        self.assertEqual(browser.errors(), [])

    def test_stop_is_never_out_of_sight_and_nothing_is_wider_than_the_window(self):
        for size in SIZES:
            for dark in (False, True):
                browser = self.ready(size, dark=dark, touch=size == "phone")
                browser.run("for (const d of document.querySelectorAll('details')) d.open = true")
                for place in ("0", "document.body.scrollHeight"):
                    browser.run(f"scrollTo(0, {place})")
                    top = browser.run("""
                        const box = document.getElementById('stop').getBoundingClientRect();
                        const at = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
                        return at && at.closest('#stop') ? box.width * box.height : 0""")
                    self.assertGreater(top, 4000, (size, place))
                wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
                self.assertEqual(wide, 0, size)
                browser.close()

    def test_numbers_do_not_jump_about(self):
        browser = self.ready()
        widths = "return ['x', 'y', 'w'].map((n) => document.getElementById(n + '-measured').getBoundingClientRect().x)"
        before = browser.run(widths)
        browser.type("#w", "-1234")
        browser.click("#target button[type=submit]")
        browser.wait_text("#mode", "moving")
        self.assertEqual(browser.run(widths), before)
        self.arrive(browser, w=-1234)
        self.assertEqual(browser.run(widths), before)

    def test_looks(self):
        """Screenshots in motion, and how many pictures a second were drawn; for people to look at."""
        for size in SIZES:
            for dark in (False, True):
                browser = self.ready(size, dark=dark, touch=size == "phone")
                self.say(browser, "MOV X 45 Y 25 W 75")
                self.arrive(browser, x=45, y=25, w=75)
                self.say(browser, "MOV X -35 Y 40 W -30")
                browser.run("document.getElementById('console').open = false; scrollTo(0, 0)")
                browser.wait(lambda: self.shown(browser, "x") < 0, "half of the way")
                name = f"{size}-{'dark' if dark else 'light'}"
                self.picture(browser, name)
                self.picture(browser, f"{name}-whole", whole=True)
                rate = browser.call("POST", "/execute/async", {"script": """
                    const done = arguments[0]; let count = 0; const start = performance.now();
                    function next(now) { count += 1; now - start > 1000 ? done(count * 1000 / (now - start)) : requestAnimationFrame(next); }
                    requestAnimationFrame(next)""", "args": []})
                print(f"{name}: {rate:.0f} pictures a second")
                self.say(browser, "MOV X 0 Y 0 W 0")
                self.arrive(browser, x=0, y=0, w=0)
                browser.close()


    def test_picture_of_the_readme(self):
        """What `hal-sim/pictures/live-view.png` is: aimed at a place, after two moves, with the plots in sight."""
        browser = self.ready("readme")
        for x, y, w in ((45, 25, 75), (-35, 40, -30), (20, -15, 35)):
            self.say(browser, f"MOV X {x} Y {y} W {w}")
            self.arrive(browser, x=x, y=y, w=w)
        browser.run("document.getElementById('console').open = false; scrollTo(0, 0)")
        browser.point("#scene", *self.pixel(browser, 5, 64))
        browser.wait_text("#aim", "reachable")
        self.picture(browser, "live-view")


class Report(WithDriver):
    """The report of the demonstration, opened from disk."""

    def page(self, size="desk", **options):
        browser = self.window(size, **options)
        browser.devtools("Network.enable")
        browser.devtools("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        browser.open(pathlib.Path(ARGUMENTS.report).resolve().as_uri())
        browser.wait_text("#span-text", "moves")
        return browser

    def drawn(self, browser, selector):
        """What is on a canvas, once it has been drawn again."""
        return browser.call("POST", "/execute/async", {"script": """
            const [selector, done] = arguments;
            requestAnimationFrame(() => requestAnimationFrame(() => done(document.querySelector(selector).toDataURL())))
            """, "args": [selector]})

    def range(self, browser):
        first, _, last, _ = browser.text("#shown").split()
        return float(first), float(last)

    def shows_the_trace(self, browser, time_s):
        """The shown pose is that of the trace beside the report, to where it was a hundredth of a second before or after."""
        names = ("x_mm", "y_mm", "theta_deg")
        with open(pathlib.Path(ARGUMENTS.report).with_name("trace.csv"), newline="") as file:
            near = [row for row in csv.DictReader(file) if abs(float(row["time_s"]) - time_s) <= 0.01]
        shown = [float(number.replace("−", "-")) for number in re.findall(r"[−-]?\d+\.\d+", browser.text("#pose"))]
        for value, name in zip(shown, names, strict=True):
            places = [float(row[name]) for row in near]
            self.assertTrue(min(places) - 1e-3 <= value <= max(places) + 1e-3, (name, value, min(places), max(places)))

    def test_opens_from_disk_without_a_network(self):
        browser = self.page()
        loaded = browser.run("return performance.getEntriesByType('resource').map((entry) => entry.name)")
        self.assertEqual(loaded, [])
        self.assertEqual(browser.errors(), [])
        self.assertIn("20 moves", browser.text("#span-text"))
        self.assertIn("following error while moving", browser.text("#summary"))
        self.assertLess(pathlib.Path(ARGUMENTS.report).stat().st_size, 5_000_000)

    def test_the_slider_moves_the_mechanism_and_the_cursor_in_the_plots(self):
        browser = self.page()
        canvases = ["#scene", "#plots canvas"]
        before = [self.drawn(browser, canvas) for canvas in canvases]
        browser.run("const s = document.getElementById('time'); s.value = 4.2; s.dispatchEvent(new Event('input'))")
        browser.wait_text("#now", "4.200 s")
        for canvas, picture in zip(canvases, before):
            self.assertNotEqual(self.drawn(browser, canvas), picture, canvas)
        self.shows_the_trace(browser, 4.2)
        self.picture(browser, "report")
        self.picture(browser, "report-whole", whole=True)
        phone = self.page("phone", dark=True, touch=True)
        self.picture(phone, "report-phone", whole=True)
        self.assertEqual(phone.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth"), 0)

    def test_it_plays(self):
        browser = self.page()
        browser.click("#play")
        browser.wait(lambda: float(browser.text("#now").split()[0]) > 0.3, "the cursor to run")
        browser.click("#play")
        browser.wait_text("#play", "Play")

    def test_plots_zoom_by_pointer_keys_and_buttons(self):
        browser = self.page()
        whole = self.range(browser)
        browser.point("#plots canvas", -100, 0, drag_to=(100, 0))
        browser.wait(lambda: self.range(browser)[1] - self.range(browser)[0] < 0.5 * (whole[1] - whole[0]), "the zoom")
        self.assertGreater(self.range(browser)[0], whole[0])
        self.picture(browser, "report-zoomed")
        browser.click("[data-zoom=all]")
        self.assertEqual(self.range(browser), whole)
        browser.run("document.querySelector('#plots canvas').focus()")
        for key in "++":
            browser.press(key)
        self.assertLess(self.range(browser)[1] - self.range(browser)[0], 0.6 * (whole[1] - whole[0]))
        before = self.range(browser)
        browser.press(RIGHT)
        self.assertGreater(self.range(browser)[0], before[0])
        browser.press("0")
        self.assertEqual(self.range(browser), whole)
        browser.click("#moves button")
        self.assertLess(self.range(browser)[1], 1.0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("program", "report", "pictures"):
        parser.add_argument(f"--{name}", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    unittest.main(argv=["drive.py", *rest])

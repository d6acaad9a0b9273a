"""The report that a run leaves, opened from disk."""

import base64
import csv
import json
import pathlib
import re
import struct

from page import WithDriver
from settings import ARGUMENTS
from webdriver import RIGHT


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
        for value, name in zip(self.shown_pose(browser), names, strict=True):
            places = [float(row[name]) for row in near]
            self.assertTrue(min(places) - 1e-3 <= value <= max(places) + 1e-3, (name, value, min(places), max(places)))

    def shown_pose(self, browser):
        return [float(number.replace("−", "-")) for number in re.findall(r"[−-]?\d+\.\d+", browser.text("#pose"))]

    def test_the_pose_lies_inside_its_stretch(self):
        """What is shown at the cursor is between the lowest and the highest of the stretch of time that the cursor is in."""
        browser = self.page()
        run = json.loads(browser.run("return document.getElementById('run').textContent"))

        def unpacked(text):
            data = base64.b64decode(text)
            return struct.unpack(f"<{len(data) // 4}f", data)

        ends = unpacked(run["times"])
        channels = [[unpacked(text) for text in channel] for channel in run["channels"][:3]]
        # The fastest motion, where neighbours differ most, is among them; late and early in a stretch.
        speed = unpacked(run["channels"][5][1])
        fastest = max(range(1, len(ends)), key=lambda at: speed[at])
        stretches = [*range(1, len(ends) - 1, len(ends) // 25), fastest]
        for at in stretches:
            for share in (0.02, 0.5, 0.98):
                time_s = ends[at - 1] + share * (ends[at] - ends[at - 1])
                browser.run(f"const s = document.getElementById('time'); s.value = {time_s!r}; s.dispatchEvent(new Event('input'))")
                self.drawn(browser, "#scene")
                for value, (low, high) in zip(self.shown_pose(browser), channels, strict=True):
                    self.assertTrue(low[at] - 6e-4 <= value <= high[at] + 6e-4, (time_s, value, low[at], high[at]))

    def test_opens_from_disk_without_a_network(self):
        browser = self.page()
        loaded = browser.run("return performance.getEntriesByType('resource').map((entry) => entry.name)")
        self.assertEqual(loaded, [])
        self.assertEqual(browser.errors(), [])
        self.assertIn("20 moves", browser.text("#span-text"))
        self.assertIn("errors while moving", browser.text("#summary"))
        self.assertIn("seed 1; mismatch 0 %", browser.text("#conditions"))
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

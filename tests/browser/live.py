"""The live page in front of a simulated stage of its own, used as a person would."""

import contextlib
import os
import signal
import time

from page import SIZES, SOFT_SERVO, OnServed
from served import Served
from settings import ARGUMENTS
from webdriver import ENTER, ESCAPE, RIGHT, UP


class Live(OnServed):
    """What everybody does."""

    def test_loads_and_complains_of_nothing(self):
        browser = self.page()
        browser.wait_text("#mode", "servo off")
        self.assertEqual(browser.text("#machine-kind"), "SIMULATED")
        self.assertEqual(browser.text("#machine-line"), self.served.gcs)
        self.assertEqual(browser.errors(), [])

    def test_moves_by_entry_and_is_seen_to_arrive(self):
        browser = self.ready()
        self.enter(browser, x="30", y="-20,5", w="90")
        self.arrive(browser, x=30, y=-20.5, w=90)
        self.picture(browser, "entry")
        self.assertEqual(browser.errors(), [])

    def test_sends_only_what_is_filled_in(self):
        browser = self.ready()
        self.assertEqual(browser.run("return document.getElementById('x').value"), "")
        self.enter(browser)
        browser.wait_text("#said", "no field is filled in")
        self.enter(browser, x="30", w="450")
        self.arrive(browser, x=30, w=450)
        self.enter(browser, y="-20")
        self.arrive(browser, x=30, y=-20, w=450)
        # The fields show the target, and are empty.
        for field, target in (("x", "30.0000"), ("y", "−20.0000"), ("w", "450.0000")):
            placeholder = f"return document.getElementById('{field}').placeholder"
            browser.wait(lambda: browser.run(placeholder) == target, f"{field} at {target}")
            self.assertEqual(browser.run(f"return document.getElementById('{field}').value"), "")
        # What does not go stays, to be mended.
        self.enter(browser, x="200")
        browser.wait_text("#said", "out of the stage’s reach")
        self.assertEqual(browser.run("return document.getElementById('x').value"), "200")
        # The way to 0, 0, 0 is told before it is gone.
        browser.wait_text("#home-way", "36.1 mm, and 450.0° clockwise (1.25 turns)")
        browser.click("#home")
        self.arrive(browser, x=0, y=0, w=0)
        browser.wait_text("#home-way", "it is there")

    def test_the_reference_and_the_servo_say_what_they_do(self):
        browser = self.page()
        browser.wait(lambda: browser.run("return document.getElementById('first-step').checkVisibility()"), "the first step")
        self.assertIn("Nothing moves", browser.text("#first-step"))
        self.assertTrue(browser.run("return document.getElementById('servo').disabled"))
        self.picture(browser, "first-step")
        self.reference(browser)
        self.assertFalse(browser.run("return document.getElementById('first-step').checkVisibility()"))
        checked = "return document.getElementById('servo').getAttribute('aria-checked')"
        self.assertEqual(browser.run(checked), "true")
        self.assertIn("the motors let go", browser.text("#servo-does"))
        browser.click("#servo")
        browser.wait_text("#mode", "servo off")
        browser.wait(lambda: browser.run(checked) == "false", "a switch that is off")
        self.assertIn("hold the stage where it is", browser.text("#servo-does"))
        browser.click("#servo")
        browser.wait_text("#mode", "holding")

    def test_the_speed_is_overridden(self):
        browser = self.ready()
        browser.run("""
            const slider = document.getElementById('override');
            slider.value = '25'; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change'))""")
        speed = "return document.getElementById('vls').placeholder"
        browser.wait(lambda: browser.run(speed) == "50", "a quarter of the speed")
        self.slow_down(browser, 100)
        browser.wait_text("#override-share", "50 %")
        # In motion it acts at once: with the speed that it began with, the way takes a minute.
        self.slow_down(browser, 1)
        self.enter(browser, x="60")
        browser.wait_text("#mode", "moving")
        begun = time.monotonic()
        browser.run("""
            const slider = document.getElementById('override');
            slider.value = '50'; slider.dispatchEvent(new Event('change'))""")
        self.arrive(browser, x=60)
        self.assertLess(time.monotonic() - begun, 30)

    def test_moves_by_click_once_it_is_known_to_be_reachable(self):
        browser = self.ready()
        self.aim(browser, 50, 30, "mm: reachable")
        self.picture(browser, "aim")
        browser.point("#scene", *self.pixel(browser, 50, 30), click=True)
        self.near(browser, "x", 50, 1)
        self.near(browser, "y", 30, 1)
        self.light(browser, "settled")

    def test_refuses_what_cannot_be_reached_and_says_why(self):
        browser = self.ready()
        self.aim(browser, 70, 60, "outside the usable disk")
        self.picture(browser, "unreachable")
        browser.point("#scene", *self.pixel(browser, 70, 60), click=True)
        self.enter(browser, x="200")
        browser.wait_text("#said", "out of the stage’s reach")
        self.enter(browser, x="1o")
        browser.wait_text("#said", "“1o” is not a number")
        self.assertAlmostEqual(self.shown(browser, "x", "target"), 0, delta=0.1)
        self.assertAlmostEqual(self.shown(browser, "x"), 0, delta=0.1)

    def test_stops_a_motion_by_button_and_by_key(self):
        browser = self.ready()
        # A minute from the middle to the target.
        self.slow_down(browser, 1)
        for target, stop in (("60", lambda: browser.click("#stop")), ("-60", lambda: browser.press(ESCAPE))):
            self.enter(browser, x=target)
            browser.wait_text("#mode", "moving")
            browser.wait_text("#said", "on its way")
            stop()
            browser.wait_text("#mode", "holding")
            browser.wait_text("#stop-said", "stopped, as the controller says")
            self.assertLess(abs(self.shown(browser, "x")), 50)
        # What comes after a stop is no error of its own.
        self.slow_down(browser, 200)
        browser.click("#home")
        self.arrive(browser, x=0, y=0, w=0)

    def test_shows_a_fault_in_words_and_has_it_acknowledged(self):
        browser = self.ready()
        for line in (*SOFT_SERVO, "MOV X 60 Y 0 W 180"):
            self.say(browser, line)
        browser.wait_text("#alarm-text", "Fault: following error too large, pivot ")
        self.assertIn("rad, limit", browser.text("#alarm-text"))
        browser.wait_text("#mode", "fault")
        self.picture(browser, "fault")
        self.assert_accessible(browser, "a fault")
        browser.click("#home")
        browser.wait_text("#said", "a fault is latched")
        browser.click("#acknowledge")
        browser.wait_text("#mode", "servo off")
        browser.wait(lambda: browser.run("return document.getElementById('alarm').hidden"), "the alarm's end")

    def test_survives_the_servers_restart(self):
        browser = self.ready()
        self.served.close()
        browser.wait_text("#mode", "not connected")
        browser.wait_text("#stale-text", "Trying again")
        self.picture(browser, "offline")
        self.served = Served(ARGUMENTS.program, self.served.gcs, self.served.page)
        browser.wait_text("#mode", "servo off")
        browser.wait(lambda: not self.lit(browser, "referenced"), "a stage that has just started")
        self.reference(browser)
        self.enter(browser, x="12")
        self.arrive(browser, x=12)

    def test_several_viewers_see_the_same_stage(self):
        one, other, third = self.ready(), self.page("phone", touch=True), self.page(dark=True)
        self.enter(one, x="-33")
        for browser in (one, other, third):
            self.arrive(browser, x=-33)
        # An error is the business of the one who made it.
        self.enter(one, x="333")
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
        self.aim(browser, -40, 0, "mm: reachable", touch=True)
        self.assertAlmostEqual(self.shown(browser, "x", "target"), 0, delta=0.1)
        browser.click("#aim-go")
        self.near(browser, "x", -40, 1)

    def test_steps(self):
        browser = self.ready()
        browser.click("[data-step='X+']")
        self.near(browser, "x", 5, 0.1, "target")
        browser.click("[data-step='W-']")
        self.near(browser, "w", -15, 0.1, "target")
        self.arrive(browser, x=5, w=-15)

    def hold_a_jog(self, browser):
        """Presses a button, and keeps it pressed: half a minute to the edge of the disk."""
        browser.click("#jog")
        browser.type("#step-mm", "2.5")
        browser.run("document.querySelector('[data-step=\"X+\"]').scrollIntoView({ block: 'center' })")
        browser.hold("[data-step='X+']")

    def test_jogs_as_long_as_a_button_is_held(self):
        browser = self.ready()
        self.hold_a_jog(browser)
        browser.wait_text("#mode", "moving")
        browser.wait(lambda: self.shown(browser, "x") > 1, "the stage under way")
        browser.release()
        browser.wait_text("#mode", "holding")
        place = self.shown(browser, "x")
        self.assertLess(place, 79)
        self.light(browser, "settled")
        self.assertAlmostEqual(self.shown(browser, "x"), place, delta=0.5)

    def test_a_jog_ends_with_its_browser(self):
        """Killed, or asleep with its computer: no button is let go, and no connection closed."""
        other = self.ready()
        for how in (signal.SIGKILL, signal.SIGSTOP):
            browser = self.page()
            self.hold_a_jog(browser)
            other.wait_text("#mode", "moving")
            processes = browser.processes()
            self.assertTrue(processes)
            for process in processes:
                os.kill(process, how)
            try:
                other.wait_text("#mode", "holding")
                self.light(other, "settled")
                self.assertLess(self.shown(other, "x"), 79)
            finally:
                if how == signal.SIGSTOP:
                    for process in processes:
                        os.kill(process, signal.SIGCONT)
            with contextlib.suppress(RuntimeError, OSError):
                browser.close()

    def test_clicks_are_meant_in_the_frame_in_force(self):
        browser = self.ready()
        for line in ("KSW TABLE X 20 Y 10 W 90", "KEN TABLE"):
            self.say(browser, line)
        # The frame's x axis is the stage's y axis.
        self.near(browser, "x", -10, 0.1)
        browser.run("document.getElementById('console').open = false; document.querySelector('main').scrollTo(0, 0)")
        self.aim(browser, 20, 40, "mm: reachable")
        browser.point("#scene", *self.pixel(browser, 20, 40), click=True)
        # 30 mm along the frame's x axis.
        self.near(browser, "x", 30, 1)
        self.near(browser, "y", 0, 1, "target")
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
        self.enter(browser, x="20")
        browser.wait_text("#recorder .said", "fetched")
        # What would be saved.
        browser.run("""
            window.saved = null;
            const make = URL.createObjectURL;
            URL.createObjectURL = (blob) => { blob.text().then((text) => { window.saved = text; }); return make.call(URL, blob); }""")
        browser.run("document.querySelector('#recorder').scrollIntoView()")
        self.picture(browser, "recorder")
        drawn = "return document.querySelector('#recorder canvas').toDataURL()"
        whole = browser.run(drawn)
        browser.run("document.querySelector('#recorder canvas').focus()")
        browser.press("+")
        browser.wait(lambda: browser.run(drawn) != whole, "the zoom")
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
        browser = self.ready()
        browser.run("document.getElementById('statistics').open = true")
        browser.wait_text("#statistics-body", "late ticks")
        # What a drive is found to be takes fast motion both ways.
        for w in (720, 0, 90):
            self.enter(browser, w=str(w))
            self.arrive(browser, w=w)
        browser.wait_text("#statistics-body", "pivot 3: motor constant over its parameter")
        # The machine is a fifth off what its controller knows.
        browser.wait_text("#statistics-body", "0.800; 0.00 A; 0.0")
        browser.run("document.getElementById('statistics').scrollIntoView()")
        self.picture(browser, "statistics")
        self.assertEqual(browser.errors(), [])

    def test_stop_is_never_out_of_sight_and_nothing_is_wider_than_the_window(self):
        for size in SIZES:
            for dark in (False, True):
                browser = self.ready(size, dark=dark, touch=size == "phone")
                browser.run("for (const d of document.querySelectorAll('details')) d.open = true")
                for place in ("0", "1e6"):
                    browser.run(f"document.querySelector('main').scrollTo(0, {place})")
                    top = browser.run("""
                        const box = document.getElementById('stop').getBoundingClientRect();
                        const at = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
                        return at && at.closest('#stop') ? box.width * box.height : 0""")
                    self.assertGreater(top, 4000, (size, place))
                # It covers nothing: what is scrolled ends where it begins, and the window itself does not scroll.
                apart = browser.run("""
                    const [a, b] = ['#stop', 'main'].map((s) => document.querySelector(s).getBoundingClientRect());
                    const high = document.documentElement.scrollHeight - innerHeight;
                    return high <= 0 && (a.bottom <= b.top || a.top >= b.bottom)""")
                self.assertTrue(apart, size)
                wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
                self.assertEqual(wide, 0, size)
                browser.close()

    def test_numbers_do_not_jump_about(self):
        browser = self.ready()
        widths = "return ['x', 'y', 'w'].map((n) => document.getElementById(n + '-measured').getBoundingClientRect().x)"
        before = browser.run(widths)
        self.enter(browser, w="-1234")
        browser.wait(lambda: self.shown(browser, "w") < -100, "three digits")
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
                browser.run("document.getElementById('console').open = false; document.querySelector('main').scrollTo(0, 0)")
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
        browser.run("document.getElementById('console').open = false; document.querySelector('main').scrollTo(0, 0)")
        self.aim(browser, 5, 64, "mm: reachable")
        self.picture(browser, "live-view")

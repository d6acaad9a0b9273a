"""What the page has besides driving: orientation by hand, places, macros, parameters, faults, help; what it keeps, and how quiet it is."""

import time

from page import SOFT_SERVO, OnServed
from webdriver import ENTER, RIGHT

OPEN = "document.getElementById(arguments[0]).open = true"


class Panels(OnServed):
    """Panel by panel."""

    def shows(self, browser, panel):
        browser.run(OPEN, panel)
        browser.run("document.getElementById(arguments[0]).scrollIntoView()", panel)

    def press(self, browser, panel, text):
        """The button of a panel with this text."""
        def there():
            return browser.run("""
                const button = [...document.querySelectorAll(arguments[0] + ' button')].find((b) => b.textContent === arguments[1] && !b.disabled);
                button?.click();
                return !!button""", f"#{panel}", text)
        browser.wait(there, f"the button “{text}”")

    def test_theta_by_dragging_its_handle(self):
        browser = self.ready()
        browser.run("document.querySelector('main').scrollTo(0, 0)")
        # From the right to the top, a quarter of a turn, about the middle of the drawing.
        far = browser.run("""
            const c = document.getElementById('scene');
            return Math.min(c.clientWidth, c.clientHeight) / (2 * 100 * 1.72) * 140""")
        browser.point("#dial", 0, 0, drag_to=(-far, -far))
        self.near(browser, "w", 90, 1, "target")
        self.near(browser, "x", 0, 0.1, "target")
        self.light(browser, "settled")
        # The handle is where the platform is; a stop in the middle of a drag lets it be.
        angle = "return Number(document.getElementById('dial').getAttribute('aria-valuenow'))"
        browser.wait(lambda: abs(browser.run(angle) - 90) < 1, "the handle at the top")

    def test_theta_by_keys(self):
        browser = self.ready()
        browser.run("document.getElementById('dial').focus()")
        for _ in range(3):
            browser.press(RIGHT)
        browser.wait_text("#aim", "θ −3.0°: Enter turns")
        self.picture(browser, "dial")
        self.assertAlmostEqual(self.shown(browser, "w", "target"), 0, delta=0.1)
        browser.press(ENTER)
        self.arrive(browser, w=-3)

    def test_places_are_kept_and_gone_to(self):
        browser = self.ready()
        self.enter(browser, x="12", y="-7", w="30")
        self.arrive(browser, x=12, y=-7, w=30)
        browser.type("#place-name", "gate\n")
        browser.wait_text("#places-list", "gate")
        browser.click("#home")
        self.arrive(browser, x=0, y=0, w=0)
        browser.open(self.url)
        browser.wait_text("#places-list", "12.00, −7.00 mm, 30.00°")
        browser.click("#places-list button")
        self.arrive(browser, x=12, y=-7, w=30)
        browser.click("#places-list button[aria-label='Forget gate']")
        self.assertEqual(browser.text("#places-list"), "")

    def test_macros_are_kept_run_and_deleted(self):
        browser = self.ready()
        self.shows(browser, "macros")
        browser.wait_text("#macros-list", "has no macro yet")
        browser.type("#macro-name", "1st")
        browser.type("#macro-text", "MOV X 5")
        browser.click("#macro-save")
        browser.wait_text("#macro-said", "a name begins with a letter")
        browser.type("#macro-name", "there")
        browser.type("#macro-text", "MOV X 5\nWAC ONT? X = 1\nMOV Y 5")
        browser.click("#macro-save")
        browser.wait_text("#macro-said", "there is kept")
        browser.wait_text("#macros-list", "thereRun")
        self.press(browser, "macros", "Run")
        self.arrive(browser, x=5, y=5)
        browser.type("#macro-text", "")
        self.press(browser, "macros", "Edit")
        browser.wait(lambda: "WAC ONT? X = 1" in browser.run("return document.getElementById('macro-text').value"), "its lines")
        self.picture(browser, "macros")
        browser.type("#macro-text", "MOV X 1o")
        browser.click("#macro-save")
        browser.wait_text("#macro-said", "expected")
        self.press(browser, "macros", "Delete")
        browser.wait_text("#macros-list", "has no macro yet")

    def test_parameters_are_searched_compared_undone_and_kept(self):
        browser = self.ready()
        self.shows(browser, "parameters")
        field = "#parameters input[aria-label='speed of rotation']"
        browser.wait(lambda: browser.run("return !!document.querySelector(arguments[0])", field), "the parameters")
        groups = browser.run("return [...document.querySelectorAll('#parameters h3')].map((h) => h.textContent)")
        self.assertIn("limit", groups)
        self.assertIn("supervision", groups)
        browser.wait_text("#parameters-body", "0 differ from the reference")
        browser.type("#parameters input[type=search]", "rotation")
        rows = "return [...document.querySelectorAll('#parameters tbody tr')].filter((r) => r.checkVisibility()).length"
        self.assertEqual(browser.run(rows), 3)
        browser.type(field, "100\t")
        browser.wait_text("#parameters-body", "1 differs from the reference; 1 changed here and not kept")
        row = "return document.querySelector(arguments[0]).closest('tr').className + document.querySelector(arguments[0]).closest('tr').textContent"
        self.assertIn("differs", browser.run(row, field))
        self.assertIn("360", browser.run(row, field))
        self.picture(browser, "parameters")
        self.press(browser, "parameters", "Undo: speed of rotation back to 360")
        browser.wait_text("#parameters .said", "360 again")
        browser.wait_text("#parameters-body", "0 differ from the reference")
        browser.type(field, "100\t")
        browser.wait_text("#parameters .said", "set")
        self.press(browser, "parameters", "Keep over a restart")
        browser.wait_text("#parameters .said", "kept")
        browser.type(field, "200\t")
        browser.wait_text("#parameters .said", "set")
        self.press(browser, "parameters", "Back to what is kept")
        browser.wait(lambda: browser.run("return document.querySelector(arguments[0]).value", field) == "100", "what is kept")
        self.assertEqual(browser.errors(), [])

    def test_faults_are_remembered(self):
        browser = self.ready()
        self.shows(browser, "events")
        browser.wait_text("#events-count", "no fault")
        browser.click("#events-record")
        browser.wait_text("#events-said", "there is no fault record")
        for line in (*SOFT_SERVO, "MOV X 60 Y 0 W 180"):
            self.say(browser, line)
        browser.wait_text("#mode", "fault")
        browser.wait_text("#events-list", "following error too large")
        browser.wait_text("#events-count", "1 fault among")
        browser.click("#acknowledge")
        browser.wait_text("#mode", "servo off")
        browser.wait_text("#events-list", "s ago")
        browser.click("#events-all")
        browser.wait_text("#events-list", "fault acknowledged")
        self.picture(browser, "events")

    def test_commands_are_explained(self):
        browser = self.page()
        self.shows(browser, "console")
        browser.run(OPEN, "commands")
        browser.wait_text("#commands-list", "FRF")
        browser.type("#commands-search", "halt")
        browser.wait(lambda: browser.run("return document.querySelectorAll('#commands-list li').length") == 1, "one command")
        browser.click("#commands-list button")
        self.assertEqual(browser.run("return document.getElementById('console-line').value"), "HLT ")

    def test_soft_limits_and_the_tool_point_are_drawn(self):
        browser = self.ready()
        picture = "return document.getElementById('scene').toDataURL()"
        self.light(browser, "settled")
        # The way it came fades, and the last of it is drawn after it has settled: a picture that stays, first.
        browser.wait(lambda: browser.run(picture) == browser.run(picture), "a picture that stays")
        before = browser.run(picture)
        self.assertEqual(browser.run(picture), before)
        for line in ("NLM X -20", "PLM X 35", "KST TIP X 20 Y 10", "KEN TIP"):
            self.say(browser, line)
        browser.run("document.getElementById('console').open = false; document.querySelector('main').scrollTo(0, 0)")
        browser.wait(lambda: browser.run(picture) != before, "the soft limits")
        # They are asked for now and then.
        time.sleep(4)
        self.picture(browser, "soft-limits")
        self.aim(browser, 60, 0, "beyond the soft limits of x")

    def test_a_geometry_that_was_changed_is_drawn(self):
        browser = self.page()
        for line in ("CCL 1 ADVANCED", "SPA 1 0x54500202 1.5"):
            self.say(browser, line)
        browser.run("document.getElementById('console').open = false")
        # Guides that end 170 mm out leave a disk of 70 mm. The page asks for that every few seconds.
        def told():
            for y in (-55, -60):
                browser.point("#scene", *self.pixel(browser, 50, y))
            time.sleep(0.3)
            return "70.0 mm is the limit" in browser.text("#aim")
        browser.wait(told, lambda: f"the smaller disk; the page says {browser.text('#aim')}")

    def test_looser_supervision_is_shown_as_long_as_it_lasts(self):
        browser = self.page()
        hidden = "return document.getElementById('notices').hidden"
        self.assertTrue(browser.run(hidden))
        for line in ("CCL 1 ADVANCED", "SPA 1 0x54500500 0.004"):
            self.say(browser, line)
        browser.wait_text("#notices", "looser than the reference: 0x54500500")
        self.picture(browser, "looser")
        self.say(browser, "RPA 1 0x54500500")
        browser.wait(lambda: browser.run(hidden), "supervision as before")

    def test_what_was_chosen_survives_a_reload(self):
        browser = self.ready()
        browser.type("#step-mm", "2.5\t")
        browser.click("#theme")
        theme = "return document.documentElement.dataset.theme"
        self.assertEqual(browser.run(theme), "dark")
        self.enter(browser, x="40", y="30")
        self.arrive(browser, x=40, y=30)
        browser.open(self.url)
        browser.wait_text("#place", "XYT-1")
        self.assertEqual(browser.run(theme), "dark")
        self.assertEqual(browser.run("return document.getElementById('step-mm').value"), "2.5")
        self.near(browser, "x", 40, 0.1)
        # What is kept now was kept by the second page.
        browser.open(self.url)
        browser.wait_text("#place", "XYT-1")
        self.assertGreater(len(browser.run("return JSON.parse(localStorage.getItem('tripivot.trail'))")), 5)
        browser.click("#clear-trail")
        browser.open(self.url)
        browser.wait_text("#place", "XYT-1")
        browser.open(self.url)
        self.assertLess(len(browser.run("return JSON.parse(localStorage.getItem('tripivot.trail'))")), 3)

    def test_nothing_is_drawn_while_nothing_changes(self):
        browser = self.ready()
        browser.run("""
            document.getElementById('lesson').open = false;
            window.drawn = {};
            const clear = CanvasRenderingContext2D.prototype.clearRect;
            CanvasRenderingContext2D.prototype.clearRect = function (...box) {
              window.drawn[this.canvas.id] = (window.drawn[this.canvas.id] ?? 0) + 1;
              return clear.apply(this, box);
            };""")
        self.light(browser, "settled")
        time.sleep(4)
        browser.run("window.drawn = {}")
        time.sleep(2)
        drawn = browser.run("return window.drawn")
        self.assertLessEqual(sum(drawn.values()), 4, drawn)
        self.enter(browser, x="50")
        self.arrive(browser, x=50)
        self.assertGreater(browser.run("return window.drawn.scene"), 5)

    def test_a_screen_reader_is_told_what_lasts(self):
        browser = self.ready()
        browser.wait_text("#announcement", "on target")
        browser.run("""
            window.told = [];
            for (const live of document.querySelectorAll('[role=status], [role=alert], [aria-live]')) {
              if (live.getAttribute('aria-live') === 'off') continue;
              new MutationObserver(() => window.told.push(live.id + ': ' + live.textContent))
                .observe(live, { childList: true, characterData: true, subtree: true });
            }""")
        # A step every half a second, each of which comes to rest: none of these states lasts.
        browser.run("""
            return new Promise((done) => {
              let left = 6;
              const step = () => {
                document.querySelector("[data-step='X+']").click();
                left -= 1;
                if (left) setTimeout(step, 500); else done();
              };
              step();
            })""")
        self.near(browser, "x", 30, 0.1)
        browser.wait_text("#announcement", "on target: x 30.00")
        for x in range(-40, 41, 4):
            browser.point("#scene", x, 10)
        told = browser.run("return window.told")
        self.assertLessEqual(len(told), 3, told)
        # By key, each place is told.
        browser.run("document.getElementById('scene').focus()")
        browser.press(RIGHT)
        self.assertEqual(browser.run("return document.getElementById('aim').getAttribute('aria-live')"), "polite")

    def test_axe_finds_nothing_serious(self):
        """With everything open, in light and dark, on a desk and a phone."""
        for size in ("desk", "phone"):
            for dark in (False, True):
                browser = self.ready(size, dark=dark, touch=size == "phone")
                browser.run("for (const d of document.querySelectorAll('details')) d.open = true")
                browser.wait(lambda: browser.run("return document.querySelectorAll('#parameters tr').length > 20"), "the parameters")
                # The panels fill themselves.
                time.sleep(1)
                self.assert_accessible(browser, f"{size}, {'dark' if dark else 'light'}")
                browser.close()

    def test_stop_covers_no_control(self):
        """Wherever the page is scrolled to, no control lies under what always stays."""
        browser = self.ready("phone", touch=True)
        browser.run("for (const d of document.querySelectorAll('details')) d.open = true")
        covered = browser.run("""
            const found = [];
            for (const control of document.querySelectorAll('main button, main input, main select, main textarea, main summary')) {
              if (!control.checkVisibility()) continue;
              for (const block of ['start', 'end', 'center']) {
                control.scrollIntoView({ block });
                const box = control.getBoundingClientRect();
                const at = document.elementFromPoint(box.x + box.width / 2, Math.min(box.bottom - 2, innerHeight - 1));
                const stop = document.getElementById('stop').getBoundingClientRect();
                if (stop.top < 0 || stop.bottom > innerHeight || at?.closest('.stopping, .bar')) found.push(control.id || control.textContent);
              }
            }
            return found""")
        self.assertEqual(covered, [])

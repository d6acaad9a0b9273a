"""A browser, driven over the WebDriver protocol: the little of it that the tests need, with nothing but Python's own library."""

import base64
import json
import os
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ESCAPE, ENTER, UP, RIGHT = "\ue00c", "\ue007", "\ue013", "\ue014"
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
PATIENCE_S = 180
"""Far longer than anything here takes, on a busy machine too."""
FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--force-color-profile=srgb",
    "--disable-dev-shm-usage",
]


class Driver:
    """A chromedriver process."""

    def __init__(self):
        self.process = subprocess.Popen(
            ["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for line in self.process.stdout:
            if "started successfully on port" in line:
                self.url = f"http://127.0.0.1:{line.rstrip().rstrip('.').split()[-1]}"
                return
        raise RuntimeError("chromedriver does not start")

    def close(self):
        self.process.terminate()
        self.process.wait()


class Browser:
    """A browser window of its own, with a profile of its own."""

    def __init__(self, driver, width=1280, height=900, dark=False, touch=False, flags=()):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        arguments = [*FLAGS, *flags, f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"]
        options = {"args": arguments, "prefs": {"download.prompt_for_download": False}}
        if touch:
            metrics = {"width": width, "height": height, "pixelRatio": 2, "touch": True}
            options["mobileEmulation"] = {"deviceMetrics": metrics}
        capabilities = {"alwaysMatch": {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}
        self.base = driver.url
        self.session = self.start(capabilities)
        self.base = f"{driver.url}/session/{self.session}"
        if not touch:
            self.devtools("Emulation.setDeviceMetricsOverride",
                          width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.devtools("Emulation.setEmulatedMedia",
                      features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def start(self, capabilities):
        """A new window's name. A browser that does not come up on a busy machine gets a second chance."""
        for _ in range(2):
            try:
                return self.call("POST", "/session", {"capabilities": capabilities})["sessionId"]
            except (RuntimeError, TimeoutError) as error:
                reason = error
        raise RuntimeError(f"no browser: {reason}")

    def call(self, method, path, body=None):
        data = None if method in ("GET", "DELETE") else json.dumps(body or {}).encode()
        request = urllib.request.Request(
            self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def devtools(self, command, **parameters):
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, url):
        self.call("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """What a script in the page returns."""
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def find(self, selector):
        return self.call("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        """Clicks an element, which is scrolled to if it has to be, as a person would."""
        self.run("document.querySelector(arguments[0]).scrollIntoView({ block: 'center' })", selector)
        self.call("POST", f"/element/{self.find(selector)}/click")

    def type(self, selector, text, clear=True):
        element = self.find(selector)
        if clear:
            self.call("POST", f"/element/{element}/clear")
        self.call("POST", f"/element/{element}/value", {"text": text})

    def text(self, selector):
        return self.run("return document.querySelector(arguments[0]).textContent", selector)

    def press(self, key):
        """A key, wherever the focus is."""
        actions = [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def point(self, selector, x, y, click=False, drag_to=None, touch=False):
        """Moves the pointer to so many pixels from the middle of an element; clicks there, or drags from there."""
        origin = {ELEMENT: self.find(selector)}
        move = {"type": "pointerMove", "origin": origin, "duration": 20}
        actions = [{**move, "x": int(x), "y": int(y)}]
        if click or drag_to:
            actions.append({"type": "pointerDown", "button": 0})
            if drag_to:
                actions += [{**move, "x": int(drag_to[0]), "y": int(drag_to[1]), "duration": 100}]
            actions.append({"type": "pointerUp", "button": 0})
        self.pointer(*actions, kind="touch" if touch else "mouse")

    def hold(self, selector):
        """Presses the pointer on an element, and keeps it pressed."""
        origin = {ELEMENT: self.find(selector)}
        self.pointer({"type": "pointerMove", "origin": origin, "x": 0, "y": 0}, {"type": "pointerDown", "button": 0})

    def release(self):
        self.pointer({"type": "pointerUp", "button": 0})

    def pointer(self, *actions, kind="mouse"):
        pointer = {"type": "pointer", "id": kind, "parameters": {"pointerType": kind}, "actions": list(actions)}
        self.call("POST", "/actions", {"actions": [pointer]})

    def wait(self, condition, what):
        """Until `condition()` holds; its value. `what` is waited for: in words, or a function that has them when it is too late."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"waited in vain for {what() if callable(what) else what}")

    def wait_text(self, selector, part):
        self.wait(lambda: part in self.text(selector), lambda: f"“{part}” in {selector}, which says “{self.text(selector)}”")

    def errors(self):
        """What the page's scripts have complained about."""
        return [entry["message"] for entry in self.call("POST", "/se/log", {"type": "browser"}) if entry["level"] == "SEVERE"]

    def picture(self, path, whole=False):
        """A screenshot: the window, or the whole page."""
        heights = "document.body.style.height = arguments[0]; document.querySelector('main').style.overflow = arguments[1]"
        if whole:
            self.run(heights, "auto", "visible")
        shot = self.devtools("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        if whole:
            self.run(heights, "", "")
        with open(path, "wb") as file:
            file.write(base64.b64decode(shot["data"]))

    def processes(self):
        """All that belong to it."""
        found = []
        for name in os.listdir("/proc"):
            if not name.isdigit():
                continue
            try:
                with open(f"/proc/{name}/cmdline", "rb") as file:
                    if self.profile.name.encode() in file.read():
                        found.append(int(name))
            except OSError:
                pass
        return found

    def close(self):
        """Closes the window; once more does nothing."""
        if self.session is None:
            return
        self.session = None
        try:
            self.call("DELETE", "")
        finally:
            self.profile.cleanup()

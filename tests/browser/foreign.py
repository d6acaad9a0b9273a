"""A page of somebody else's, in the same browser as the operator's: nothing that it sends to the GCS port is carried out."""

import http.server
import socket
import threading

from page import WithDriver
from served import Served
from settings import ARGUMENTS

LINES = "\\nFRF X\\nVLS 7\\nDEL 300\\nMOV X 30 Y 10 W 90\\n"

PAGE = """<!doctype html><title>elsewhere</title>
<form id="form" method="post" enctype="text/plain" action="http://GCS/"><input name="a" value="b"></form>
<script>
const lines = "LINES";
document.querySelector("input").name = lines;
async function attack() {
  const tries = [];
  for (const method of ["POST", "GET", "HEAD"]) {
    const body = method === "POST" ? lines : undefined;
    tries.push(fetch("http://GCS/" + (body ? "" : encodeURI(lines)), { method, body, mode: "no-cors" }).catch(() => null));
  }
  const image = new Image();
  image.src = "http://GCS/" + encodeURI(lines);
  try { new WebSocket("ws://GCS/"); } catch {}
  await Promise.race([Promise.all(tries), new Promise((done) => setTimeout(done, 3000))]);
}
attack().then(() => { document.title = "done"; });
</script>"""


class Elsewhere(http.server.BaseHTTPRequestHandler):
    """Serves one page, whatever is asked for."""

    page = ""

    def do_GET(self):
        body = self.page.encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        """Says nothing."""


class Foreign(WithDriver):
    """In front of a simulated stage that serves GCS."""

    def setUp(self):
        self.served = Served(ARGUMENTS.program)
        self.addCleanup(self.served.close)
        Elsewhere.page = PAGE.replace("GCS", self.served.gcs).replace("LINES", LINES)
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Elsewhere)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)

    def ask(self, line):
        """The answer to a line of an honest client."""
        host, port = self.served.gcs.rsplit(":", 1)
        with socket.create_connection((host, int(port)), timeout=10) as client:
            client.sendall(line.encode() + b"\n")
            return client.makefile(encoding="ascii").readline().strip()

    def test_neither_scripts_nor_forms_of_another_origin_reach_the_stage(self):
        browser = self.window()
        browser.open(f"http://127.0.0.1:{self.server.server_port}/")
        browser.wait(lambda: browser.run("return document.title") == "done", "the page's tries")
        # They have reached the port, which has closed without a word.
        empty = [error for error in browser.errors() if "ERR_EMPTY_RESPONSE" in error]
        self.assertGreaterEqual(len(empty), 3, empty)
        browser.run("document.getElementById('form').submit()")
        browser.wait(lambda: browser.run("return document.body.textContent.includes('ERR_EMPTY_RESPONSE')"), "the form's try")
        self.assertEqual(self.ask("VLS?"), "200")
        self.assertEqual(self.ask("FRF? X"), "X=0")
        self.assertEqual(self.ask("MOV? X"), "X=0")

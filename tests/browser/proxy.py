"""A proxy with TLS in front of the page, as nginx or caddy stand there; its certificate is one of its own."""

import select
import socket
import ssl
import subprocess
import tempfile
import threading

NAME = "stage.test"


class TlsProxy:
    """Takes TLS away and passes the rest on: with the host that the browser asked for, or with the page's own."""

    def __init__(self, keeps_host):
        self.keeps_host = keeps_host
        self.folder = tempfile.TemporaryDirectory()
        key, certificate = f"{self.folder.name}/key.pem", f"{self.folder.name}/certificate.pem"
        subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", f"/CN={NAME}", "-keyout", key, "-out", certificate],
            check=True, capture_output=True)
        self.tls = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
        self.tls.load_cert_chain(certificate, key)
        self.listener = socket.create_server(("127.0.0.1", 0))
        port = self.listener.getsockname()[1]
        self.host = f"{NAME}:{port}"
        self.url = f"https://{self.host}/"
        # For a browser that is to find it, and to take its certificate.
        self.flags = (f"--host-resolver-rules=MAP {NAME} 127.0.0.1", "--ignore-certificate-errors")
        self.page = None
        self.ended = threading.Event()

    def start(self, page):
        """In front of the page at this address."""
        self.page = page
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while not self.ended.is_set():
            try:
                if select.select([self.listener], [], [], 0.1)[0]:
                    threading.Thread(target=self.carry, args=(self.listener.accept()[0],), daemon=True).start()
            except (OSError, ValueError):
                return

    def carry(self, plain):
        host, port = self.page.rsplit(":", 1)
        try:
            with self.tls.wrap_socket(plain, server_side=True) as browser, socket.create_connection((host, int(port))) as page:
                while not self.ended.is_set():
                    # What TLS has taken in already does not show at the socket.
                    ready = [browser] if browser.pending() else select.select([browser, page], [], [], 0.1)[0]
                    for end in ready:
                        data = end.recv(1 << 16)
                        if not data:
                            return
                        if end is page:
                            browser.sendall(data)
                        else:
                            page.sendall(data if self.keeps_host else data.replace(self.host.encode(), self.page.encode(), 1))
        except (OSError, ValueError):
            plain.close()

    def close(self):
        self.ended.set()
        self.listener.close()
        self.folder.cleanup()

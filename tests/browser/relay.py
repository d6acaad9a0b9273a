"""A line between page and controller that the tests can cut, silence, and let tell that the stage is no simulated one."""

import select
import socket
import threading


class Relay:
    """Passes bytes between whoever connects and a controller."""

    def __init__(self, controller, serial=None):
        host, port = controller.rsplit(":", 1)
        self.controller = (host, int(port))
        self.serial = serial
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.place = f"127.0.0.1:{self.listener.getsockname()[1]}"
        self.silent = threading.Event()
        self.swallowed = b""
        self.ended = threading.Event()
        self.lines = []
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while not self.ended.is_set():
            try:
                if not select.select([self.listener], [], [], 0.1)[0]:
                    continue
                one = self.listener.accept()[0]
            except (OSError, ValueError):
                return
            try:
                other = socket.create_connection(self.controller)
            except OSError:
                one.close()
                continue
            self.lines += [one, other]
            threading.Thread(target=self.carry, args=(one, other), daemon=True).start()

    def carry(self, page, controller):
        while not self.ended.is_set():
            try:
                for end in select.select([page, controller], [], [], 0.1)[0]:
                    data = end.recv(1 << 16)
                    if not data:
                        raise OSError("closed")
                    if self.silent.is_set():
                        continue
                    if end is controller:
                        page.sendall(self.told(data))
                    else:
                        controller.sendall(data.translate(None, self.swallowed))
            except (OSError, ValueError):
                page.close()
                controller.close()
                return

    def told(self, data):
        if self.serial is None:
            return data
        return data.replace(b", SIM,", b", %s," % self.serial.encode())

    def silence(self):
        """Bytes go in at both ends, and none come out: a plug has been pulled."""
        self.silent.set()

    def swallow(self, lost):
        """These bytes get lost on their way to the controller."""
        self.swallowed = lost

    def cut(self):
        """Closes what is open; who connects again gets through."""
        for line in self.lines:
            try:
                line.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
        self.lines = []

    def close(self):
        self.ended.set()
        self.cut()
        self.listener.close()

"""The page behind a proxy with TLS: its password, and its connection over `wss`."""

from page import OnPage
from proxy import TlsProxy
from served import Process
from settings import ARGUMENTS


class Published(Process):
    """A simulated stage whose page browsers know by another address."""

    def __init__(self, program, url):
        super().__init__(program, "serve", "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0", "--public-url", url)
        self.password = self.said(r"password of the page: (\S+)")
        self.said(r"listening at (\S+)")
        self.page = self.said(r"page at http://(\S+)/")


class Remote(OnPage):
    """Each proxy has a stage of its own."""

    def behind(self, keeps_host):
        proxy = TlsProxy(keeps_host)
        self.addCleanup(proxy.close)
        published = Published(ARGUMENTS.program, proxy.url)
        self.addCleanup(published.close)
        proxy.start(published.page)
        return proxy, published.password

    def test_a_stage_is_driven_through_it_once_the_password_is_given(self):
        for keeps_host in (True, False):
            proxy, password = self.behind(keeps_host)
            browser = self.window(flags=proxy.flags)
            browser.open(proxy.url)
            self.assertEqual(browser.run("return location.href"), proxy.url + "login")
            self.assert_accessible(browser, "the password")
            browser.type("[name=password]", "wrong")
            browser.click("button")
            browser.wait_text("[role=status]", "not the password")
            browser.wait(lambda: self.enters(browser, proxy.url, password), "the page")
            browser.wait_text("#place", "XYT-1")
            self.reference(browser)
            self.enter(browser, x="5")
            self.arrive(browser, x=5)
            # Nothing but the wrong tries.
            self.assertEqual([error for error in browser.errors() if "/login - Failed to load resource: the server responded with a status of 403" not in error], [])

    def enters(self, browser, url, password):
        """Tries, which after a wrong try has to wait."""
        # The page may have come since the try before.
        if browser.run("return location.href") != url:
            browser.type("[name=password]", password)
            browser.click("button")
        return browser.run("return location.href") == url

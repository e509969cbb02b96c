"""Headless Chromium by chromedriver, with the standard library alone."""
import base64
import json
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request

DRIVER, CHROMIUM = shutil.which("chromedriver"), shutil.which("chromium")


def needs_browser(case):
    """Skips tests of pages where there is no browser, and says so."""
    if DRIVER and CHROMIUM:
        return case
    sys.stderr.write("\nPAGES ARE NOT TRIED: there is no chromium and chromedriver; apt-get install chromium chromium-driver\n\n")
    return unittest.skip("no chromium")(case)


class Browser:
    """A window of 1280 x 1000, with a folder of its own."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen([DRIVER, "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        port = next(found[1] for line in self.process.stdout if (found := re.search(r"successfully on port (\d+)", line)))
        self.reader = threading.Thread(target=self.process.stdout.read, daemon=True)
        self.reader.start()
        self.base = "http://127.0.0.1:" + port
        self.opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1280,1000", "--no-first-run", "--user-data-dir=" + self.folder.name]
        capabilities = {"browserName": "chrome", "goog:chromeOptions": {"args": options}, "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        session = self.ask("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
        self.base += "/session/" + session["sessionId"]

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, method=method, data=data, headers={"Content-Type": "application/json"})
        try:
            with self.opener.open(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(json.load(error)["value"]["message"]) from None

    def close(self):
        self.ask("DELETE", "")
        self.process.terminate()
        self.process.wait()
        self.reader.join()
        self.process.stdout.close()
        self.folder.cleanup()

    def script(self, text, *arguments):
        return self.ask("POST", "/execute/sync", {"script": text, "args": arguments})

    def command(self, name, **parameters):
        """Of the DevTools protocol."""
        return self.ask("POST", "/goog/cdp/execute", {"cmd": name, "params": parameters})

    def screenshot(self, left, top, width, height):
        """PNG of a part of the page, which begins at its upper left."""
        clip = {"x": left, "y": top, "width": width, "height": height, "scale": 1}
        return base64.b64decode(self.command("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"])

    def log(self, kind):
        return self.ask("POST", "/se/log", {"type": kind})

    def open(self, file):
        """Waits until the page is ready."""
        self.log("performance")
        self.ask("POST", "/url", {"url": "file://" + file})
        until = time.time() + 30
        while not self.script("return document.body && document.body.dataset.ready === '1'"):
            if time.time() > until:
                raise AssertionError("the page is not ready: %s" % self.log("browser"))
            time.sleep(0.05)

    def requests(self):
        messages = (json.loads(entry["message"])["message"] for entry in self.log("performance"))
        return [message["params"]["request"]["url"] for message in messages if message["method"] == "Network.requestWillBeSent"]

    def key(self, value, *, shift=False):
        hold = [{"type": "keyDown", "value": "\ue008"}] if shift else []
        drop = [{"type": "keyUp", "value": "\ue008"}] if shift else []
        press = [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}]
        self.ask("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": hold + press + drop}]})

    def drag(self, element, start, end):
        """From one point to another, both in parts of an element's width and height."""
        box = self.script("const b = document.querySelector(arguments[0]).getBoundingClientRect(); return [b.x, b.y, b.width, b.height]", element)
        places = [[round(box[i] + part[i] * box[2 + i]) for i in (0, 1)] for part in (start, end)]
        move = [{"type": "pointerMove", "duration": 50, "x": x, "y": y} for x, y in places]
        actions = [move[0], {"type": "pointerDown", "button": 0}, move[1], {"type": "pointerUp", "button": 0}]
        self.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]})

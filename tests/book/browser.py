"""A browser that is turned by hand: real events of a mouse, a keyboard and a finger.

Chromium is driven by its DevTools protocol over two pipes: a message is a line of JSON that ends in
a zero byte. Such events go the way of a reader's own, through the browser's hit test, focus and
gestures; events that a script makes do not.
"""

import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

SECONDS = 180  # for any answer: axe reads the page of the packages, on a busy machine

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
    # no page needs a network
    "--host-resolver-rules=MAP * ~NOTFOUND",
)

DESKTOP = {"width": 1280, "height": 800, "deviceScaleFactor": 1, "mobile": False}
PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}

KEYS = {"Tab": 9, "Enter": 13, "End": 35, "Home": 36}
"""Keys without a letter, with the codes that Chromium knows them by."""
SHIFT = 8

FAULT = {"warning", "error", "assert"}
"""Kinds of messages of the console that are faults; the theme also says how it begins."""


class Browser:
    """Chromium with pages that are opened beside each other."""

    def __enter__(self):
        chromium = shutil.which("chromium")
        if chromium is None:
            raise FileNotFoundError(
                "chromium is not installed: apt-get install chromium"
            )
        self.home = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.sending = os.pipe()
        self.receiving, from_browser = os.pipe()
        # Chromium reads the protocol from 3 and writes it to 4.
        plumbing = f'exec "$@" 3<&{to_browser} 4>&{from_browser}'
        flags = [*FLAGS, f"--user-data-dir={self.home.name}"]
        self.process = subprocess.Popen(
            ["bash", "-c", plumbing, "bash", chromium, *flags, "about:blank"],
            pass_fds=(to_browser, from_browser),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self.rest = b""
        self.count = 0
        self.pages = {}
        return self

    def __exit__(self, *error):
        self.process.terminate()
        self.process.wait(SECONDS)
        os.close(self.sending)
        os.close(self.receiving)
        self.home.cleanup()

    def call(self, method, session=None, **parameters):
        """Send a command and return its result; what else the browser says is noted on the way."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.sending, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + SECONDS
        while (answer := self._receive(end)).get("id") != self.count:
            page = self.pages.get(answer.get("sessionId"))
            if page:
                page.notice(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def _receive(self, end):
        while b"\0" not in self.rest:
            ready, _, _ = select.select(
                [self.receiving], [], [], end - time.monotonic()
            )
            if not ready:
                raise TimeoutError(f"Chromium did not answer in {SECONDS} s")
            self.rest += os.read(self.receiving, 1 << 20)
        message, _, self.rest = self.rest.partition(b"\0")
        return json.loads(message)

    def open(self, file, screen=DESKTOP, script=""):
        """A page of a file, on a desktop or a phone, that begins to load after a script."""
        target = self.call("Target.createTarget", url="about:blank", newWindow=True)[
            "targetId"
        ]
        found = self.call("Target.attachToTarget", targetId=target, flatten=True)
        page = Page(self, found["sessionId"], target)
        self.pages[page.session] = page
        for domain in ("Page", "Runtime", "Log"):
            page.call(f"{domain}.enable")
        page.call("Page.addScriptToEvaluateOnNewDocument", source=script)
        page.call("Emulation.setDeviceMetricsOverride", **screen)
        page.call("Emulation.setTouchEmulationEnabled", enabled=screen["mobile"])
        page.call("Emulation.setFocusEmulationEnabled", enabled=True)
        page.call("Page.navigate", url=Path(file).as_uri())
        return page


class Page:
    """A page, with what its console said."""

    def __init__(self, browser, session, target):
        self.browser = browser
        self.session = session
        self.target = target
        self.faults = []

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def close(self):
        self.browser.call("Target.closeTarget", targetId=self.target)

    def notice(self, event):
        """Keep a warning or an error of the console, of the browser, of a script."""
        told = event["params"]
        if event["method"] == "Runtime.consoleAPICalled" and told["type"] in FAULT:
            self.faults.append([part.get("value") for part in told["args"]])
        elif event["method"] == "Log.entryAdded" and told["entry"]["level"] in FAULT:
            entry = told["entry"]
            self.faults.append(f"{entry['text']}: {entry.get('url')}")
        elif event["method"] == "Runtime.exceptionThrown":
            self.faults.append(told["exceptionDetails"]["exception"]["description"])

    def loaded(self):
        """Wait for the page, its pictures and its mathematics."""
        there = "document.readyState === 'complete' && location.protocol !== 'about:'"
        end = time.monotonic() + SECONDS
        while not self.evaluate(there):
            if time.monotonic() > end:
                raise TimeoutError(f"a page is not there after {SECONDS} s")
            time.sleep(0.05)
        self.evaluate("window.MathJax?.startup?.promise.then(() => 0)")

    def evaluate(self, expression):
        """The value of an expression of JavaScript, after its promise."""
        found = self.call(
            "Runtime.evaluate",
            expression=expression,
            returnByValue=True,
            awaitPromise=True,
        )
        if "exceptionDetails" in found:
            raise RuntimeError(f"{expression}: {found['exceptionDetails']['text']}")
        return found["result"].get("value")

    def place(self, selector, x=0.5, y=0.5):
        """A point of an element, in parts of its box, after it was scrolled into view."""
        box = self.evaluate(f"""(() => {{
          const element = document.querySelector({json.dumps(selector)});
          element.scrollIntoView({{block: "center", behavior: "instant"}});
          const {{left, top, width, height}} = element.getBoundingClientRect();
          return [left, top, width, height];
        }})()""")
        left, top, width, height = box
        return left + x * width, top + y * height

    def mouse(self, *points):
        """Press at the first point, move over the others, release at the last one."""
        (x, y), *others = points
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        button = {"button": "left", "buttons": 1}
        pressed = {"type": "mousePressed", "clickCount": 1}
        self.call("Input.dispatchMouseEvent", **pressed, x=x, y=y, **button)
        for x, y in others:
            self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, **button)
        released = {"type": "mouseReleased", "clickCount": 1, "button": "left"}
        self.call("Input.dispatchMouseEvent", **released, x=x, y=y)

    def finger(self, *points):
        """The same with a finger."""
        kinds = ["touchStart"] + ["touchMove"] * (len(points) - 1)
        for kind, (x, y) in zip(kinds, points, strict=True):
            self.call(
                "Input.dispatchTouchEvent", type=kind, touchPoints=[dict(x=x, y=y)]
            )
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def key(self, name, modifiers=0):
        """Press a key: one of `KEYS` or a letter."""
        known = {"key": name, "modifiers": modifiers}
        if name in KEYS:
            known |= {"code": name, "windowsVirtualKeyCode": KEYS[name]}
        text = {"Enter": "\r"}.get(name, "" if name in KEYS else name)
        down = {"type": "keyDown", "text": text} if text else {"type": "rawKeyDown"}
        self.call("Input.dispatchKeyEvent", **down, **known)
        self.call("Input.dispatchKeyEvent", type="keyUp", **known)

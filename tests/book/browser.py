"""Pages in the system's Chromium, without a network, on a desktop or a phone."""

import shutil
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import sync_playwright

PATIENCE = 180_000
"""Milliseconds for a page to be there: the machine may be busy."""

# no page needs a network
FLAGS = "--no-sandbox", "--host-resolver-rules=MAP * ~NOTFOUND"

DESKTOP = {"viewport": {"width": 1280, "height": 800}}
PHONE = {
    "viewport": {"width": 390, "height": 844},
    "device_scale_factor": 2,
    "is_mobile": True,
    "has_touch": True,
}

FAULT = {"warning", "error", "assert"}
"""Kinds of messages of the console that are faults; the theme also says how it begins."""


@contextmanager
def chromium():
    """The system's browser, for pages that are opened beside each other."""
    program = shutil.which("chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield browser
        browser.close()


def opened(browser, file, screen=DESKTOP, script=""):
    """A page of a file that began to load after a script, and a list of its console's faults."""
    context = browser.new_context(**screen)
    context.set_default_timeout(PATIENCE)
    context.add_init_script(script or "0")
    page = context.new_page()
    faults = []

    def notice(message):
        if message.type in FAULT:
            faults.append(f"{message.text}: {message.location['url']}")

    page.on("console", notice)
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto(Path(file).as_uri())
    page.evaluate("window.MathJax?.startup?.promise.then(() => 0)")
    return page, faults

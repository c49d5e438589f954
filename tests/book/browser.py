"""Every page of a folder, opened in Chromium from a server of this machine.

The server adds a script to each page. It waits until the page and its mathematics are there, sends
back what it sees, and goes on to the next page. No other name than 127.0.0.1 resolves, and what a
page requests from elsewhere violates the policy that the server sends with it. The pages are opened
in a frame, as a window cannot be as narrow as a phone.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import threading
import zipfile
from dataclasses import dataclass, field
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import urlsplit

SECONDS_PER_PAGE = 180  # axe reads the page of the packages, with all entries open

FRAME = "/frame-of-width/"
"""Of the address WIDTH/PAGE that shows a page in a frame of that width."""

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-port=0",  # keeps it open until it is ended
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)

POLICY = "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:"
EVENTS = """
[window.faults, window.foreign] = [[], []];
addEventListener("error", e => faults.push(e.message));
for (const kind of ["warn", "error"]) console[kind] = (...words) => faults.push(words.join(" "));
addEventListener("securitypolicyviolation", e => foreign.push(e.blockedURI));
"""

AXE = '<script src="/axe.min.js"></script>'
PACKAGE = "axe-playwright-python==0.1.8"
WHEEL = "axe_playwright_python-0.1.8-py3-none-any.whl"
SHA256 = "fdd263c998388f1a8e67cad02677e612d946248bd44d163be5e8650ea31f95f8"
"""The package with axe 4.12, which finds what hinders readers without a mouse or without sight."""

PROBE = r"""<script>
window.addEventListener("load", async () => {
  const errors = [...window.faults];
  const typeset = window.MathJax && MathJax.startup ? MathJax.startup.promise : null;
  if (typeset) await typeset.catch(error => errors.push(String(error)));
  await new Promise(done => setTimeout(done, 50)); // for events on their way
  for (const image of document.images) image.loading = "eager";
  await Promise.all([...document.images].map(image => image.decode().catch(() => 0)));
  const body = document.querySelector("article") || document.body;
  // What axe finds, in a window of full width.
  const rules = async () => !window.axe ? [] : (await axe.run(document, {preload: false}))
    .violations
    .flatMap(({id, nodes}) => nodes.slice(0, 3).map(({html}) => `${id}: ${html.slice(0, 120)}`));
  const asked = document.querySelectorAll(".lwa-answers");
  const early = [...document.querySelectorAll(".lwa-below")].filter(e => e.clientWidth).length;
  asked.forEach(row => row.firstChild.click());
  const axeFound = await rules(); // before the many entries of the packages unfold
  // What a screen reader says while a hand moves a control.
  const live = body.querySelector(".lwa-chain output");
  const spoken = [];
  if (live) {
    new MutationObserver(() => spoken.push(live.textContent)).observe(live, {childList: true});
    for (let i = 0; i < 50; i++) {
      body.querySelector(".lwa-chain input").dispatchEvent(new Event("input", {bubbles: true}));
      await new Promise(done => setTimeout(done, 50));
    }
  }
  for (const details of document.querySelectorAll("details")) details.open = true;
  const math = [...document.querySelectorAll(".math")];
  const text = body.cloneNode(true);
  const texts = kind => [...document.querySelectorAll(kind)].map(e => e.textContent);
  const overflow = e => getComputedStyle(e).overflowX;
  const scrolls = e => /auto|scroll/.test(overflow(e));
  const hides = e => /hidden|clip/.test(overflow(e));
  const edge = e => e.getBoundingClientRect().right;
  const spill = e => overflow(e) === "visible" ? Math.max(e.scrollWidth - e.clientWidth, 0) : 0;
  const right = e => edge(e) + (e.clientWidth ? spill(e) : 0);
  const cut = (e, a = e.parentElement) =>
    a === body.parentElement || !a ? right(e) > innerWidth + 1
    : scrolls(a) ? false : hides(a) && right(e) > edge(a) + 1 || cut(e, a.parentElement);
  const clipped = e => e.tagName === "PRE" && hides(e) && e.scrollWidth > e.clientWidth + 1;
  const parts = [...body.querySelectorAll("pre, table, img, svg, input, mjx-math, dt, h1, h2, p")];
  const apart = "pre, code, script, style, mjx-container";
  for (const element of text.querySelectorAll(apart)) element.remove();
  const report = {
    mathjax: typeset !== null,
    math: math.length,
    rendered: document.querySelectorAll("mjx-container").length,
    unrendered: math.filter(m => !m.querySelector("mjx-container")).map(m => m.textContent),
    merrors: [...document.querySelectorAll("mjx-merror, [data-mjx-error]")].map(m => m.textContent),
    raw: text.textContent.match(/\\\(|\\\[|\$\$|\\begin\{|\\frac/g) || [],
    images: document.images.length,
    broken: [...document.images].filter(i => !i.naturalWidth || !i.naturalHeight).map(i => i.src),
    unshown: texts("pre").filter(t => t.includes("<Figure size")),
    cut: parts.filter(e => cut(e) || clipped(e)).map(e => e.textContent.trim().slice(0, 80)),
    crumbled: [...body.querySelectorAll("td span.pre")]
      .filter(e => e.getClientRects().length > 2).map(e => e.textContent),
    wider: document.scrollingElement.scrollWidth > innerWidth + 1,
    axe: axeFound,
    spoken: spoken.length > 4 ? spoken : [],
    // What scrolls has to be reached by the keyboard.
    stops: [...document.querySelectorAll("mjx-container, mjx-container *")]
      .filter(e => e.tabIndex >= 0 && !e.closest("a") && e.scrollWidth <= e.clientWidth + 1)
      .map(e => e.textContent),
    asked: asked.length,
    early,
    errors: errors,
    foreign: window.foreign,
  };
  const answer = await fetch("/probe", {method: "POST", body: JSON.stringify(report)});
  const next = await answer.text();
  if (next) location.href = next;
});
</script>
"""


@dataclass
class Visit:
    """Reports of the pages, by their paths, and paths that the server does not have."""

    pages: dict = field(default_factory=dict)
    missing: list = field(default_factory=list)


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, folder, left, visit, mode, axe):
        self.left, self.visit, self.mode, self.axe = left, visit, mode, axe
        self.progress = threading.Event()
        super().__init__(("127.0.0.1", 0), partial(_Handler, directory=str(folder)))


class _Handler(SimpleHTTPRequestHandler):
    def do_GET(self):
        path = Path(self.translate_path(self.path))
        if self.path.startswith(FRAME):
            width, page = self.path.removeprefix(FRAME).split("/", 1)
            frame = f'<iframe src="/{page}" width="{width}" height="900"></iframe>'
            self._send(f'<link rel="icon" href="data:,">{frame}')
        elif path.suffix == ".html" and path.is_file():
            # A page in light mode is a first visit: nothing is stored.
            modes = ""
            if self.server.mode == "dark":
                modes = "localStorage.mode = localStorage.theme = 'dark';"
            head = f"<head><script>{EVENTS}{modes}</script>"
            text = path.read_text().replace("<head>", head, 1)
            probe = (AXE if self.server.axe else "") + PROBE
            self._send(text.replace("</body>", probe + "</body>"))
        elif self.path == "/axe.min.js":
            self._send(self.server.axe)
        else:
            super().do_GET()

    def do_POST(self):
        report = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.server.visit.pages[urlsplit(self.headers["Referer"]).path.lstrip("/")] = (
            report
        )
        self._send(self.server.left.pop(0) if self.server.left else "")
        self.server.progress.set()

    def _send(self, text):
        page = text.encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(page)))
        self.send_header("Content-Security-Policy", POLICY)
        self.end_headers()
        self.wfile.write(page)

    def send_error(self, code, *rest, **more):
        self.server.visit.missing.append(self.path)
        super().send_error(code)

    def log_message(self, *rest):
        pass


def axe(folder):
    """The source of axe, fetched once and kept in the folder."""
    # The book's extension needs Sphinx, which the tests without the book have not.
    sys.path.append(str(Path(__file__).parents[2] / "book" / "_ext"))
    from local_mathjax import fetched

    folder.mkdir(exist_ok=True)
    with zipfile.ZipFile(fetched(folder, PACKAGE, WHEEL, SHA256)) as wheel:
        return wheel.read("axe_playwright_python/axe.min.js").decode()


def visited(folder, pages, width, mode="light", axe=""):
    """Reports of the pages, opened one after another in a frame of this width in CSS pixels.

    mode : "light" or "dark". axe : its source, if each page is to be judged by it.

    Raises `FileNotFoundError` without Chromium and `TimeoutError` when a page does not report.
    """
    chromium = shutil.which("chromium")
    if chromium is None:
        raise FileNotFoundError("chromium is not installed: apt-get install chromium")
    visit = Visit()
    first, *rest = ("/" + page for page in pages)
    with (
        tempfile.TemporaryDirectory() as home,
        _Server(folder, rest, visit, mode, axe) as server,
    ):
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_address[1]}{FRAME}{width}{first}"
        command, silent = (
            [chromium, *FLAGS, f"--user-data-dir={home}", address],
            subprocess.DEVNULL,
        )
        browser = subprocess.Popen(command, stdout=silent, stderr=silent)
        try:
            while len(visit.pages) < len(pages):
                server.progress.clear()
                if not server.progress.wait(SECONDS_PER_PAGE):
                    todo = [page for page in pages if page not in visit.pages]
                    raise TimeoutError(
                        f"{todo[0]} did not report in {SECONDS_PER_PAGE} s"
                    )
        finally:
            browser.terminate()
            browser.wait(30)
            server.shutdown()
    return visit

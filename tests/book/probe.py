"""What can be seen of a page in the browser: mathematics, pictures, widths, what axe finds."""

from tests.book.browser import chromium, opened

PROBE = r"""(async () => {
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
    mathjax: Boolean(window.MathJax),
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
  };
  return report;
})()"""
"""What is wrong on a page, and what stands on it."""

DARK = "localStorage.mode = localStorage.theme = 'dark';"
"""A script of a reader's choice; without it each browser begins with a first visit."""


def seen(folder, pages, width, script="", axe=""):
    """Reports of the pages in a window of this width in CSS pixels, after a script.

    ``errors`` are the console's: a request for what is missing, or not beside the page, is one.
    """
    reports = {}
    window = {"viewport": {"width": width, "height": 800}}
    with chromium() as browser:
        for name in pages:
            page, errors = opened(browser, folder / name, window, script)
            page.evaluate(f"{axe}; 0")
            reports[name] = page.evaluate(PROBE) | {"errors": errors}
            page.context.close()
    return reports

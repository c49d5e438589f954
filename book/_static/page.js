// Every page: pictures of several panels are stacked on a phone, formulas fit their column, what is
// still wider can be scrolled from the keyboard, and names and roles are said that the theme leaves out.
"use strict";
const phone = matchMedia("(max-width: 40rem)").matches;

// On a phone the parts of an equation stand below each other. MathJax, a deferred script, comes later.
document.addEventListener("readystatechange", () => {
  if (!phone || document.readyState !== "interactive") return;
  for (const {lastChild: source} of document.querySelectorAll("div.math")) {
    const body = source?.textContent.match(/^\s*\\\[([^&]*)\\\]\s*$/)?.[1];
    if (!body?.includes("\\qquad")) continue;
    const lines = body.replaceAll("\\qquad", "\\\\[0.4em]");
    const several = lines.includes("\\begin{gathered}");
    source.textContent = several ? `\\[${lines}\\]` : `\\[\\begin{gathered}${lines}\\end{gathered}\\]`;
  }
});

addEventListener("load", async () => {
  await window.MathJax?.startup?.promise;
  if (phone) {
    for (const image of document.querySelectorAll("figure > img[class*=panels-]")) stack(image);
  }
  name();
  const arrange = () => {
    document.querySelectorAll("mjx-container[display=true]").forEach(fit);
    const wide = "pre, mjx-container[display=true], .text_html > table, .pst-scrollable-table-container";
    document.querySelectorAll(wide).forEach(reach);
  };
  arrange();
  document.fonts.ready.then(arrange); // letters have other widths then
  addEventListener("resize", arrange);
  document.addEventListener("toggle", arrange, true); // what was folded has a width now
});

// A formula that is too wide is set smaller, if it stays readable: then it does not scroll.
const SMALLEST = 9; // pixels
function fit(formula) {
  formula.dataset.size ??= formula.style.fontSize;
  formula.style.fontSize = formula.dataset.size;
  const part = formula.clientWidth / formula.scrollWidth;
  const size = 0.99 * part * parseFloat(getComputedStyle(formula).fontSize);
  if (part < 1 && size > SMALLEST) formula.style.setProperty("font-size", `${size}px`, "important");
}

// What is wider than its place is a stop of the Tab key; a formula is named by its own text.
function reach(element) {
  const scrolls = element.scrollWidth > element.clientWidth + 1;
  const more = {tabindex: "0"};
  if (element.getAttribute("role") !== "math") {
    more.role = "group";
    more["aria-label"] = "wider than the page, scrolls";
  }
  for (const [key, value] of Object.entries(more)) {
    if (scrolls) element.setAttribute(key, value);
    else element.removeAttribute(key);
  }
}

function name() {
  // A formula is read as it is written in TeX.
  for (const {math, typesetRoot} of window.MathJax?.startup?.document?.math ?? []) {
    typesetRoot.setAttribute("role", "math");
    typesetRoot.setAttribute("aria-label", math.trim());
  }
  const sidebar = document.querySelector(".bd-sidebar-primary");
  sidebar?.setAttribute("role", "region");
  sidebar?.setAttribute("aria-label", "Contents of the book");
  // The theme's names of these hide the words that stand on them.
  for (const button of document.querySelectorAll(".search-button-field, .cell summary")) {
    button.removeAttribute("aria-label");
  }
  // Sphinx breaks long signatures by a list without terms: these are lines.
  for (const list of document.querySelectorAll("dt.sig > dl")) {
    const lines = [...list.children].map(part => {
      const line = document.createElement("div");
      line.className = "lwa-line";
      line.append(...part.childNodes);
      return line;
    });
    list.replaceWith(...lines);
  }
  for (const source of document.querySelectorAll("div.citation")) {
    source.setAttribute("role", "listitem");
  }
}

// A picture of n panels side by side is shown n times, each time one of them.
function stack(image) {
  const count = Number(image.className.match(/panels-(\d)/)[1]);
  const shape = image.naturalWidth / count / image.naturalHeight;
  for (let panel = 0; panel < count; panel++) {
    const one = panel ? image.cloneNode() : image;
    one.classList.add("stacked");
    one.style.aspectRatio = shape;
    one.style.objectPosition = `${(100 * panel) / (count - 1)}% 0`;
    if (panel) {
      one.alt = "";
      image.parentElement.querySelector("figcaption").before(one);
    }
  }
}

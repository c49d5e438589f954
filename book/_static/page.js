// Every page: pictures of several panels are stacked on a phone, what is wider than the page can be
// scrolled from the keyboard, and names and roles are said that the theme leaves out.
"use strict";
addEventListener("load", async () => {
  await window.MathJax?.startup?.promise;
  if (matchMedia("(max-width: 40rem)").matches) {
    for (const image of document.querySelectorAll("figure > img[class*=panels-]")) stack(image);
  }
  name();
  const wide = "pre, mjx-container[display=true], .text_html > table, .pst-scrollable-table-container";
  for (const element of document.querySelectorAll(wide)) {
    if (element.scrollWidth <= element.clientWidth + 1) continue;
    element.tabIndex = 0;
    if (element.getAttribute("role") === "math") continue; // named by its own text
    element.setAttribute("role", "group");
    element.setAttribute("aria-label", "wider than the page, scrolls");
  }
});

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

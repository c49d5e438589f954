// Every page: pictures of several panels are stacked on a phone, and what is wider than the page can
// be scrolled from the keyboard.
"use strict";
addEventListener("load", async () => {
  await window.MathJax?.startup?.promise;
  if (matchMedia("(max-width: 40rem)").matches) {
    for (const image of document.querySelectorAll("figure > img[class*=panels-]")) stack(image);
  }
  const wide = "pre, mjx-container[display=true], .text_html > table, .pst-scrollable-table-container";
  for (const element of document.querySelectorAll(wide)) {
    if (element.scrollWidth <= element.clientWidth + 1) continue;
    element.tabIndex = 0;
    element.setAttribute("role", "group");
    element.setAttribute("aria-label", "wider than the page, scrolls");
  }
});

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

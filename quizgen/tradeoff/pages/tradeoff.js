// The sliders of `quizgen tradeoff`: the input moves, and digits vanish. Without it each page shows
// one place of every path. Listens on the document, so a page that comes later is served too.
"use strict";
{
  const write = (cell, [right, wrong, power]) => {
    cell.replaceChildren();
    for (const [name, text] of [["b", right], ["s", wrong], ["span", power]])
      if (text) cell.append(Object.assign(document.createElement(name), { textContent: text }));
  };
  document.addEventListener("input", ({ target }) => {
    const box = target.closest(".sweep");
    if (!box) return;
    const [x, at, said, ...numbers] = JSON.parse(box.dataset.places)[target.value];
    box.querySelector("output").textContent = at;
    target.setAttribute("aria-valuetext", said);
    box.querySelectorAll("td").forEach((cell, i) => write(cell, numbers[i]));
    const line = box.querySelector(".cursor");
    line.setAttribute("x1", x);
    line.setAttribute("x2", x);
  });
}

// The slider of `quizgen tradeoff`: the input moves, and digits vanish. Without it the page shows
// one place of the first formula. Listens on the document: a page that comes later is served, too.
"use strict";
{
  const write = (cell, parts) => {
    cell.replaceChildren();
    ["b", "s", "span"].forEach((name, i) => {
      if (parts[i]) cell.append(Object.assign(document.createElement(name), { textContent: parts[i] }));
    });
  };
  document.addEventListener("input", ({ target }) => {
    const box = target.closest(".sweep");
    if (!box) return;
    const find = (name) => box.querySelector(name);
    const slider = find("input");
    const formula = JSON.parse(box.dataset.formulas)[find("select").value];
    const [at, where, ...numbers] = formula.places[slider.value];
    find("output").textContent = at;
    find(".where").textContent = where;
    find(".lesson").textContent = formula.lesson;
    find(".printed").innerHTML = formula.printed;
    find(".stable").innerHTML = formula.stable;
    slider.setAttribute("aria-valuetext", `${at}, ${where}`);
    box.querySelectorAll("td").forEach((cell, i) => write(cell, numbers[i]));
  });
}

"use strict";
// The marking page: the sum while lines are ticked, and keys for everything.

(() => {
  const form = () => document.getElementById("decide");
  const lines = () => [...form().querySelectorAll("[name=line]")];
  const shown = (value) => new Intl.NumberFormat(document.documentElement.lang, { maximumFractionDigits: 2 }).format(value);
  // As ``rubrics.py`` adds up: of a line and its half the larger counts, and all of it in quarters.
  const total = () => {
    const typed = form().elements.points.value.trim().replace(",", ".");
    if (typed !== "" && !Number.isNaN(Number(typed))) { return Number(typed); }
    const best = new Map();
    for (const line of lines().filter((one) => one.checked)) {
      const name = line.value.replace(/\/half$/, ""), points = Number(line.dataset.points);
      best.set(name, Math.max(best.get(name) ?? points, points));
    }
    const sum = [...best.values()].reduce((a, b) => a + b, 0);
    return Math.floor(Math.max(0, Math.min(sum, Number(form().dataset.worth))) * 4 + .5) / 4;
  };
  const refresh = () => {
    if (!form()) { return; }
    const points = shown(total());
    form().querySelector("[data-sum]").firstChild.data = `${points} `;
    form().querySelector(".dock .main").textContent = form().dataset.next.replace("{}", points);
  };
  const tick = (all) => { lines().forEach((one) => { one.checked = all && Number(one.dataset.points) > 0 && !one.value.endsWith("/half"); }); refresh(); };
  document.addEventListener("focusin", (event) => { if (event.target.matches(".proposed")) { event.target.select(); } });
  document.addEventListener("input", refresh);
  document.addEventListener("htmx:after:swap", refresh);
  document.addEventListener("keydown", (event) => {
    const at = event.target;
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || !form()) { return; }
    if (at.matches("input[type=text], textarea, select")) {
      if (event.key === "Escape") { event.preventDefault(); at.blur(); }
      return;
    }
    if (event.key === "Enter" && at.closest("a, button, summary")) { return; }
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const line = /^[1-9]$/.test(key) ? lines()[key - 1] : null;
    const named = line ?? document.querySelector(`[data-k="${CSS.escape(key)}"]`);
    if (key === "0" || key === "a") { tick(key === "a"); }
    else if (!named) { return; }
    else if (named.matches("input[type=text]")) { named.focus(); named.select(); }
    else { named.click(); }
    event.preventDefault();
  });
  refresh();
})();

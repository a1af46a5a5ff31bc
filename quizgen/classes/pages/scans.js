"use strict";
// What is typed beside a picture stays in this browser until it is saved as a table.
const rows = [...document.querySelectorAll(".ask")], place = "scans " + document.title;
const known = JSON.parse(localStorage.getItem(place) || "{}");
const name = row => JSON.stringify([row.dataset.id, row.dataset.part]);
const show = () => {
  const done = rows.filter(row => name(row) in known).length;
  rows.forEach(row => row.classList.toggle("done", name(row) in known));
  const left = document.getElementById("left");
  if (left) left.textContent = `${done} / ${rows.length}`;
};
const keep = (row, text) => {
  if (text === null) delete known[name(row)]; else known[name(row)] = text;
  localStorage.setItem(place, JSON.stringify(known));
  show();
};
const next = row => rows[rows.indexOf(row) + 1]?.querySelector("input").focus();
for (const row of rows) {
  const input = row.querySelector("input");
  input.value = known[name(row)] || "";
  input.addEventListener("change", () => keep(row, input.value.trim() || null));
  input.addEventListener("keydown", event => {
    if (event.key !== "Enter") return;
    if (!input.value.trim() && !(name(row) in known)) input.value = input.dataset.proposal;
    if (input.value.trim()) keep(row, input.value.trim());
    next(row);
  });
  row.querySelector("button").addEventListener("click", () => { input.value = ""; keep(row, ""); next(row); });
}
// Whose page a picture without a code is, as a row of the same table.
const taken = [...document.querySelectorAll(".assign, .back")];
const saidOf = box => {
  const [whose, page] = box.querySelectorAll("input");
  if (!page) return whose.checked ? ["", "page", box.dataset.picture] : null;
  return whose.value.trim() && page.value ? [whose.value.trim(), `page ${page.value}`, box.dataset.picture] : null;
};
const cell = text => `"${(/^[=+@\-\t]/.test(text) ? "'" : "") + text.replaceAll('"', '""')}"`;
document.getElementById("save")?.addEventListener("click", () => {
  const table = rows.filter(row => name(row) in known).map(row => [row.dataset.id, row.dataset.part, known[name(row)]]);
  const text = [["id", "part", "answer"], ...taken.map(saidOf).filter(Boolean), ...table].map(row => row.map(cell).join(",")).join("\n") + "\n";
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(["\ufeff" + text], {type: "text/csv"}));
  link.download = "typed.csv";
  link.click();
});
show();

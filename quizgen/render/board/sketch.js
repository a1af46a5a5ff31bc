"use strict";
// Lines that are drawn in a field, by mouse, finger, pen or keys. The text underneath, points with
// lines between semicolons, is what is posted; whoever types there sees it drawn.

const sketching = (box) => {
  const area = box.parentElement.querySelector("textarea, input.typing");
  if (!area || area.readOnly || box.dataset.ready) { return; }
  box.dataset.ready = "yes";
  const svg = box.querySelector(".strokes");
  const numbers = (name) => box.dataset[name].split(" ").map(Number);
  const [left, right, low, high] = numbers("view"), [x0, y0, wide, tall] = numbers("frame"), snaps = numbers("grid").map((step) => step / 5);
  const digits = [right - left, high - low].map((extent) => Math.max(0, 2 - Math.floor(Math.log10(extent))));
  const toPicture = ([x, y]) => [x0 + (x - left) / (right - left) * wide, y0 + (high - y) / (high - low) * tall];
  const toField = ([x, y]) => [left + (x - x0) / wide * (right - left), high - (y - y0) / tall * (high - low)]
    .map((value, i) => Math.min(i ? high : right, Math.max(i ? low : left, value)));
  const snapped = (point) => point.map((value, i) => Math.round(value / snaps[i]) * snaps[i]);
  const number = (value, i) => String(Number(value.toFixed(digits[i])) + 0);
  const written = (lines) => lines.map((line) => line.map((point) => point.map(number).join(",")).join(" ")).join("; ");
  const typed = () => area.value.replaceAll("\u2212", "-").split(/[;\n]/)
    .map((line) => [...line.matchAll(/(-?[\d.]+) ?, ?(-?[\d.]+)/g)].map((found) => [Number(found[1]), Number(found[2])]))
    .filter((line) => line.length && line.flat().every(Number.isFinite));
  let now = null, cursor = null, setting = false, pointer = null;
  const on = (name) => box.querySelector(`[data-tool=${name}]`).getAttribute("aria-pressed") === "true";
  const say = (text) => { document.getElementById("said").textContent = text; };
  const spoken = (value, i) => number(value, i).replace(".", box.dataset.decimal ?? ".");
  const told = (key, point) => box.dataset[key].replace("{x}", spoken(point[0], 0)).replace("{y}", spoken(point[1], 1));

  const show = () => {
    svg.replaceChildren();
    const put = (name, attributes) => {
      const made = document.createElementNS(svg.namespaceURI, name);
      Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, value));
      svg.append(made);
    };
    [...typed(), ...(now ? [now] : [])].forEach((line) => {
      put("polyline", { points: line.map((point) => toPicture(point).map((v) => v.toFixed(1)).join(",")).join(" ") });
      if (line.length === 1) { const [cx, cy] = toPicture(line[0]); put("circle", { cx, cy, r: 2.5 }); }
    });
    if (now && pointer !== null) { const [cx, cy] = toPicture(now.at(-1)); put("circle", { cx, cy, r: 6, class: "tip" }); }
    if (cursor && svg === document.activeElement) {
      const [x, y] = toPicture(cursor);
      put("path", { d: `M${x - 8} ${y}h16M${x} ${y - 8}v16`, class: "cursor" });
    }
  };
  const set = (lines) => {
    area.value = written(lines);
    area.dispatchEvent(new Event("input", { bubbles: true }));
  };

  // A line with as few points as keep it where it was drawn (Ramer, Douglas and Peucker).
  const simple = (line, slack) => {
    if (line.length < 3) { return line; }
    const [a, b] = [line[0], line.at(-1)].map(toPicture);
    const run = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const off = line.map(toPicture).map(([x, y]) => run ? Math.abs((b[0] - a[0]) * (a[1] - y) - (a[0] - x) * (b[1] - a[1])) / run : Math.hypot(x - a[0], y - a[1]));
    const far = off.indexOf(Math.max(...off));
    return off[far] <= slack ? [line[0], line.at(-1)] : [...simple(line.slice(0, far + 1), slack).slice(0, -1), ...simple(line.slice(far), slack)];
  };
  const keep = (line) => {
    let lines = [...typed(), simple(line, 0.8)];
    for (let slack = 1.6; written(lines).length > 3800 && slack < 20; slack *= 2) { lines = lines.map((one) => simple(one, slack)); }
    set(lines);
  };

  const at = (event) => {
    const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const point = toField([place.x, place.y]);
    return on("snap") ? snapped(point) : point;
  };
  svg.addEventListener("pointerdown", (event) => {
    if (event.button || pointer !== null) { return; } // another finger
    event.preventDefault();
    pointer = event.pointerId;
    svg.setPointerCapture(pointer);
    now = [at(event)];
    setting = false;
    show();
  });
  svg.addEventListener("pointermove", (event) => {
    if (event.pointerId !== pointer || !now || setting) { return; }
    now = on("ruler") ? [now[0], at(event)] : [...now, at(event)];
    show();
  });
  const finish = (event) => {
    if (event.pointerId !== pointer) { return; }
    pointer = null;
    if (!now || setting) { return; }
    const line = now;
    now = null;
    if (line.length > 1) { keep(line); } else { show(); }
  };
  svg.addEventListener("pointerup", finish);
  svg.addEventListener("pointercancel", finish);

  // Keys: arrows move a cross, Enter sets a point, Escape ends the line, Backspace takes back.
  const end = () => {
    const line = now;
    [now, setting] = [null, false];
    if (line && line.length > 1) { set([...typed(), line]); say(box.dataset.ended); } else { show(); }
  };
  const undo = () => {
    if (now) { now = now.length > 1 ? now.slice(0, -1) : null; setting = Boolean(now); } else { set(typed().slice(0, -1)); }
    show();
    say(box.dataset.undone);
  };
  const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  svg.addEventListener("keydown", (event) => {
    const way = moves[event.key];
    if (way) {
      const size = event.shiftKey ? 5 : 1;
      cursor = cursor.map((value, i) => Math.min(i ? high : right, Math.max(i ? low : left, value + way[i] * snaps[i] * size)));
      say(told("at", cursor));
    } else if (event.key === "Enter" || event.key === " ") {
      [now, setting] = [[...(now ?? []), cursor], true];
      say(told("point", cursor));
    } else if (event.key === "Escape") { end(); } else if (event.key === "Backspace") { undo(); } else { return; }
    event.preventDefault();
    show();
  });
  svg.addEventListener("focus", () => { cursor ??= snapped([(left + right) / 2, (low + high) / 2]); show(); });
  svg.addEventListener("blur", () => { if (setting) { end(); } show(); });

  box.querySelector(".tools").hidden = false;
  box.querySelectorAll("[data-tool]").forEach((button) => button.addEventListener("click", () => {
    if (button.dataset.tool === "undo") { undo(); } else if (button.dataset.tool === "clear") { now = null; set([]); } else {
      button.setAttribute("aria-pressed", button.getAttribute("aria-pressed") !== "true");
    }
  }));
  svg.setAttribute("tabindex", "0");
  area.addEventListener("input", show);
  show();
};
const sketches = () => document.querySelectorAll("[data-view]").forEach(sketching);
sketches();
document.addEventListener("htmx:after:swap", sketches);

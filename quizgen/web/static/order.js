"use strict";
// Steps that are put in order by dragging or by keys. The drop-downs stand underneath: they are what
// is posted, what screen readers may use as well, and all there is without scripts.

const ENDS = ["pointerup", "pointercancel"];
const ordering = (box) => {
  const steps = [...box.querySelectorAll("[data-mark]")];
  const places = [...box.querySelectorAll("select")];
  if (!steps.length || places.some((place) => place.disabled) || box.dataset.ready) { return; }
  box.dataset.ready = "yes";
  const list = box.querySelector(".steps-to-order");
  box.querySelector(".hint").hidden = false;
  const rank = (step) => { const at = places.findIndex((p) => p.value === step.dataset.mark); return at < 0 ? Infinity : at; };
  const told = () => list.querySelectorAll("[data-mark]").forEach((step) => {
    const at = rank(step);
    step.querySelector(".at").textContent = at === Infinity ? "" : `${at + 1}.`;
    step.classList.toggle("placed", at !== Infinity);
  });
  const arrange = () => {
    const placed = steps.filter((s) => rank(s) !== Infinity).sort((a, b) => rank(a) - rank(b));
    list.append(...placed, ...steps.filter((s) => rank(s) === Infinity));
    told();
  };
  const set = (marks) => {
    places.forEach((place, i) => { place.value = marks[i] ?? ""; });
    told();
    places[0].dispatchEvent(new Event("input", { bubbles: true }));
  };
  const marks = () => places.map((place) => place.value).filter(Boolean);
  // Moves a step to a place, counted from 0; beyond the placed ones it is taken out.
  const move = (step, to) => {
    const left = marks().filter((mark) => mark !== step.dataset.mark);
    if (to !== null) { left.splice(Math.max(0, Math.min(to, left.length)), 0, step.dataset.mark); }
    set(left);
    arrange();
  };
  for (const step of steps) {
    step.tabIndex = 0;
    step.addEventListener("keydown", (event) => {
      const at = rank(step), end = marks().length;
      const to = { ArrowUp: at === Infinity ? end : at - 1, ArrowDown: at === Infinity ? end : at + 1, Enter: end, " ": end,
        Backspace: null, Delete: null }[event.key];
      if (to === undefined || ((event.key === "Enter" || event.key === " ") && at !== Infinity)) { return; }
      event.preventDefault();
      move(step, to);
      step.focus();
      document.getElementById("said").textContent = `${step.dataset.mark}: ${step.querySelector(".at").textContent || "-"}`;
    });
    const grip = document.createElement("span");
    grip.className = "grip";
    grip.setAttribute("aria-hidden", "true");
    grip.textContent = "\u2195";
    step.prepend(grip);
    step.addEventListener("pointerdown", (event) => {
      if (event.button || (event.pointerType !== "mouse" && event.target !== grip)) { return; }
      const from = event.clientY;
      const drag = (now) => {
        if (now.pointerId !== event.pointerId) { return; } // another finger
        if (Math.abs(now.clientY - from) > 4) { step.classList.add("held"); }
        if (!step.classList.contains("held")) { return; }
        const after = [...list.children].find((one) => one !== step && now.clientY < one.getBoundingClientRect().top + one.offsetHeight / 2);
        if (step.nextElementSibling !== (after ?? null)) { list.insertBefore(step, after ?? null); }
      };
      const drop = (now) => {
        if (now.pointerId !== event.pointerId) { return; }
        document.removeEventListener("pointermove", drag);
        for (const end of ENDS) { document.removeEventListener(end, drop); }
        if (!step.classList.contains("held")) { return; }
        step.classList.remove("held");
        const before = [...list.children].slice(0, [...list.children].indexOf(step));
        move(step, before.filter((one) => rank(one) !== Infinity).length);
        step.focus({ preventScroll: true });
      };
      document.addEventListener("pointermove", drag);
      for (const end of ENDS) { document.addEventListener(end, drop); }
    });
  }
  places.forEach((place) => place.addEventListener("change", arrange));
  arrange();
};
const orders = () => document.querySelectorAll("[data-order]").forEach(ordering);
orders();
document.addEventListener("htmx:after:swap", orders);

"use strict";
// Pairs by chips: tap a place and then a chip, tap a chip alone for the first empty place, or drag
// it there. The drop-downs stay underneath: they are what is posted, and all there is without scripts.

const pairing = (box) => {
  const rows = [...box.querySelectorAll(".option:has(select)")];
  const selects = rows.map((row) => row.querySelector("select"));
  if (!rows.length || selects.some((select) => select.disabled) || box.dataset.ready) { return; }
  box.dataset.ready = "yes";
  const words = new Map([...box.querySelectorAll(".targets > li")].map((li) => [String(li.value), li]));
  let active = null;
  const slots = rows.map((row, index) => {
    const slot = document.createElement("button");
    slot.type = "button";
    slot.className = "slot";
    slot.dataset.slot = index;
    row.prepend(slot);
    slot.addEventListener("click", () => {
      if (selects[index].value) { put(index, ""); }
      active = index;
      show();
    });
    return slot;
  });
  const tray = document.createElement("ul");
  tray.className = "chips";
  const chips = [...words].map(([number, li]) => {
    const item = document.createElement("li"), chip = document.createElement("button");
    chip.type = "button";
    chip.className = "chip";
    chip.dataset.chip = number;
    chip.innerHTML = li.innerHTML;
    item.append(chip);
    tray.append(item);
    return chip;
  });
  box.append(tray);
  const put = (index, number) => {
    selects[index].value = number;
    selects[index].dispatchEvent(new Event("input", { bubbles: true }));
  };
  const firstEmpty = () => { const at = selects.findIndex((select) => !select.value); return at < 0 ? null : at; };
  const show = () => {
    if (active === null || selects[active].value) { active = firstEmpty(); }
    slots.forEach((slot, index) => {
      const chosen = words.get(selects[index].value);
      if (chosen) { slot.innerHTML = chosen.innerHTML; } else { slot.textContent = box.dataset.empty; }
      slot.classList.toggle("filled", Boolean(chosen));
      slot.classList.toggle("active", index === active);
      slot.setAttribute("aria-label", `${rows[index].querySelector("label").textContent.trim()}: ${slot.textContent.trim()}`);
    });
    chips.forEach((chip) => chip.classList.toggle("used", selects.some((select) => select.value === chip.dataset.chip)));
  };
  const take = (number, index) => {
    if (index === null) { return; }
    put(index, number);
    active = null;
    show();
  };
  for (const chip of chips) {
    let dragged = false;
    chip.addEventListener("click", () => { if (!dragged) { take(chip.dataset.chip, active); } dragged = false; });
    chip.addEventListener("pointerdown", (down) => {
      if (down.button) { return; }
      const over = (event) => document.elementFromPoint(event.clientX, event.clientY)?.closest("[data-slot]");
      const move = (event) => {
        if (event.pointerId !== down.pointerId) { return; }
        const [dx, dy] = [event.clientX - down.clientX, event.clientY - down.clientY];
        if (!dragged && Math.hypot(dx, dy) < 8) { return; }
        dragged = true;
        chip.style.transform = `translate(${dx}px, ${dy}px)`;
        chip.style.pointerEvents = "none";
        slots.forEach((slot) => slot.classList.toggle("over", slot === over(event)));
      };
      const drop = (event) => {
        if (event.pointerId !== down.pointerId) { return; }
        const slot = dragged && over(event);
        chip.style.transform = chip.style.pointerEvents = "";
        slots.forEach((one) => one.classList.remove("over"));
        if (slot && box.contains(slot)) { take(chip.dataset.chip, Number(slot.dataset.slot)); }
        document.removeEventListener("pointermove", move);
        for (const end of ["pointerup", "pointercancel"]) { document.removeEventListener(end, drop); }
        setTimeout(() => { dragged = false; });
      };
      document.addEventListener("pointermove", move);
      for (const end of ["pointerup", "pointercancel"]) { document.addEventListener(end, drop); }
    });
  }
  selects.forEach((select) => { select.tabIndex = -1; select.addEventListener("change", show); });
  box.addEventListener("quizgen:filled", show);
  show();
};
const allPairs = () => document.querySelectorAll("[data-pairs]").forEach(pairing);
allPairs();
document.addEventListener("htmx:after:swap", allPairs);

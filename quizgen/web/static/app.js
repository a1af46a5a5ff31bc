"use strict";
// What pages do beyond plain forms. Everything works without it.

// An exam: each change is kept in this browser first and sent to the server; what the server has
// confirmed leaves the browser. While the server is away it is tried again.
(() => {
  const form = document.getElementById("exam");
  if (!form) { return; }
  const place = "quizgen/exam/" + form.dataset.exam + "/";
  const said = document.getElementById("kept");
  const store = {
    get(name) { try { return JSON.parse(localStorage.getItem(place + name)); } catch { return null; } },
    set(name, value) { try { localStorage.setItem(place + name, JSON.stringify(value)); } catch { /* full or forbidden */ } },
    drop(name) { try { localStorage.removeItem(place + name); } catch { /* forbidden */ } },
  };
  const parts = [...form.querySelectorAll("fieldset[data-part]")];
  const fields = (part) => [...part.querySelectorAll("input:not([type=hidden]), select, textarea")];
  const ticks = (field) => field.type === "radio" || field.type === "checkbox";
  const values = (part) => fields(part).filter((f) => !ticks(f) || f.checked).map((f) => f.value);
  const fill = (part, kept) => fields(part).forEach((f, i) => {
    if (ticks(f)) { f.checked = kept.includes(f.value); } else { f.value = kept[i] ?? ""; }
  });
  const overview = () => form.querySelectorAll("a[data-question]").forEach((link) => {
    const question = document.getElementById("question-" + link.dataset.question);
    const answered = [...question.querySelectorAll("fieldset[data-part]")]
      .every((part) => values(part).some((value) => value.trim()));
    link.classList.toggle("answered", answered);
  });
  const waiting = new Set();
  let busy = false, later = 0, wait = 0;
  const soon = (after) => { clearTimeout(later); later = setTimeout(send, after); };
  const send = async () => {
    if (busy || !waiting.size) { return; }
    busy = true;
    const names = [...waiting], body = new URLSearchParams({ token: form.elements.token.value });
    const sent = new Map();
    for (const part of parts.filter((p) => names.includes(p.dataset.part))) {
      const name = part.dataset.part, now = values(part);
      sent.set(name, JSON.stringify(now));
      body.append("on-" + name, "1");
      now.forEach((value) => body.append("a-" + name, value));
    }
    try {
      const answer = await fetch(form.action, { method: "POST", body, headers: { Accept: "application/json" } });
      if (answer.status === 409) { said.textContent = form.dataset.over; waiting.clear(); location.reload(); return; }
      if (!answer.ok) { throw new Error(answer.status); }
      for (const part of parts) {
        const name = part.dataset.part;
        if (sent.has(name) && sent.get(name) === JSON.stringify(values(part))) { waiting.delete(name); store.drop(name); }
      }
      wait = 0;
      said.textContent = waiting.size ? "" : form.dataset.saved;
    } catch {
      wait = Math.min(30000, 1000 + wait * 2);
      said.textContent = form.dataset.away;
    } finally { busy = false; }
    if (waiting.size) { soon(wait || 300); }
  };
  for (const part of parts) {
    const kept = store.get(part.dataset.part);
    if (Array.isArray(kept)) { fill(part, kept); waiting.add(part.dataset.part); }
    part.addEventListener("input", () => {
      store.set(part.dataset.part, values(part));
      waiting.add(part.dataset.part);
      overview();
      soon(400);
    });
  }
  overview();
  soon(0);
  addEventListener("pagehide", () => { if (waiting.size) { send(); } });
  form.addEventListener("submit", () => { for (const part of parts) { store.drop(part.dataset.part); } });
  const clock = form.querySelector("[data-left]");
  if (clock) {
    const ends = performance.now() + 1000 * Number(clock.dataset.left);
    const tick = () => {
      const left = ends - performance.now();
      clock.textContent = form.dataset.minutes.replace("{}", Math.max(0, Math.ceil(left / 60000)));
      clock.classList.toggle("late", left < 300000);
      if (left <= 0) { send().finally(() => location.reload()); } else { setTimeout(tick, Math.min(left, 15000) + 50); }
    };
    tick();
  }
})();

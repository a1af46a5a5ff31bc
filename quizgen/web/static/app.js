"use strict";
// What pages do beyond plain forms. Everything works without it.

// A second click, while what the first one sent is on its way, sends nothing.
document.addEventListener("submit", (event) => {
  const form = event.target;
  if (event.defaultPrevented) { return; }
  if (Date.now() - (form.dataset.sent ?? 0) < 5000) { event.preventDefault(); } else { form.dataset.sent = Date.now(); }
});

// The parts of an exam; figures, too, name what they draw by data-part.
const PARTS = "fieldset[data-part], .placed-field[data-part]";
// The fields of a part, and what stands in them.
const fields = (part) => [...part.querySelectorAll("input:not([type=hidden]), select, textarea")];
const ticks = (field) => field.type === "radio" || field.type === "checkbox";
const values = (part) => fields(part).filter((f) => !ticks(f) || f.checked).map((f) => f.value);
const fill = (part, kept) => fields(part).forEach((f, i) => {
  if (ticks(f)) { f.checked = kept.includes(f.value); } else { f.value = kept[i] ?? ""; }
  f.closest("[data-pairs]")?.dispatchEvent(new Event("quizgen:filled"));
});

// Practice: what is typed and not sent yet outlives a reload and a change of language in this tab,
// as long as the server still has what the page was made with.
(() => {
  const name = (form) => "quizgen/typed" + new URL(form.action).pathname;
  const given = (form) => fields(form).map((f) => f.options ? [...f.options].findIndex((o) => o.defaultSelected) : ticks(f) ? f.defaultChecked : f.defaultValue);
  document.addEventListener("input", (event) => {
    const form = event.target.closest("section.part form");
    if (!form) { return; }
    try { sessionStorage.setItem(name(form), JSON.stringify([given(form), values(form)])); } catch { /* full or forbidden */ }
  });
  for (const form of document.querySelectorAll("section.part form:has(button.main)")) {
    try {
      const [before, now] = JSON.parse(sessionStorage.getItem(name(form))) ?? [];
      if (JSON.stringify(before) === JSON.stringify(given(form))) { fill(form, now); }
    } catch { /* forbidden */ }
  }
})();

// Practice: whoever answers by keys goes on where they were, or at what comes next where that is gone.
const TO_FILL = "section.part :is(input:not([type=hidden]), textarea, select, .slot):not([readonly], :disabled, [tabindex='-1'], details:not([open]) *), section.part .dock .main";
document.addEventListener("htmx:after:swap", () => {
  [...document.querySelectorAll("section.part :is(.verdict, .hints > :last-child, .result)")].at(-1)?.scrollIntoView({ block: "nearest" });
  if (document.activeElement && document.activeElement !== document.body) { return; }
  document.querySelector(TO_FILL)?.focus({ preventScroll: true });
});
// With a mouse there is a keyboard, too; on a phone the focus would lift one over the figure. What has
// it already keeps it: somebody went on by keys while this was on its way.
if (document.body.classList.contains("play") && matchMedia("(pointer: fine)").matches && document.activeElement === document.body) {
  document.querySelector(TO_FILL)?.focus({ preventScroll: true });
}

// Keys of the player: 1-9 choose, Enter goes on, letters are those of the buttons, Escape stops.
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || !document.body.classList.contains("play")) { return; }
  const at = event.target;
  if (at.matches("input:not([type=radio], [type=checkbox], [type=range]), textarea, select, [role=application]")) { return; }
  const seen = (what) => [...document.querySelectorAll(what)].filter((one) => one.checkVisibility());
  const press = (element) => { if (element) { event.preventDefault(); element.click(); element.focus(); } };
  if (event.key === "Enter" && !at.closest("a, button, summary, [data-mark], [data-chip], [data-slot]")) { press(seen(".dock .main")[0]); }
  else if (/^[1-9]$/.test(event.key)) { press(seen(".option > input:enabled")[event.key - 1]); }
  else if (event.key === "Escape") { press(document.querySelector(".progress-bar a")); }
  else { press(seen(`[aria-keyshortcuts="${CSS.escape(event.key.toLowerCase())}"]`)[0]); }
});

// The formula sheet: what holds every word that is searched for; "/" leads to the search.
(() => {
  const find = document.querySelector("[data-find]");
  if (!find) { return; }
  find.closest("[hidden]").hidden = false;
  const formulas = [...document.querySelectorAll(".formula")];
  const texts = formulas.map((one) => one.textContent.toLowerCase());
  find.addEventListener("input", () => {
    const words = find.value.toLowerCase().split(/\s+/).filter(Boolean);
    formulas.forEach((one, i) => { one.hidden = !words.every((word) => texts[i].includes(word)); });
    document.querySelectorAll(".topic").forEach((one) => { one.hidden = !one.querySelector(".formula:not([hidden])"); });
    document.querySelector("[data-none]").hidden = formulas.some((one) => !one.hidden);
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "/" && !event.target.matches("input, textarea, select")) { event.preventDefault(); find.focus(); }
  });
})();

// A field of lines: one that is finished - by Enter, by pasting, by leaving the field - is read back.
(() => {
  const told = new WeakMap();
  const tell = (event) => {
    const field = event.target;
    if (!field.matches?.("textarea[data-rows]") || told.get(field) === field.value) { return; }
    if (event.type === "input" && !/^(insertLineBreak|insertParagraph|insertFromPaste)$/.test(event.inputType)) { return; }
    told.set(field, field.value);
    field.dispatchEvent(new CustomEvent("quizgen:row"));
  };
  document.addEventListener("input", tell);
  document.addEventListener("change", tell);
})();

// Signs that the keyboard of a phone hides, put where the last field had its caret. Once there, they
// stay: whatever moved under a finger would not be pressed.
(() => {
  let last = null;
  document.addEventListener("pointerdown", (event) => { if (event.target.closest("[data-put]")) { event.preventDefault(); } });
  document.addEventListener("focusin", (event) => { if (event.target.matches("section.part input[type=text]")) {
    last = event.target;
    last.closest("section.part").querySelector(".signs")?.classList.add("shown");
  } });
  document.addEventListener("click", (event) => {
    const sign = event.target.closest("[data-put]");
    const field = document.getElementById(sign?.dataset.into) ?? (last?.isConnected ? last : document.querySelector("section.part input[type=text]:not([readonly])"));
    if (!sign || !field) { return; }
    const [from, to] = [field.selectionStart, field.selectionEnd];
    const [before, after] = sign.dataset.put.split("|");
    field.setRangeText(before + (after ? field.value.slice(from, to) + after : ""), from, to, "end");
    field.focus();
    const inside = from === to ? from + before.length : field.selectionEnd - after?.endsWith("()");
    if (after) { field.setSelectionRange(inside, inside); }
    field.dispatchEvent(new Event("input", { bubbles: true }));
  });
})();

// An exam: each change is kept in this browser first and sent to the server. While the server is
// away it is tried again. What the server has confirmed only this tab remembers, with when: a page
// that was read before, and comes after, shows it too.
(() => {
  const kinds = { unsent: () => localStorage, confirmed: () => sessionStorage };
  const handed = document.querySelector("[data-handed]");
  if (handed) {
    for (const kind of Object.values(kinds)) {
      try {
        const old = Object.keys(kind()).filter((name) => name.startsWith("quizgen/exam/" + handed.dataset.handed + "/"));
        old.forEach((name) => kind().removeItem(name));
      } catch { /* forbidden */ }
    }
  }
  const form = document.getElementById("exam");
  if (!form) { return; }
  const place = "quizgen/exam/" + form.dataset.exam + "/";
  const said = document.getElementById("kept");
  const store = (kind) => ({
    get(name) { try { return JSON.parse(kind().getItem(place + name)); } catch { return null; } },
    set(name, value) { try { kind().setItem(place + name, JSON.stringify(value)); } catch { /* full or forbidden */ } },
    drop(name) { try { kind().removeItem(place + name); } catch { /* forbidden */ } },
  });
  const unsent = store(kinds.unsent), confirmed = store(kinds.confirmed);
  const parts = [...form.querySelectorAll(PARTS)];
  // As ``practice/boxes.py`` says it: every box, but any place of an order.
  const complete = (part) => {
    const there = values(part).map((value) => value.trim() !== "");
    return part.querySelector("[data-order]") ? there.some(Boolean) : there.length > 0 && there.every(Boolean);
  };
  const marks = () => form.querySelectorAll("a[data-question]").forEach((link) => {
    const question = document.getElementById("question-" + link.dataset.question);
    const answered = [...question.querySelectorAll(PARTS)].every(complete);
    link.classList.toggle("answered", answered);
  });
  const states = () => form.querySelectorAll("a[data-question]").forEach((link) => {
    link.querySelector(".state").textContent = ["answered", "flagged"]
      .filter((name) => link.classList.contains(name)).map((name) => ", " + form.dataset[name]).join("");
  });
  const overview = () => { marks(); states(); };
  const waiting = new Set();
  // How long each question was on the screen; what a request has carried is taken off again.
  const spent = {};
  let since = performance.now(), looked = null;
  const look = (number) => {
    if (looked) { spent[looked] = (spent[looked] ?? 0) + (performance.now() - since) / 1000; }
    [since, looked] = [performance.now(), number];
  };
  let busy = null, later = 0, wait = 0;
  const soon = (after) => { clearTimeout(later); later = setTimeout(send, after); };
  const post = async (keepalive) => {
    const body = new URLSearchParams({ token: form.elements.token.value });
    const sent = new Map();
    look(looked);
    const times = Object.entries(spent).filter(([, seconds]) => seconds >= 0.1);
    times.forEach(([number, seconds]) => body.append("spent-" + number, seconds.toFixed(1)));
    for (const part of parts.filter((p) => waiting.has(p.dataset.part))) {
      const name = part.dataset.part, now = values(part);
      sent.set(name, JSON.stringify(now));
      body.append("on-" + name, "");
      now.forEach((value) => body.append("a-" + name, value));
    }
    try {
      const answer = await fetch(form.action, { method: "POST", body, keepalive, headers: { Accept: "application/json" } });
      if (answer.status === 409) { said.textContent = form.dataset.over; waiting.clear(); location.reload(); return false; }
      if (!answer.ok) { throw new Error(answer.status); }
      const { at } = await answer.json();
      times.forEach(([number, seconds]) => { spent[number] -= seconds; });
      for (const part of parts.filter((p) => sent.has(p.dataset.part))) {
        const name = part.dataset.part;
        form.elements["on-" + name].value = sent.get(name);
        confirmed.set(name, { at, text: sent.get(name) });
        if (sent.get(name) === JSON.stringify(values(part))) { waiting.delete(name); unsent.drop(name); }
      }
      wait = 0;
      said.textContent = waiting.size ? "" : form.dataset.saved;
      return true;
    } catch {
      wait = Math.min(30000, 1000 + wait * 2);
      said.textContent = form.dataset.away;
      return false;
    }
  };
  // One request at a time; a second call waits for the first and then sends what is left.
  const flush = async (keepalive = false) => {
    while (busy) { await busy; }
    busy = post(keepalive);
    try { return await busy; } finally { busy = null; if (waiting.size) { soon(wait || 300); } }
  };
  const send = () => { if (!busy && waiting.size) { flush(); } };
  // Typed before this ran, while the page was still coming.
  const already = (part) => {
    const plain = (all) => JSON.stringify(all.some(Boolean) ? all : []);
    return plain(values(part)) !== plain(JSON.parse(form.elements["on-" + part.dataset.part].value));
  };
  for (const part of parts) {
    const name = part.dataset.part, kept = unsent.get(name), last = confirmed.get(name);
    if (already(part)) { unsent.set(name, values(part)); waiting.add(name); }
    else if (Array.isArray(kept)) { fill(part, kept); waiting.add(name); }
    else if (last?.at > Number(form.dataset.read)) {
      fill(part, JSON.parse(last.text));
      form.elements["on-" + name].value = last.text;
    }
    part.addEventListener("input", () => {
      unsent.set(name, values(part));
      waiting.add(name);
      if (said.textContent === form.dataset.saved) { said.textContent = ""; }
      overview();
      soon(400);
    });
  }
  overview();
  soon(0);
  addEventListener("pagehide", () => { if (!leaving) { flush(true); } });
  document.addEventListener("visibilitychange", () => { look(document.hidden ? null : form.querySelector(".question.shown")?.id.slice("question-".length)); });
  addEventListener("online", () => soon(0));
  // One question on the screen: the one of the address, else the first.
  const questions = [...form.querySelectorAll(".question")];
  const turn = () => {
    if (!questions.length) { return; }
    const named = location.hash ? document.getElementById(decodeURIComponent(location.hash.slice(1))) : null;
    const shown = named?.closest(".question") ?? questions[0];
    questions.forEach((one) => one.classList.toggle("shown", one === shown));
    const before = looked;
    look(shown.id.slice("question-".length));
    if (before && before !== looked) { flush(); }
    form.querySelectorAll("a[data-question]").forEach((link) => {
      if (`question-${link.dataset.question}` === shown.id) { link.setAttribute("aria-current", "step"); } else { link.removeAttribute("aria-current"); }
    });
    if (named) { (named === shown ? form : named).scrollIntoView({ block: "start" }); }
  };
  form.querySelectorAll("[data-step]").forEach((step) => { step.hidden = false; });
  form.dataset.one = "";
  addEventListener("hashchange", turn);
  turn();
  // Nobody leaves this page for one of a server that is away.
  const flag = async (button) => {
    const body = new URLSearchParams({ token: form.elements.token.value });
    const answer = await fetch(button.formAction, { method: "POST", body }).catch(() => null);
    if (!answer?.ok) { said.textContent = form.dataset.away; return; }
    const on = button.getAttribute("aria-pressed") !== "true";
    button.setAttribute("aria-pressed", on);
    form.querySelector(`a[data-question="${button.dataset.flag}"]`).classList.toggle("flagged", on);
    states();
  };
  let leaving = false;
  form.addEventListener("submit", async (event) => {
    const button = event.submitter;
    if (leaving || !button) { return; }
    event.preventDefault();
    if (button.dataset.flag) { flag(button); return; }
    if (!(await flush()) || button.value === "save") { return; }
    leaving = true;
    form.requestSubmit(button);
  });
  const clock = form.querySelector("[data-left]");
  if (clock) {
    // One of the two clocks stands still while a computer sleeps, the other may be set.
    const given = 1000 * Number(clock.dataset.left), here = performance.now(), now = Date.now();
    const gone = () => Math.max(performance.now() - here, Date.now() - now);
    const tick = () => {
      const left = Math.max(0, given - gone());
      const last = left < 60000;
      clock.textContent = form.dataset[last ? "seconds" : "minutes"].replace("{}", Math.ceil(left / (last ? 1000 : 60000)));
      clock.classList.toggle("late", left < 300000);
      if (left > 0) { setTimeout(tick, last ? left % 1000 + 20 : Math.min(15000, left - 60000) + 50); return; }
      said.textContent = form.dataset.over;
      flush().then((kept) => { if (kept) { location.reload(); } else { setTimeout(tick, 3000); } });
    };
    tick();
  }
})();

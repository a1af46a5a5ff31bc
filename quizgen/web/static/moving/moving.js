// Figures that move: sliders, a drawing, values, a sentence. What each one draws is a module of its own, loaded when its fold is
// opened; what stands on the sliders, and every word, comes from the server. Without scripts the folds are not shown.

const FIGURES = {
  "aperture-ring": () => import("./aperture-ring.js"),
  "clamped-histogram": () => import("./clamped-histogram.js"),
  "distortion-grid": () => import("./distortion-grid.js"),
  "eye-and-filter": () => import("./eye-and-filter.js"),
  "focus-distance": () => import("./focus-distance.js"),
  "gaussian-tails": () => import("./gaussian-tails.js"),
  "hsv-sliders": () => import("./hsv-sliders.js"),
  "pinhole-point": () => import("./pinhole-point.js"),
};
const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const REST = 700; // ms without a change, after which the sentence is read out

class MovingFigure extends HTMLElement {
  connectedCallback() {
    const fold = this.closest("details");
    if (!fold || fold.open) { this.begin(); } else { fold.addEventListener("toggle", () => this.begin(), { once: true }); }
  }

  async begin() {
    if (this.values) { return; }
    this.start = JSON.parse(this.dataset.values);
    this.words = JSON.parse(this.dataset.words);
    this.values = { ...this.start };
    this.inputs = [...this.querySelectorAll("[data-set]")];
    const module = await FIGURES[this.dataset.figure]();
    const [wide, tall] = module.SIZE;
    this.svg = this.querySelector("svg");
    this.svg.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
    this.svg.innerHTML = module.picture(this.id, this);
    this.draw = () => { this.inputs.forEach((input) => this.name(input)); module.draw(this); };
    module.begin?.(this);
    this.addEventListener("input", (event) => this.take(event.target));
    // A slider takes its own keys, and Enter on it hands in nothing.
    this.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" && event.key !== "Tab") { event.stopPropagation(); }
      if (event.key === "Enter" && event.target.matches("input")) { event.preventDefault(); }
    });
    this.querySelector("[data-back]").addEventListener("click", () => {
      this.values = { ...this.start };
      this.inputs.forEach((input) => this.place(input));
      this.draw();
      this.announce();
    });
    this.inputs.forEach((input) => this.place(input)); // a browser may have kept where they stood
    this.draw();
    this.dataset.ready = "yes";
  }

  stops(input) { return input.dataset.stops?.split(" ").map(Number); }

  // What a slider stands at; until it is moved, a value may lie between two of its places.
  take(input) {
    const stops = this.stops(input);
    this.values[input.dataset.set] = input.type === "checkbox" ? input.checked : stops ? stops[input.value] : Number(input.value);
    this.draw();
    this.announce();
  }

  place(input) {
    const value = this.values[input.dataset.set], stops = this.stops(input);
    if (input.type === "checkbox") { input.checked = value; } else { input.value = stops ? stops.indexOf(value) : value; }
  }

  // Moves sliders to the places nearest to some values: a point was dragged.
  move(values) {
    for (const input of this.inputs.filter((one) => one.dataset.set in values)) {
      input.value = values[input.dataset.set];
      this.values[input.dataset.set] = Number(input.value);
    }
    this.draw();
    this.announce();
  }

  name(input) {
    if (input.type === "checkbox") { return; }
    const text = input.dataset.shown.replace("{}", this.number(this.values[input.dataset.set]));
    input.setAttribute("aria-valuetext", text);
    this.querySelector(`output[for="${input.id}"]`).textContent = text;
  }

  // A number with some significant digits, as people write it.
  number(value, digits = 4) {
    if (!Number.isFinite(value)) { return value > 0 ? "∞" : "−∞"; }
    const rounded = Number(value.toPrecision(digits));
    const written = (text) => text.replace("-", "−").replace(".", this.dataset.decimal);
    if (rounded !== 0 && (Math.abs(rounded) < 1e-4 || Math.abs(rounded) >= 1e7)) {
      const [front, power] = rounded.toExponential().split("e");
      const raised = [...String(Math.abs(power))].map((digit) => RAISED[digit]).join("");
      return `${written(front)} × 10${power < 0 ? "⁻" : ""}${raised}`;
    }
    const text = written(String(rounded));
    const [whole, rest] = text.split(this.dataset.decimal);
    const grouped = Math.abs(rounded) < 1e4 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u202f");
    return rest === undefined ? grouped : grouped + this.dataset.decimal + rest;
  }

  // A factor: 9, or 1/9 where it is below 1.
  factor(value) { return value < 1 ? `1/${this.number(1 / value, 3)}` : this.number(value, 3); }

  show(name, text) { this.querySelector(`[data-out="${name}"]`).textContent = text; }

  set(part, attributes) {
    const element = this.svg.querySelector(`[data-part="${part}"]`);
    for (const [name, value] of Object.entries(attributes)) {
      if (name === "text") { element.textContent = value; } else { element.setAttribute(name, value); }
    }
  }

  // Sentences by their names, with their blanks filled in.
  say(names, values = {}) {
    const text = names.map((name) => this.words[name].replace(/\{(\w+)\}/g, (_, blank) => values[blank])).join(" ");
    this.querySelector(".moving-said").textContent = text;
  }

  announce() {
    clearTimeout(this.later);
    this.later = setTimeout(() => {
      this.querySelector("[role=status]").textContent = this.querySelector(".moving-said").textContent;
    }, REST);
  }
}

customElements.define("moving-figure", MovingFigure);

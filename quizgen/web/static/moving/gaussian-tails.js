// The normal density, and its share beyond k standard deviations.
// Source: Abramowitz & Stegun, Handbook of Mathematical Functions (1964), 7.1.5, 7.1.14 and 26.2.1.

import { path, row } from "./lines.js";

export const SIZE = [320, 180];
const [FLOOR, TALL, WIDE] = [156, 140, 16]; // the axis, the height of the density of sigma = 1, and where the axis ends

// 1 - erf(x) for x >= 0: a series where it is small, a continued fraction where the series would cancel.
export const erfc = (x) => {
  if (x < 2) {
    let term = x, sum = x;
    for (let n = 1; Math.abs(term) > 1e-17 * sum; n += 1) { term *= -x * x / n; sum += term / (2 * n + 1); }
    return 1 - 2 / Math.sqrt(Math.PI) * sum;
  }
  let fraction = 0;
  for (let n = 60; n > 0; n -= 1) { fraction = n / 2 / (x + fraction); }
  return Math.exp(-x * x) / Math.sqrt(Math.PI) / (x + fraction);
};

const across = (n, unit) => 160 + 150 * n / (WIDE * unit);

export const picture = () => `<rect class="m-paper" width="320" height="180"/><path class="m-fill-accent" data-part="tails"/>
  <path class="m-fill" data-part="inside"/><path class="m-line" data-part="curve"/><path class="m-axis" d="M0 ${FLOOR}H320"/>
  <path class="m-dashed" data-part="bounds"/><text data-part="left" y="170"/><text x="160" y="170">0</text><text data-part="right" y="170"/>`;

export const draw = (figure) => {
  const { sigma, k, M, scale: unit } = figure.values;
  const height = (n) => FLOOR - TALL * unit / sigma * Math.exp(-n * n / (2 * sigma * sigma));
  const under = (from, to) => from < to
    ? `${path([[across(from, unit), FLOOR], ...row(from, to, 60).map((n) => [across(n, unit), height(n)]), [across(to, unit), FLOOR]])}z` : "";
  const edge = WIDE * unit * 1.07, bound = Math.min(k * sigma, edge);
  figure.set("inside", { d: under(-bound, bound) });
  figure.set("tails", { d: under(-edge, -bound) + under(bound, edge) });
  figure.set("curve", { d: path(row(-edge, edge, 160).map((n) => [across(n, unit), height(n)])) });
  figure.set("bounds", { d: [-bound, bound].map((n) => path([[across(n, unit), 8], [across(n, unit), FLOOR]])).join("") });
  // Near 0 its own number stands there.
  const apart = across(bound, unit) - 160 > 26 && bound < edge;
  figure.set("left", { x: across(-bound, unit), text: apart ? figure.number(-k * sigma) : "" });
  figure.set("right", { x: across(bound, unit), text: apart ? figure.number(k * sigma) : "" });
  const outside = erfc(k / Math.SQRT2);
  figure.show("peak", figure.number(1 / (Math.sqrt(2 * Math.PI) * sigma)));
  figure.show("inside", `${figure.number(100 * (1 - outside), 6)}\u00a0%`);
  figure.show("outside", `${figure.number(100 * outside)}\u00a0%`);
  figure.show("side", `${figure.number(50 * outside)}\u00a0%`);
  figure.show("pixels", figure.number(1e6 * M * outside));
  figure.say(["said"], {
    bound: figure.number(k * sigma), k: figure.number(k), outside: figure.number(100 * outside),
    pixels: figure.number(1e6 * M * outside), all: figure.number(M),
  });
};

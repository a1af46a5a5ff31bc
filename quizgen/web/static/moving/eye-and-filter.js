// How bright light of each wavelength looks by day, and what a filter leaves of it.
// Source: CIE 018:2019, The Basis of Physical Photometry (V of 1924, linear between table points).

import { path, row } from "./moving.js";

export const SIZE = [320, 190];
const [FIRST, LAST, APART] = [380, 780, 5]; // nm
const V = [
  3.9e-05, 6.4e-05, 0.00012, 0.000217, 0.000396, 0.00064, 0.00121, 0.00218, 0.004, 0.0073, 0.0116, 0.01684, 0.023, 0.0298,
  0.038, 0.048, 0.06, 0.0739, 0.09098, 0.1126, 0.13902, 0.1693, 0.20802, 0.2586, 0.323, 0.4073, 0.503, 0.6082,
  0.71, 0.7932, 0.862, 0.9148501, 0.954, 0.9803, 0.9949501, 1.0, 0.995, 0.9786, 0.952, 0.9154, 0.87, 0.8163,
  0.757, 0.6949, 0.631, 0.5668, 0.503, 0.4412, 0.381, 0.321, 0.265, 0.217, 0.175, 0.1382, 0.107, 0.0816,
  0.061, 0.04458, 0.032, 0.0232, 0.017, 0.01192, 0.00821, 0.005723, 0.004102, 0.002929, 0.002091, 0.001484, 0.001047, 0.00074,
  0.00052, 0.0003611, 0.0002492, 0.0001719, 0.00012, 8.48e-05, 6e-05, 4.24e-05, 3e-05, 2.12e-05, 1.499e-05];
const LUMENS = 683; // for each watt at 555 nm
const [FLOOR, TALL] = [160, 140];

export const efficiency = (nm) => {
  if (nm < FIRST || nm > LAST) { return 0; }
  const i = Math.min(V.length - 2, Math.floor((nm - FIRST) / APART)), t = (nm - FIRST) / APART - i;
  return V[i] * (1 - t) + V[i + 1] * t;
};

// The area under the curve up to a wavelength: exact, as it is made of straight pieces.
const area = (nm) => {
  const end = Math.min(LAST, Math.max(FIRST, nm)), i = Math.min(V.length - 2, Math.floor((end - FIRST) / APART));
  const before = V.slice(0, i + 1).reduce((sum, v) => sum + v * APART, 0) - APART * (V[0] + V[i]) / 2;
  return before + (end - FIRST - APART * i) * (V[i] + efficiency(end)) / 2;
};
const within = (from, to) => area(to) - area(from);

const across = (nm) => 10 + 300 * (nm - FIRST) / (LAST - FIRST);
const curve = (from, to, count) => row(from, to, count).map((nm) => [across(nm), FLOOR - TALL * efficiency(nm)]);
const HUES = [[380, 270], [400, 270], [460, 240], [490, 180], [530, 120], [580, 60], [640, 0], [780, 0]];
const hue = (nm) => {
  const i = HUES.findIndex(([end]) => nm <= end), [[a, from], [b, to]] = [HUES[Math.max(0, i - 1)], HUES[i]];
  return a === b ? from : from + (to - from) * (nm - a) / (b - a);
};

export const picture = () => `<rect class="m-paper" width="320" height="190"/>
  ${row(FIRST, LAST - 8, 49).map((nm) => `<rect x="${across(nm)}" y="${FLOOR}" width="6.1" height="7" fill="hsl(${Math.round(hue(nm))} 100% 50%)"/>`).join("")}
  <path class="m-shade" data-part="band"/><path class="m-fill-blue" data-part="through"/><path class="m-line" d="${path(curve(FIRST, LAST, 160))}"/>
  <path class="m-accent" data-part="middle"/><circle class="m-dot" data-part="dot" r="4"/>
  ${[400, 450, 500, 550, 600, 650, 700, 750].map((nm) => `<text x="${across(nm)}" y="179">${nm}</text>`).join("")}<text class="m-end" x="318" y="189">nm</text>`;

export const draw = (figure) => {
  const { lambda, width } = figure.values;
  const from = Math.max(FIRST, lambda - width / 2), to = Math.min(LAST, lambda + width / 2), there = efficiency(lambda);
  figure.set("band", { d: `M${across(from)} ${FLOOR - TALL}H${across(to)}V${FLOOR}H${across(from)}z` });
  figure.set("through", { d: `${path([[across(from), FLOOR], ...curve(from, to, 80), [across(to), FLOOR]])}z` });
  figure.set("middle", { d: path([[across(lambda), FLOOR], [across(lambda), FLOOR - TALL * there]]) });
  figure.set("dot", { cx: across(lambda), cy: FLOOR - TALL * there });
  const power = 100 * (to - from) / (LAST - FIRST), bright = 100 * within(from, to) / within(FIRST, LAST);
  figure.show("efficiency", figure.number(there));
  figure.show("lumens", `${figure.number(LUMENS * there)}\u00a0lm`);
  figure.show("power", `${figure.number(power)}\u00a0%`);
  figure.show("brightness", `${figure.number(bright)}\u00a0%`);
  figure.say(["said_line", ...(width > 0 ? ["said_filter"] : [])], {
    lambda: figure.number(lambda), lumens: figure.number(LUMENS * there), times: figure.number(1 / there, 3), power: figure.number(power), bright: figure.number(bright),
  });
};

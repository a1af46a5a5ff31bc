// How bright light of each wavelength looks, by day and in the dark, and what a filter leaves of it.
// Source: CIE 018:2019, The Basis of Physical Photometry (V of 1924, V' of 1951, linear between table points).

import { path, row } from "./lines.js";

export const SIZE = [320, 190];
const [FIRST, LAST, APART] = [380, 780, 5]; // nm
// Values every 5 nm, the peak, and lumens for each watt there. The peak of the dark lies between two values.
const EYES = {
  day: { peak: 555, lumens: 683, values: [
    3.9e-05, 6.4e-05, 0.00012, 0.000217, 0.000396, 0.00064, 0.00121, 0.00218, 0.004, 0.0073, 0.0116, 0.01684, 0.023, 0.0298,
    0.038, 0.048, 0.06, 0.0739, 0.09098, 0.1126, 0.13902, 0.1693, 0.20802, 0.2586, 0.323, 0.4073, 0.503, 0.6082,
    0.71, 0.7932, 0.862, 0.9148501, 0.954, 0.9803, 0.9949501, 1.0, 0.995, 0.9786, 0.952, 0.9154, 0.87, 0.8163,
    0.757, 0.6949, 0.631, 0.5668, 0.503, 0.4412, 0.381, 0.321, 0.265, 0.217, 0.175, 0.1382, 0.107, 0.0816,
    0.061, 0.04458, 0.032, 0.0232, 0.017, 0.01192, 0.00821, 0.005723, 0.004102, 0.002929, 0.002091, 0.001484, 0.001047, 0.00074,
    0.00052, 0.0003611, 0.0002492, 0.0001719, 0.00012, 8.48e-05, 6e-05, 4.24e-05, 3e-05, 2.12e-05, 1.499e-05] },
  night: { peak: 507, lumens: 1700, values: [
    0.000589, 0.001108, 0.002209, 0.00453, 0.00929, 0.01852, 0.03484, 0.0604, 0.0966, 0.1436, 0.1998, 0.2625, 0.3281, 0.3931,
    0.455, 0.513, 0.567, 0.62, 0.676, 0.734, 0.793, 0.851, 0.904, 0.949, 0.982, 0.998, 0.997, 0.975,
    0.935, 0.88, 0.811, 0.733, 0.65, 0.564, 0.481, 0.402, 0.3288, 0.2639, 0.2076, 0.1602, 0.1212, 0.0899,
    0.0655, 0.0469, 0.03315, 0.02312, 0.01593, 0.01088, 0.00737, 0.00497, 0.003335, 0.002235, 0.001497, 0.001005, 0.000677, 0.000459,
    0.0003129, 0.0002146, 0.000148, 0.0001026, 7.15e-05, 5.01e-05, 3.533e-05, 2.501e-05, 1.78e-05, 1.273e-05, 9.14e-06, 6.6e-06, 4.78e-06, 3.482e-06,
    2.546e-06, 1.87e-06, 1.379e-06, 1.022e-06, 7.6e-07, 5.67e-07, 4.25e-07, 3.196e-07, 2.413e-07, 1.829e-07, 1.39e-07] },
};
const FLOOR = 160, TALL = 140;

// Corners of a curve, which is straight between them.
const corners = ({ peak, values }) => values.map((value, i) => [FIRST + APART * i, value])
  .concat(peak % APART ? [[peak, 1]] : []).sort(([a], [b]) => a - b);
const CURVES = Object.fromEntries(Object.entries(EYES).map(([name, eye]) => [name, corners(eye)]));

export const efficiency = (nm, eye = "day") => {
  const curve = CURVES[eye], i = curve.findIndex(([end]) => nm <= end);
  if (nm < FIRST || i < 0) { return 0; }
  const [[a, low], [b, high]] = [curve[Math.max(0, i - 1)], curve[i]];
  return a === b ? low : (low * (b - nm) + high * (nm - a)) / (b - a);
};

// The part of a curve between two wavelengths, and the area under it: exact, as it is made of straight pieces.
const between = (from, to, eye) => [[from, efficiency(from, eye)], ...CURVES[eye].filter(([nm]) => nm > from && nm < to), [to, efficiency(to, eye)]];
const area = (points) => points.slice(1).reduce((sum, [nm, high], i) => sum + (nm - points[i][0]) * (high + points[i][1]) / 2, 0);

const across = (nm) => 10 + 300 * (nm - FIRST) / (LAST - FIRST);
const drawn = (points) => points.map(([nm, height]) => [across(nm), FLOOR - TALL * height]);
const HUES = [[380, 270], [400, 270], [460, 240], [490, 180], [530, 120], [580, 60], [640, 0], [780, 0]];
const hue = (nm) => {
  const i = HUES.findIndex(([end]) => nm <= end), [[a, from], [b, to]] = [HUES[Math.max(0, i - 1)], HUES[i]];
  return a === b ? from : from + (to - from) * (nm - a) / (b - a);
};

export const picture = () => `<rect class="m-paper" width="320" height="190"/>
  ${row(FIRST, LAST - 8, 49).map((nm) => `<rect x="${across(nm)}" y="${FLOOR}" width="6.1" height="7" fill="hsl(${Math.round(hue(nm))} 100% 50%)"/>`).join("")}
  <path class="m-shade" data-part="band"/><path class="m-fill-blue" data-part="through"/><g data-part="day"><path class="m-line" d="${path(drawn(CURVES.day))}"/><text x="${across(616)}" y="72">V</text></g>
  <g data-part="night"><path class="m-blue m-dashes" d="${path(drawn(CURVES.night))}"/><text x="${across(448)}" y="72">V′</text></g>
  <path class="m-accent" data-part="middle"/><circle class="m-dot" data-part="dot" r="4"/>
  ${[400, 450, 500, 550, 600, 650, 700, 750].map((nm) => `<text x="${across(nm)}" y="179">${nm}</text>`).join("")}<text class="m-end" x="318" y="189">nm</text>`;

export const draw = (figure) => {
  const { lambda, width, night } = figure.values, eye = night ? "night" : "day";
  const from = Math.max(FIRST, lambda - width / 2), to = Math.min(LAST, lambda + width / 2), there = efficiency(lambda, eye);
  const part = between(from, to, eye);
  for (const name of Object.keys(EYES)) { figure.set(name, { opacity: name === eye ? 1 : 0.4 }); }
  figure.set("band", { d: `M${across(from)} ${FLOOR - TALL}H${across(to)}V${FLOOR}H${across(from)}z` });
  figure.set("through", { d: `${path([[across(from), FLOOR], ...drawn(part), [across(to), FLOOR]])}z` });
  figure.set("middle", { d: path([[across(lambda), FLOOR], [across(lambda), FLOOR - TALL * there]]) });
  figure.set("dot", { cx: across(lambda), cy: FLOOR - TALL * there });
  const power = 100 * (to - from) / (LAST - FIRST), bright = 100 * area(part) / area(CURVES[eye]), lumens = EYES[eye].lumens * there;
  figure.show("efficiency", figure.number(there));
  figure.show("lumens", `${figure.number(lumens)}\u00a0lm`);
  figure.show("power", `${figure.number(power)}\u00a0%`);
  figure.show("brightness", `${figure.number(bright)}\u00a0%`);
  figure.say([`said_${eye}`, ...(width > 0 ? ["said_filter"] : [])], {
    lambda: figure.number(lambda), lumens: figure.number(lumens), times: figure.number(1 / there, 3), power: figure.number(power), bright: figure.number(bright),
  });
};

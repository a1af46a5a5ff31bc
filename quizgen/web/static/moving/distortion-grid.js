// A square grid through a lens with two radial coefficients, and one point of it.
// Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), section 7.4, eq. 7.12.

import { path, row } from "./lines.js";

export const SIZE = [240, 240];
const MIDDLE = 120, SCALE = 72;

const at = ([x, y]) => [MIDDLE + SCALE * x, MIDDLE - SCALE * y];
const grid = (bend) => row(-1, 1, 8).flatMap((line) => [row(-1, 1, 40).map((t) => [line, t]), row(-1, 1, 40).map((t) => [t, line])])
  .map((points) => path(points.map((point) => at(bend(point))))).join("");

export const picture = () => `<rect class="m-paper" width="240" height="240"/><path class="m-faint" d="${grid((point) => point)}"/>
  <path class="m-line" data-part="grid"/><circle class="m-ring-of" data-part="before" r="4"/>
  <path class="m-accent" data-part="way"/><circle class="m-dot" data-part="after" r="4"/>`;

export const shift = (k1, k2, square) => k1 * square + k2 * square ** 2;

// The smallest radius at which the picture turns back, where there is one.
export const fold = (k1, k2) => {
  const root = 9 * k1 * k1 - 20 * k2;
  const squares = k2 === 0 ? [-1 / (3 * k1)] : root < 0 ? [] : [-1, 1].map((sign) => (-3 * k1 + sign * Math.sqrt(root)) / (10 * k2));
  return Math.sqrt(Math.min(...squares.filter((square) => square > 0)));
};

export const draw = (figure) => {
  const { k_1: k1, k_2: k2, x, y } = figure.values;
  const bend = ([u, v]) => { const factor = 1 + shift(k1, k2, u * u + v * v); return [u * factor, v * factor]; };
  figure.set("grid", { d: grid(bend) });
  const [from, to] = [at([x, y]), at(bend([x, y]))];
  figure.set("before", { cx: from[0], cy: from[1] });
  figure.set("after", { cx: to[0], cy: to[1] });
  figure.set("way", { d: path([from, to]) });
  const told = (point) => `(${point.map((one) => figure.number(one)).join("; ")})`;
  const share = shift(k1, k2, x * x + y * y), turn = fold(k1, k2);
  figure.show("from", told([x, y]));
  figure.show("to", told(bend([x, y])));
  figure.show("factor", figure.number(1 + share));
  figure.show("share", `${figure.number(100 * share)}\u00a0%`);
  const names = [share === 0 ? "said_still" : share < 0 ? "said_inwards" : "said_outwards"];
  if (turn <= Math.SQRT2) { names.push("said_folds"); }
  figure.say(names, { factor: figure.number(1 + share), share: figure.number(Math.abs(100 * share)), radius: figure.number(turn) });
};

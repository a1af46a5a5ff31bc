// Hue, saturation and value of one colour; the whole picture is edited in the same way.
// Source: A. R. Smith, "Color gamut transform pairs", SIGGRAPH 1978.

import { BALLOON, scene } from "./scene.js";

export const SIZE = [240, 140];
const LEAST = 0.01;
export const picture = scene;

export const toHsv = ([r, g, b]) => {
  const top = Math.max(r, g, b), spread = top - Math.min(r, g, b);
  if (spread === 0) { return [0, 0, top]; }
  const sector = top === r ? (g - b) / spread : top === g ? 2 + (b - r) / spread : 4 + (r - g) / spread;
  return [60 * (sector < 0 ? sector + 6 : sector), spread / top, top];
};

export const toRgb = ([hue, saturation, value]) => {
  const chroma = value * saturation, sector = (hue % 360 + 360) % 360 / 60;
  const second = chroma * (1 - Math.abs(sector % 2 - 1)), floor = value - chroma;
  const turn = [[chroma, second, 0], [second, chroma, 0], [0, chroma, second], [0, second, chroma], [second, 0, chroma], [chroma, 0, second]];
  return turn[Math.floor(sector)].map((channel) => channel + floor);
};

const read = (code) => [1, 3, 5].map((at) => parseInt(code.slice(at, at + 2), 16) / 255);
const write = (rgb) => "#" + rgb.map((channel) => Math.round(255 * channel).toString(16).padStart(2, "0")).join("");

// Everything in the picture that has a colour; the balloon has that of the sliders.
export const begin = (figure) => {
  const own = toRgb([figure.start.H, figure.start.S, figure.start.V]);
  figure.paints = ["fill", "stroke", "stop-color"].flatMap((name) =>
    [...figure.svg.querySelectorAll(`[${name}^="#"]`)].map((element) => {
      const code = element.getAttribute(name);
      return { element, name, from: toHsv(code === BALLOON ? own : read(code)) };
    }));
};

export const draw = (figure) => {
  const { H, S, V } = figure.values, from = figure.start;
  // A grey or a black has no share to keep of another colour's saturation or value.
  const share = (now, before) => before < LEAST ? 1 : now / before;
  const turn = H - from.H, saturation = share(S, from.S), value = share(V, from.V);
  for (const { element, name, from: [hue, s, v] } of figure.paints) {
    element.setAttribute(name, write(toRgb([hue + turn, Math.min(1, s * saturation), Math.min(1, v * value)])));
  }
  const told = (rgb) => `(${rgb.map((channel) => figure.number(channel, 3)).join("; ")})`;
  const [before, now] = [told(toRgb([from.H, from.S, from.V])), told(toRgb([H, S, V]))];
  figure.show("before", before);
  figure.show("now", now);
  const names = [now === before && !turn ? "said_same" : Math.min(from.S, from.V) < LEAST ? "said_plain" : "said_changed"];
  if (V === 0) { names.push("said_black"); } else if (S === 0) { names.push("said_grey"); }
  figure.say(names, {
    turn: figure.number(turn), saturation: figure.factor(saturation), value: figure.factor(value), before, now,
  });
};

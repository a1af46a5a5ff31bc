// The distance of focus, and from where to where it looks sharp.
// Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22; thin lens, exact.

import { sceneByDepth } from "./scene.js";

export const SIZE = [240, 190];
const DEPTHS = { near: 1.5, middle: 4, far: 100 }; // m, of flowers, house and hills
const [FIRST, LAST] = [0.5, 200]; // m, on the scale
const PIXELS = 240 / 36; // of the drawing for each mm on the sensor
const LARGER = 4; // times, of the blur drawn

const place = (metres) => 8 + 224 * Math.log(Math.min(LAST, Math.max(FIRST, metres)) / FIRST) / Math.log(LAST / FIRST);

export const picture = (id, figure) => `${sceneByDepth(id)}
  <rect class="shade" x="8" y="152" width="224" height="14"/><rect class="sharp" data-part="sharp" y="152" height="14"/>
  ${Object.values(DEPTHS).map((metres) => `<path class="tick-ink" d="M${place(metres)} 142v10"/>`).join("")}
  ${[0.5, 1, 2, 5, 10, 20, 50, 100].map((metres) => `<path class="axis" d="M${place(metres)} 166v3"/><text x="${place(metres)}" y="178">${figure.number(metres)}</text>`).join("")}
  <text x="232" y="178">∞</text><text class="end" x="232" y="188">m</text><path class="accent" data-part="focus"/>`;

// All in mm: the diameter of the blur disc of a point at a distance.
export const disc = (f, N, focus, distance) => {
  const image = (z) => f * z / (z - f);
  return f / N * Math.abs(image(focus) - image(distance)) / image(distance);
};

export const limits = (f, N, c, focus) => {
  const hyperfocal = f * f / (N * c) + f, reach = focus * (hyperfocal - f);
  return [hyperfocal, reach / (hyperfocal + focus - 2 * f), focus < hyperfocal ? reach / (hyperfocal - focus) : Infinity];
};

export const draw = (figure) => {
  const { f, N, s, c } = figure.values;
  const [hyperfocal, near, far] = limits(f, N, c / 1000, 1000 * s).map((length) => length / 1000);
  for (const [name, metres] of Object.entries(DEPTHS)) {
    figure.set(name, { stdDeviation: (LARGER / 4 * PIXELS * disc(f, N, 1000 * s, 1000 * metres)).toFixed(2) });
  }
  figure.set("sharp", { x: place(near), width: place(far) - place(near) });
  figure.set("focus", { d: `M${place(s)} 148v22` });
  const metres = (length) => `${figure.number(length)} m`;
  figure.show("hyperfocal", metres(hyperfocal));
  figure.show("near", metres(near));
  figure.show("far", metres(far));
  figure.show("depth", metres(far - near));
  figure.say([Number.isFinite(far) ? "said_between" : "said_endless"], {
    near: figure.number(near), far: figure.number(far), front: figure.number(s - near), rear: figure.number(far - s),
    hyperfocal: figure.number(hyperfocal),
  });
};

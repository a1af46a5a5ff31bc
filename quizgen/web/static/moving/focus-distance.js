// The distance of focus, and from where to where it looks sharp.
// Source: S. J. Ray, Applied Photographic Optics, 3rd ed. (2002), chapter 22; thin lens, exact.

import { sceneByDepth } from "./scene.js";

export const SIZE = [240, 192];
const DEPTHS = { near: 1.5, middle: 4, far: 100 }; // m, of flowers, house and hills
const SIGNS = { // on the scale
  near: '<circle cy="-4" r="3.5" fill="#f26b1d"/><circle cy="-4" r="1.4" fill="#f5cf36"/>',
  middle: '<path d="M-4 0v-5h8v5z" fill="#d6c8b4"/><path d="M-6 -5l6 -5 6 5z" fill="#cc3525"/>',
  far: '<path d="M-9 0c4 -9 8 -9 11 -2c2 -4 4 -4 7 2z" fill="#518c6f"/>',
};
const [FIRST, LAST] = [0.5, 200]; // m, on the scale
const PIXELS = 240 / 36; // of the drawing for each mm on the sensor
const LARGER = 4; // times, of the blur drawn

const place = (metres) => 8 + 224 * Math.log(Math.min(LAST, Math.max(FIRST, metres)) / FIRST) / Math.log(LAST / FIRST);

export const picture = (id, figure) => `${sceneByDepth(id)}
  <rect class="m-shade" x="8" y="152" width="224" height="14"/><rect class="m-sharp" data-part="sharp" y="152" height="14"/>
  ${Object.entries(SIGNS).map(([name, sign]) => `<g transform="translate(${place(DEPTHS[name])} 151)">${sign}</g>`).join("")}
  ${[0.5, 1, 2, 5, 10, 20, 50, 100].map((metres) => `<path class="m-axis" d="M${place(metres)} 166v3"/><text x="${place(metres)}" y="178">${figure.number(metres)}</text>`).join("")}
  <text x="232" y="178">∞</text><text x="120" y="189">m</text><path class="m-accent" data-part="focus"/>`;

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
  const metres = (length) => `${figure.number(length)}\u00a0m`;
  figure.show("hyperfocal", metres(hyperfocal));
  figure.show("near", metres(near));
  figure.show("far", metres(far));
  figure.show("depth", metres(far - near));
  figure.say([Number.isFinite(far) ? "said_between" : "said_endless"], {
    near: figure.number(near), far: figure.number(far), front: figure.number(s - near), rear: figure.number(far - s),
    hyperfocal: figure.number(hyperfocal),
  });
};

// The ring of the aperture: hole, light, exposure time and blur discs together.
// Source: Hecht, Optics, 5th ed. (2017), section 5.3.3.

import { sceneByDepth } from "./scene.js";

export const SIZE = [240, 174];
const APART = 40; // of the numbers on the ring
const BLADES = [[16.24, 5.02, -354, 381], [6.2, 15.83, -519, -39], [-8.51, 14.72, -293, -430], [-16.81, 2.52, 154, -497],
  [-12.45, -11.57, 485, -190], [1.28, -16.95, 451, 261], [14.05, -9.57, 77, 515]];

export const picture = (id, figure) => {
  const stops = figure.stops(figure.inputs.find((one) => one.dataset.set === "N"));
  const numbers = stops.map((stop, i) => `<text class="m-engraved" x="${i * APART}" y="20">${figure.number(stop)}</text><path class="m-tick" d="M${i * APART} 1v5"/>`);
  return `${sceneByDepth(id)}
  <svg x="190" y="5" width="45" height="45" viewBox="-24 -24 48 48"><clipPath id="${id}-rim"><circle r="20"/></clipPath>
    <circle class="m-barrel" r="22"/><circle class="m-blade" r="20"/><g clip-path="url(#${id}-rim)"><g data-part="hole">
    ${BLADES.map(([x, y, dx, dy]) => `<path class="m-edge" d="M${x} ${y}l${dx} ${dy}"/>`).join("")}
    <polygon class="m-mark" points="${BLADES.map(([x, y]) => `${x},${y}`).join(" ")}"/></g></g></svg>
  <svg y="144" width="240" height="30" viewBox="0 0 240 30"><rect class="m-barrel" width="240" height="30" rx="5"/>
    <g data-part="ring">${numbers.join("")}</g><path class="m-mark" d="M116 30l4-6 4 6z"/></svg>`;
};

const seconds = (figure, time) => `${time < 0.4 ? `1/${figure.number(1 / time, 3)}` : figure.number(time, 3)}\u00a0s`;

export const draw = (figure) => {
  const { N, N_1: before, f, r, keep } = figure.values;
  const hole = before / N, light = hole ** 2, time = 1 / r;
  const stops = figure.stops(figure.inputs.find((one) => one.dataset.set === "N"));
  figure.set("ring", { transform: `translate(${120 - APART * stops.indexOf(N)})` });
  figure.set("hole", { transform: `scale(${(1.54 / N).toFixed(3)})` });
  figure.set("far", { stdDeviation: (5 / N).toFixed(2) });
  figure.set("near", { stdDeviation: (4 / N).toFixed(2) });
  // Light is linear, screens are not.
  const shown = keep ? 1 : Math.min(2.5, light ** (1 / 2.2));
  figure.svg.querySelector("[data-part=scene]").style.filter = shown === 1 ? "" : `brightness(${shown.toFixed(3)})`;
  figure.show("hole", `${figure.number(f / N)}\u00a0mm`);
  figure.show("light", figure.factor(light));
  figure.show("time", seconds(figure, keep ? time / light : time));
  figure.show("blur", figure.factor(hole));
  const turned = Math.log2(light), whole = Math.round(turned);
  figure.show("stops", figure.number(turned, 3));
  const way = hole === 1 ? "said_same" : hole > 1 ? "said_wider" : "said_narrower";
  const names = hole === 1 ? [way] : [way, keep ? "said_kept" : light > 1 ? "said_brighter" : "said_darker"];
  if (whole && turned !== whole && Math.abs(turned - whole) < 0.1) { names.push("said_rounded"); }
  figure.say(names, {
    before: figure.number(before), now: figure.number(N), hole: figure.factor(hole), light: figure.factor(light),
    time: figure.factor(1 / light), exact: figure.factor(2 ** whole),
  });
};

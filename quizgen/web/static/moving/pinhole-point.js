// A point and its image through a pinhole, seen from the side. The point can be dragged.
// Source: Hartley & Zisserman, Multiple View Geometry, 2nd ed. (2004), eq. 6.1.

import { path } from "./lines.js";

export const SIZE = [320, 210];
const [ORIGIN, AXIS, DEEP, HIGH] = [112, 105, 16, 6]; // where the pinhole is, and a unit of depth and of height

const at = (z, y = 0) => [ORIGIN + DEEP * z, AXIS - HIGH * y];

export const picture = () => `<rect class="m-paper" width="320" height="210"/>
  <path class="m-axis" d="M0 ${AXIS}H320"/><text class="m-end" x="317" y="${AXIS + 12}">z</text>
  <path class="m-line" d="M${ORIGIN} 0V${AXIS - 3}M${ORIGIN} ${AXIS + 3}V210"/>
  <path class="m-faint" data-part="behind"/><path class="m-blue" data-part="plane"/>
  <path class="m-ray" data-part="ray"/><path class="m-accent" data-part="image"/><path class="m-dashed" data-part="turned"/>
  <path class="m-line" data-part="height"/><circle class="m-dot" data-part="point" r="5"/>
  <text data-part="named">p</text><text data-part="named-image">p′</text><text data-part="named-plane" y="206">f</text><text data-part="named-behind" y="206">−f</text><circle class="m-target" data-part="target" r="16"/>`;

export const begin = (figure) => {
  const drag = (event) => {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(figure.svg.getScreenCTM().inverse());
    figure.move({ p_z: (x - ORIGIN) / DEEP, p_y: (AXIS - y) / HIGH });
  };
  const target = figure.svg.querySelector("[data-part=target]");
  target.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    target.setPointerCapture(event.pointerId);
    target.onpointermove = drag;
  });
  target.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false }); // else the page scrolls
  for (const end of ["pointerup", "pointercancel"]) { target.addEventListener(end, () => { target.onpointermove = null; }); }
};

export const draw = (figure) => {
  const { f, p_y: y, p_z: z } = figure.values;
  const image = z === 0 ? NaN : f * y / z, seen = z > 0;
  const [x0, y0] = at(z, y);
  for (const name of ["point", "target"]) { figure.set(name, { cx: x0, cy: y0 }); }
  figure.set("height", { d: path([at(z, 0), at(z, y)]) });
  figure.set("plane", { d: path([at(f, -15), at(f, 17)]) });
  figure.set("behind", { d: path([at(-f, -15), at(-f, 17)]) });
  figure.set("ray", { d: seen ? path([at(z, y), at(-f, -image)]) : "" });
  figure.set("image", { d: seen ? path([at(f, 0), at(f, image)]) : "" });
  figure.set("turned", { d: seen ? path([at(-f, 0), at(-f, -image)]) : "" });
  figure.set("named", { x: x0, y: y0 + (y < 0 ? 18 : -10) });
  const [x1, y1] = at(f, Math.abs(image) < 17 ? image : 0);
  figure.set("named-image", { x: x1 + 9, y: y1 + (image < 0 ? -5 : 12), text: seen && z !== f ? "p′" : "" });
  figure.set("named-plane", { x: at(f)[0] });
  figure.set("named-behind", { x: at(-f)[0] });
  const told = (value) => Number.isNaN(value) ? "–" : figure.number(value);
  figure.show("ratio", told(z === 0 ? NaN : f / z));
  figure.show("image", told(image));
  figure.show("turned", told(-image));
  const name = seen ? (y === 0 ? "said_on_axis" : z === f ? "said_in_plane" : "said_seen") : z === 0 ? "said_level" : "said_behind";
  figure.say([name], { y: told(y), z: told(z), f: told(f), image: told(image), turned: told(-image) });
};

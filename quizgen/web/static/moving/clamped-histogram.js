// A histogram before and after normalising, with and without a clamp.
// Source: Burger & Burge, Digital Image Processing, 2nd ed. (2016), sections 4.1.2 and 4.4.

import { path } from "./lines.js";

export const SIZE = [320, 208];
// Pixels at the values -40, -30, ... 320 of a range of 256; larger ranges are stretched.
export const PIXELS = [2, 5, 9, 14, 22, 34, 48, 62, 74, 80, 78, 70, 60, 52, 48, 46, 47, 50, 54, 58, 60, 58, 52, 44, 36, 30, 26, 24, 21, 17, 12, 8, 5, 3, 2, 1, 1];
const [LEAST, APART] = [-40, 10];
const [TOP, BOTTOM, TALL] = [82, 186, 66];

export const picture = (id, figure) => `<rect class="m-paper" width="320" height="208"/>
  <path class="m-fill" data-part="given"/><path class="m-axis" d="M0 ${TOP}H320M0 ${BOTTOM}H320"/>
  <path class="m-blue" data-part="range"/><path class="m-faint" data-part="map"/>
  <path class="m-fill-blue" data-part="made"/><path class="m-line" d="M96 ${BOTTOM - 74}V${BOTTOM + 4}M224 ${BOTTOM - 74}V${BOTTOM + 4}"/>
  <text x="96" y="${BOTTOM + 16}">${figure.number(figure.values.N_min)}</text><text x="224" y="${BOTTOM + 16}">${figure.number(figure.values.N_max)}</text>
  <circle class="m-dot" data-part="pixel" r="4"/><circle class="m-dot" data-part="stored" r="4"/><path class="m-ray" data-part="way"/>
  <text data-part="low" y="${TOP + 14}"/><text data-part="high" y="${TOP + 14}"/>`;

const bar = (x, height, floor, wide) => height > 0 ? `M${(x - wide / 2).toFixed(2)} ${floor}v${(-height).toFixed(2)}h${wide}v${height.toFixed(2)}z` : "";

export const draw = (figure) => {
  const { I, I_min: low, I_max: high, N_min: first, N_max: last, clamp, scale } = figure.values;
  const share = (value) => (value - low) / (high - low), kept = (t) => clamp ? Math.min(1, Math.max(0, t)) : t;
  const above = (value) => 96 + 0.5 * value / scale, below = (t) => Math.max(-40, Math.min(360, 96 + 128 * t));
  const values = PIXELS.map((_, i) => scale * (LEAST + APART * i));
  const none = high === low;
  figure.set("given", { d: values.map((value, i) => bar(above(value), TALL * PIXELS[i] / 80, TOP, 4)).join("") });
  const made = new Map();
  if (!none) { values.forEach((value, i) => { const x = below(kept(share(value))); made.set(x, (made.get(x) ?? 0) + PIXELS[i]); }); }
  figure.set("made", { d: [...made].map(([x, pixels]) => bar(x, Math.min(TALL + 8, TALL * pixels / 80), BOTTOM, 4)).join("") });
  figure.set("range", { d: `${path([[above(low), 6], [above(low), TOP + 4]])}${path([[above(high), 6], [above(high), TOP + 4]])}` });
  figure.set("map", { d: `${path([[above(low), TOP + 18], [96, BOTTOM - 74]])}${path([[above(high), TOP + 18], [224, BOTTOM - 74]])}` });
  figure.set("low", { x: above(low), text: figure.number(low) });
  figure.set("high", { x: above(high), text: figure.number(high) });
  const t = share(I), stored = first + (last - first) * kept(t), plain = first + (last - first) * t;
  figure.set("pixel", { cx: above(I), cy: TOP });
  figure.set("stored", { cx: none ? -40 : below(kept(t)), cy: BOTTOM });
  figure.set("way", { d: none ? "" : path([[above(I), TOP], [below(kept(t)), BOTTOM]]) });
  const outside = values.reduce((sum, value, i) => sum + (share(value) < 0 || share(value) > 1 ? PIXELS[i] : 0), 0);
  const lost = 100 * outside / PIXELS.reduce((sum, pixels) => sum + pixels);
  figure.show("plain", none ? "–" : figure.number(plain));
  figure.show("stored", none ? "–" : figure.number(stored));
  figure.show("lost", none ? "–" : `${figure.number(lost, 3)}\u00a0%`);
  const place = t < 0 ? "below" : t > 1 ? "above" : "inside";
  const names = none ? ["said_none"] : [place === "inside" ? "said_inside" : `said_${place}_${clamp ? "clamped" : "free"}`];
  if (high < low) { names.push("said_turned"); }
  figure.say(names, { I: figure.number(I), plain: figure.number(plain), stored: figure.number(stored), lost: figure.number(lost, 3) });
};

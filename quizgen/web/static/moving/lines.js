// What the drawings of several figures are made of.

// A path through points.
export const path = (points) => "M" + points.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join("L");
// Numbers from one to another, both included.
export const row = (first, last, count) => Array.from({ length: count + 1 }, (_, i) => first + (last - first) * i / count);

/** The unions of the format: each type's fields and what a new one starts with. */
import type { Json } from "../model/json";

export interface FieldPlan {
  readonly key: string;
  readonly label: string;
  readonly as: "number" | "checkbox" | "json" | "text" | readonly string[];
  readonly start: Json;
  readonly range?: readonly [number, number];
  readonly unit?: string;
}

export type Kinds = Readonly<Record<string, { readonly label: string; readonly fields: readonly FieldPlan[] }>>;

const field = (key: string, label: string, start: Json, as: FieldPlan["as"] = "number"): FieldPlan => ({ key, label, as, start });
const PQ = ["p", "q"];

/** Lengths start in proportion to `size`, the width that a groove of this pattern has. */
export const profiles = (size: number): Kinds => {
  const width = field("width", "Width", size), depth = field("depth", "Depth", size / 2);
  const points = [[-size / 2, 0], [0, -size / 2], [size / 2, 0]];
  return {
    v: { label: "V", fields: [width, depth] },
    trapezoid: { label: "Trapezoid", fields: [width, field("floor", "Floor", size / 2), depth] },
    round: { label: "Round", fields: [width, depth, field("facets", "Facets", 16)] },
    scratch: {
      label: "Scratch",
      fields: [width, depth, field("lip_width", "Lip width", size / 4), field("lip_height", "Lip height", size / 8)],
    },
    polyline: { label: "Polyline", fields: [field("points", "Points [b, w]", points, "json")] },
  };
};

export const scales: Kinds = {
  constant: { label: "Constant", fields: [field("value", "Factor", 1)] },
  linear: { label: "Linear", fields: [field("start", "Start", 1), field("end", "End", 0.5)] },
  sine: {
    label: "Sine",
    fields: [field("amplitude", "Amplitude", 0.3), field("periods", "Periods", 5), { ...field("phase", "Phase", 0), unit: "°" }],
  },
  table: { label: "Table", fields: [field("t", "t", [0, 0.5, 1], "json"), field("values", "Values", [1, 0.5, 1], "json")] },
};

export const repeats = (size: number): Kinds => ({
  linear: { label: "In a row", fields: [field("count", "Count", 5), field("step", "Step", [2 * size, 0], PQ)] },
  grid: {
    label: "In a grid",
    fields: [
      field("counts", "Counts", [3, 3], ["i", "j"]),
      field("steps", "Steps", [[4 * size, 0], [0, 4 * size]], "json"),
    ],
  },
  concentric: { label: "Concentric", fields: [field("count", "Count", 5), field("step", "Step", 2 * size)] },
  scatter: {
    label: "Scattered",
    fields: [
      field("count", "Count", 50),
      field("seed", "Seed", 1),
      field("bounds", "Bounds", [0, 0, 20 * size, 20 * size], ["p0", "q0", "p1", "q1"]),
      field("angle", "Angle °", [0, 360], ["from", "to"]),
      field("scale", "Scale", [1, 1], ["from", "to"]),
    ],
  },
});

export const paths: Kinds = {
  polyline: { label: "Polyline", fields: [field("closed", "Closed", false, "checkbox")] },
  circle: { label: "Circle", fields: [field("center", "Centre", [0, 0], PQ), field("radius", "Radius", 1)] },
  spiral: {
    label: "Spiral",
    fields: [
      field("center", "Centre", [0, 0], PQ),
      field("inner_radius", "Inner radius", 0.1),
      field("outer_radius", "Outer radius", 1),
      field("turns", "Turns", 5),
      { ...field("angle", "Angle", 0), unit: "°" },
    ],
  },
  svg: { label: "SVG path", fields: [field("d", "Path data", "", "text"), field("flip_y", "y points down", false, "checkbox")] },
};

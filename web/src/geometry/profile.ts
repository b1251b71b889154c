/** Cross-sections as polylines of (b, w), by the same rules as the renderer's. */
import { array, entry, number, numbers, type Json } from "../model/json";
import { kind } from "../model/scene";

export type Section = readonly (readonly [number, number])[];

export function section(profile: Json | undefined): Section {
  const width = number(entry(profile, "width"), 0);
  const depth = number(entry(profile, "depth"), 0);
  const half = width / 2;
  switch (kind(profile)) {
    case "polyline":
      return array(entry(profile, "points")).map((point) => numbers(point, [0, 0] as const));
    case "v":
      return [[-half, 0], [0, -depth], [half, 0]];
    case "trapezoid": {
      const floor = number(entry(profile, "floor"), 0) / 2;
      return [[-half, 0], ...(floor > 0 ? [[-floor, -depth], [floor, -depth]] as const : [[0, -depth]] as const), [half, 0]];
    }
    case "round":
      return round(half, depth, Math.min(256, Math.max(2, Math.round(number(entry(profile, "facets"), 16)))));
    case "scratch": {
      const lip = number(entry(profile, "lip_width"), 0), height = number(entry(profile, "lip_height"), 0);
      if (lip === 0 || height === 0) return [[-half, 0], [0, -depth], [half, 0]];
      const left = [[-half - lip, 0], [-half - lip / 2, height], [-half, 0]] as const;
      return [...left, [0, -depth], [half, 0], [half + lip / 2, height], [half + lip, 0]];
    }
    default:
      return [];
  }
}

/** A circular arc up to a half circle, the half ellipse beyond; facets at equal angles. */
function round(half: number, depth: number, facets: number): Section {
  const deep = Math.abs(depth);
  if (deep === 0 || half <= 0) return [[-half, 0], [half, 0]];
  const isArc = deep <= half;
  const upright = isArc ? (half * half + deep * deep) / (2 * deep) : deep;
  const side = isArc ? upright : half;
  const reach = isArc ? 2 * Math.atan2(deep, half) : Math.PI / 2;
  const inner = Array.from({ length: facets - 1 }, (_, index): readonly [number, number] => {
    const angle = (reach * (2 * (index + 1) - facets)) / facets;
    return [side * Math.sin(angle), Math.sign(depth) * (upright * (1 - Math.cos(angle)) - deep)];
  });
  return [[-half, 0], ...inner, [half, 0]];
}

/** The strip that a cross-section takes up: its least and its greatest b. */
export function strip(profile: Json | undefined): readonly [number, number] {
  const points = section(profile);
  return [Math.min(0, ...points.map(([b]) => b)), Math.max(0, ...points.map(([b]) => b))];
}

/** The piece of the plane that an object shows, and what to fit into the canvas. */
import { chains } from "../geometry/flatten";
import { placed, placements } from "../geometry/placements";
import { pattern, type PatternPoint } from "../geometry/units";
import { at, entry, numbers, type Json } from "../model/json";
import { grooves, objects, type Target } from "../model/scene";
import type { Bounds } from "./view";

const FAR = 1e5; // further out, drawn paths are cut off by the canvas anyway

/** uv from (0, 0) to (1, 1) on the pattern's plane. */
export function surfaceBounds(doc: Json, target: Target): Bounds | null {
  if (target.object === null) return null;
  const mapping = entry(objects(doc)[target.object], "mapping");
  const [width, height] = numbers(entry(mapping, "scale"), [1, 1] as const);
  const [p, q] = numbers(entry(mapping, "offset"), [0, 0] as const);
  if (!(width > 0 && height > 0)) return null;
  return { low: pattern(p, q), high: pattern(p + width, q + height) };
}

export function tileBounds(doc: Json, target: Target): Bounds | null {
  const tile = target.pattern === null ? undefined : at(doc, ["patterns", target.pattern, "tile"]);
  const [width, height] = numbers(tile, [0, 0] as const);
  return width > 0 && height > 0 ? { low: pattern(0, 0), high: pattern(width, height) } : null;
}

/** What a fresh look at a target shows: its surface, else its tile, else its grooves. */
export function lookBounds(doc: Json, target: Target): Bounds {
  return surfaceBounds(doc, target) ?? tileBounds(doc, target) ?? groovesBounds(doc, target);
}

function groovesBounds(doc: Json, target: Target): Bounds {
  const points: PatternPoint[] = [];
  for (const groove of grooves(doc, target.pattern)) {
    for (const placement of placements(entry(groove, "repeat")).slice(0, 200)) {
      for (const chain of chains(entry(groove, "path"))) {
        points.push(...chain.points.map((point) => pattern(...placed(placement, point))));
      }
    }
  }
  const near = points.filter(([p, q]) => Math.abs(p) < FAR && Math.abs(q) < FAR);
  if (near.length === 0) return { low: pattern(0, 0), high: pattern(1, 1) };
  const pick = (axis: 0 | 1, best: (a: number, b: number) => number): number =>
    near.reduce((found, point) => best(found, point[axis]), near[0]?.[axis] ?? 0);
  return { low: pattern(pick(0, Math.min), pick(1, Math.min)), high: pattern(pick(0, Math.max), pick(1, Math.max)) };
}

/** What lies under the pointer. */
import { unplaced } from "../geometry/placements";
import { pattern, type PatternPoint } from "../geometry/units";
import type { Json } from "../model/json";
import { shapeOf, type Shape } from "./shapes";

const NEAR = 5; // pixels beside a groove's line that still hit it

export interface Hit {
  readonly groove: number;
  /** The point of the path before the place that was hit, and the place itself, both of the first copy. */
  readonly after: number;
  readonly point: PatternPoint;
}

/** The groove drawn last among those under a point: one whose line is near, before one whose strip merely covers it. */
export function hitGroove(grooves: readonly Json[], point: PatternPoint, zoom: number): Hit | null {
  let covered: Hit | null = null;
  for (let groove = grooves.length - 1; groove >= 0; groove -= 1) {
    const shape = shapeOf(grooves[groove] ?? null);
    const found = shape && nearest(shape, point);
    if (!found) continue;
    const hit = { groove, after: found.after, point: found.point };
    if (found.distance <= NEAR / zoom) return hit;
    if (found.distance <= shape.reach) covered ??= hit;
  }
  return covered;
}

interface Nearest {
  readonly distance: number;
  readonly after: number;
  readonly point: PatternPoint;
}

function nearest(shape: Shape, point: PatternPoint): Nearest | null {
  let best: Nearest | null = null;
  for (const placement of shape.placements) {
    const local = unplaced(placement, point);
    for (const { points, closed } of shape.chains) {
      const count = closed ? points.length : points.length - 1;
      for (let index = 0; index < count; index += 1) {
        const a = points[index] as PatternPoint, b = points[(index + 1) % points.length] as PatternPoint;
        const foot = footOn(a, b, local);
        const distance = Math.hypot(foot[0] - local[0], foot[1] - local[1]) * placement.scale;
        if (!best || distance < best.distance) best = { distance, after: index, point: foot };
      }
    }
  }
  return best;
}

function footOn(a: PatternPoint, b: PatternPoint, point: readonly [number, number]): PatternPoint {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const square = dx * dx + dy * dy;
  const t = square > 0 ? Math.min(1, Math.max(0, ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / square)) : 0;
  return pattern(a[0] + t * dx, a[1] + t * dy);
}

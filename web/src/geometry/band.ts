/** The strip of the plane that a groove takes up: its path's two offset lines, mitred at the corners. */
import type { Chain } from "./flatten";
import type { Scaling } from "./scaling";
import { pattern, type PatternPoint } from "./units";

const MITRE = 4; // times the offset, at most
const PIECES = 240; // of a chain whose width changes

export type Polygon = readonly PatternPoint[];

/** `capped` ends reach past the path by the groove's right half, as the renderer's profile ends do. */
export function band(chain: Chain, strip: readonly [number, number], scale: Scaling, capped: boolean): Polygon[] {
  const base = distinct(chain);
  const { points, closed } = scale.isConstant ? base : divided(base);
  const count = points.length;
  if (count < 2) return [];
  const lengths = alongs(points, closed);
  const total = lengths[lengths.length - 1] || 1;
  const left: PatternPoint[] = [], right: PatternPoint[] = [];
  for (let index = 0; index < count; index += 1) {
    const point = points[index] as PatternPoint;
    const before = index > 0 ? points[index - 1] : closed ? points[count - 1] : undefined;
    const after = index < count - 1 ? points[index + 1] : closed ? points[0] : undefined;
    const [nx, ny, stretch] = mitre(before, point, after);
    const factor = scale.factor((lengths[index] ?? 0) / total);
    let [x, y] = point;
    if (capped && !closed && (index === 0 || index === count - 1)) {
      const reach = (index === 0 ? -1 : 1) * strip[1] * factor;
      [x, y] = [x + ny * reach, y - nx * reach]; // the tangent is the binormal turned to the right
    }
    const high = strip[1] * factor * stretch, low = strip[0] * factor * stretch;
    left.push(pattern(x + nx * high, y + ny * high));
    right.push(pattern(x + nx * low, y + ny * low));
  }
  if (!closed) return [[...left, ...right.reverse()]];
  // One quadrilateral a piece: a ring would need a hole, which copies that overlap would fill in.
  return left.map((point, index) => {
    const next = (index + 1) % count;
    return [point, left[next] as PatternPoint, right[next] as PatternPoint, right[index] as PatternPoint];
  });
}

/** The unit binormal at a corner, and how much longer than the offset the mitre is. */
function mitre(a: PatternPoint | undefined, b: PatternPoint, c: PatternPoint | undefined): [number, number, number] {
  const first = a ? normal(a, b) : normal(b, c as PatternPoint);
  const second = c ? normal(b, c) : first;
  const [x, y] = [first[0] + second[0], first[1] + second[1]];
  const length = Math.hypot(x, y);
  if (length < 1e-9) return [first[0], first[1], 1];
  return [x / length, y / length, Math.min(MITRE, 2 / length)];
}

function normal(a: PatternPoint, b: PatternPoint): readonly [number, number] {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  return [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
}

function distinct({ points, closed }: Chain): Chain {
  const kept = points.filter((point, index) => index === 0 || !same(point, points[index - 1] as PatternPoint));
  if (closed && kept.length > 2 && same(kept[0] as PatternPoint, kept.at(-1) as PatternPoint)) kept.pop();
  return { points: kept, closed };
}

const same = (a: PatternPoint, b: PatternPoint): boolean => a[0] === b[0] && a[1] === b[1];

/** The length of the path up to each point, and at the end that of the whole. */
function alongs(points: readonly PatternPoint[], closed: boolean): number[] {
  const found = [0];
  const count = closed ? points.length : points.length - 1;
  for (let index = 0; index < count; index += 1) {
    const a = points[index] as PatternPoint, b = points[(index + 1) % points.length] as PatternPoint;
    found.push((found[index] ?? 0) + Math.hypot(b[0] - a[0], b[1] - a[1]));
  }
  return found;
}

function divided(chain: Chain): Chain {
  const lengths = alongs(chain.points, chain.closed);
  const step = (lengths.at(-1) || 1) / PIECES;
  const ends = chain.closed ? [...chain.points, chain.points[0] as PatternPoint] : chain.points;
  const points: PatternPoint[] = [];
  for (let index = 0; index + 1 < ends.length; index += 1) {
    const a = ends[index] as PatternPoint, b = ends[index + 1] as PatternPoint;
    const count = Math.max(1, Math.round(((lengths[index + 1] ?? 0) - (lengths[index] ?? 0)) / step));
    for (let part = 0; part < count; part += 1) {
      points.push(pattern(a[0] + ((b[0] - a[0]) * part) / count, a[1] + ((b[1] - a[1]) * part) / count));
    }
  }
  if (!chain.closed) points.push(ends.at(-1) as PatternPoint);
  return { points, closed: chain.closed };
}

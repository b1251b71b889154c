/** Paths as chains of points, close enough to the curve for the eye. */
import { array, at, entry, number, numbers, text, type Json } from "../model/json";
import { kind } from "../model/scene";
import { parseCommands } from "./svgcommands";
import { arcPoints } from "./svgarc";
import { pattern, type PatternPoint, radians } from "./units";

export interface Chain {
  readonly points: readonly PatternPoint[];
  readonly closed: boolean;
}

const CIRCLE = 96; // chords of a full turn
const CURVE = 24; // chords of a Bézier curve
const TURNS = 400; // of a spiral, at most

/** The chains of a path; none for one that lives in world space or cannot be read. */
export function chains(path: Json | undefined): Chain[] {
  switch (kind(path)) {
    case "polyline":
      return polyline(path);
    case "circle":
      return [circle(numbers(entry(path, "center"), [0, 0]), number(entry(path, "radius"), 0))];
    case "spiral":
      return [spiral(path)];
    case "svg":
      return svg(text(entry(path, "d"), ""), entry(path, "flip_y") === true);
    default:
      return [];
  }
}

export const isWorld = (path: Json | undefined): boolean => entry(path, "space") === "world";

function polyline(path: Json | undefined): Chain[] {
  if (isWorld(path)) return [];
  const points = array(entry(path, "points")).map((point) => pattern(...numbers(point, [0, 0] as const)));
  return points.length > 1 ? [{ points, closed: at(path, ["closed"]) === true }] : [];
}

export function circle(center: readonly [number, number], radius: number): Chain {
  const points = Array.from({ length: CIRCLE }, (_, index) => {
    const angle = (2 * Math.PI * index) / CIRCLE;
    return pattern(center[0] + radius * Math.cos(angle), center[1] + radius * Math.sin(angle));
  });
  return { points, closed: true };
}

function spiral(path: Json | undefined): Chain {
  const [p, q] = numbers(entry(path, "center"), [0, 0] as const);
  const inner = number(entry(path, "inner_radius"), 0);
  const outer = number(entry(path, "outer_radius"), 0);
  const turns = Math.min(number(entry(path, "turns"), 1), TURNS);
  const begin = radians(number(entry(path, "angle"), 0));
  const count = Math.max(8, Math.ceil(turns * 48));
  const points = Array.from({ length: count + 1 }, (_, index) => {
    const radius = inner + ((outer - inner) * index) / count;
    const angle = begin + (2 * Math.PI * turns * index) / count;
    return pattern(p + radius * Math.cos(angle), q + radius * Math.sin(angle));
  });
  return { points, closed: false };
}

function svg(d: string, flip: boolean): Chain[] {
  const found: { points: PatternPoint[]; closed: boolean }[] = [];
  const sign = flip ? -1 : 1;
  let x = 0, y = 0;
  for (const { name, numbers: n } of parseCommands(d)) {
    const last = found.at(-1);
    if (name === "Z") {
      if (last) last.closed = true;
      const [p, q] = last?.points[0] ?? [0, 0];
      [x, y] = [p, q * sign];
      continue;
    }
    const [endX, endY] = n.slice(-2) as [number, number];
    if (name === "M") found.push({ points: [pattern(endX, sign * endY)], closed: false });
    else {
      const chain = !last || last.closed ? { points: [pattern(x, sign * y)], closed: false } : last;
      if (chain !== last) found.push(chain);
      const between = name === "L" ? [[endX, endY] as const] : name === "A" ? arcPoints([x, y], n) : bezier([x, y, ...n]);
      for (const [a, b] of between) chain.points.push(pattern(a, sign * b));
    }
    [x, y] = [endX, endY];
  }
  return found.filter((chain) => chain.points.length > 1);
}

/** Points of a quadratic or cubic curve after its first, by de Casteljau. */
function bezier(control: readonly number[]): (readonly [number, number])[] {
  return Array.from({ length: CURVE }, (_, index) => {
    const t = (index + 1) / CURVE;
    let level = [...control];
    while (level.length > 2) level = level.slice(0, -2).map((value, i) => value + t * ((level[i + 2] ?? 0) - value));
    return [level[0] ?? 0, level[1] ?? 0] as const;
  });
}

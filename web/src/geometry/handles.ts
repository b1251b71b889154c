/** The points by which a path is changed, and what becomes of the path when one of them moves. */
import { array, entry, isObject, number, numbers, text, withAt, type Json } from "../model/json";
import { kind } from "../model/scene";
import { isWorld } from "./flatten";
import { formatCommands, mapped, parseCommands, type Command } from "./svgcommands";
import { pattern, rounded, type PatternPoint } from "./units";

export interface Handle {
  readonly point: PatternPoint;
  readonly role: "corner" | "control" | "center" | "radius";
  /** The handle that a control point belongs to. */
  readonly anchor?: PatternPoint;
}

export const HANDLES = 400; // a path with more of them is moved as a whole

export function handles(path: Json | undefined): Handle[] {
  switch (kind(path)) {
    case "polyline":
      if (isWorld(path)) return [];
      return array(entry(path, "points")).map((point) => ({ point: pattern(...numbers(point, [0, 0] as const)), role: "corner" }));
    case "circle": {
      const [p, q] = numbers(entry(path, "center"), [0, 0] as const);
      return [
        { point: pattern(p, q), role: "center" },
        { point: pattern(p + number(entry(path, "radius"), 0), q), role: "radius" },
      ];
    }
    case "spiral": {
      const [p, q] = numbers(entry(path, "center"), [0, 0] as const);
      return [
        { point: pattern(p, q), role: "center" },
        { point: pattern(p + number(entry(path, "outer_radius"), 0), q), role: "radius" },
      ];
    }
    case "svg":
      return ofCommands(commandsOf(path), sign(path));
    default:
      return [];
  }
}

const sign = (path: Json | undefined): 1 | -1 => (entry(path, "flip_y") === true ? -1 : 1);
const commandsOf = (path: Json | undefined): Command[] => parseCommands(text(entry(path, "d"), ""));

function ofCommands(commands: readonly Command[], flip: 1 | -1): Handle[] {
  const found: Handle[] = [];
  let pen = pattern(0, 0);
  for (const { name, numbers: n } of commands) {
    const pairs = (name === "A" ? n.slice(5) : n).flatMap((x, i, all) => (i % 2 ? [] : [pattern(x, flip * (all[i + 1] ?? 0))]));
    const end = pairs.at(-1) ?? pen;
    for (const [index, point] of pairs.entries()) {
      if (index === pairs.length - 1) found.push({ point, role: "corner" });
      else found.push({ point, role: "control", anchor: index === 0 ? pen : end });
    }
    pen = end;
  }
  return found;
}

/** The path with one handle somewhere else. Control points go along with their corner. */
export function withHandle(path: Json, index: number, to: PatternPoint, step: number): Json {
  const [p, q] = [rounded(to[0], step), rounded(to[1], step)];
  switch (kind(path)) {
    case "polyline":
      return withAt(path, ["points", index], [p, q]);
    case "circle":
    case "spiral": {
      if (index === 0) return withAt(path, ["center"], [p, q]);
      const [centerP, centerQ] = numbers(entry(path, "center"), [0, 0] as const);
      const radius = Math.max(step, rounded(Math.hypot(to[0] - centerP, to[1] - centerQ), step));
      return withAt(path, [kind(path) === "circle" ? "radius" : "outer_radius"], radius);
    }
    case "svg":
      return withAt(path, ["d"], formatCommands(commandMoved(commandsOf(path), index, [p, sign(path) * q])));
    default:
      return path;
  }
}

function commandMoved(commands: Command[], index: number, to: readonly [number, number]): Command[] {
  const all = ofCommands(commands, 1);
  const old = all[index];
  if (!old) return commands;
  const [dx, dy] = [to[0] - old.point[0], to[1] - old.point[1]];
  let count = -1;
  return mapped(commands, (x, y) => {
    count += 1;
    const handle = all[count];
    const follows = handle?.role === "control" && old.role === "corner" && handle.anchor !== undefined
      && handle.anchor[0] === old.point[0] && handle.anchor[1] === old.point[1];
    if (count === index) return to;
    return follows ? [sum(x, dx), sum(y, dy)] : [x, y];
  });
}

/** Without the noise of the last digits. */
const sum = (a: number, b: number): number => Number((a + b).toPrecision(12));

/** The whole path moved, by a multiple of `step`. */
export function moved(path: Json, by: PatternPoint, step: number): Json {
  const [dp, dq] = [rounded(by[0], step), rounded(by[1], step)];
  if (!isObject(path)) return path;
  if (kind(path) === "svg") {
    const flip = sign(path);
    const d = formatCommands(mapped(commandsOf(path), (x, y) => [sum(x, dp), sum(y, flip * dq)]));
    return withAt(path, ["d"], d);
  }
  if (kind(path) === "polyline") {
    if (isWorld(path)) return path;
    const points = array(path["points"]).map((point) => {
      const [p, q] = numbers(point, [0, 0] as const);
      return [sum(p, dp), sum(q, dq)];
    });
    return withAt(path, ["points"], points);
  }
  const [p, q] = numbers(path["center"], [0, 0] as const);
  return withAt(path, ["center"], [sum(p, dp), sum(q, dq)]);
}

/** A polyline without one of its points; null where too few would be left, or where it is no polyline. */
export function withoutHandle(path: Json | undefined, index: number): Json | null {
  const points = array(entry(path, "points"));
  if (kind(path) !== "polyline" || points.length <= 2) return null;
  return withAt(path, ["points"], points.filter((_, at) => at !== index));
}

/** A polyline with one point more, between `after` and the next. */
export function withPoint(path: Json, after: number, point: PatternPoint, step: number): Json {
  const points = array(entry(path, "points"));
  const added = [rounded(point[0], step), rounded(point[1], step)];
  return withAt(path, ["points"], [...points.slice(0, after + 1), added, ...points.slice(after + 1)]);
}

/** What the canvas draws of a groove. Made once for each groove: documents share what an edit leaves alone. */
import { band } from "../geometry/band";
import { chains, circle, type Chain } from "../geometry/flatten";
import { placements, SHOWN, type Placement } from "../geometry/placements";
import { strip } from "../geometry/profile";
import { scaling } from "../geometry/scaling";
import { array, entry, isObject, number, numbers, type Json, type JsonObject } from "../model/json";
import { kind } from "../model/scene";

export interface Shape {
  readonly chains: readonly Chain[];
  readonly placements: readonly Placement[];
  /** Half of the groove's width, at most. */
  readonly reach: number;
  readonly band: Path2D;
  readonly line: Path2D;
}

const known = new WeakMap<JsonObject, Shape>();

export function shapeOf(groove: Json): Shape | null {
  if (!isObject(groove)) return null;
  const found = known.get(groove) ?? made(groove);
  known.set(groove, found);
  return found;
}

function made(groove: JsonObject): Shape {
  const path = entry(groove, "path"), repeat = entry(groove, "repeat");
  const lines = kind(repeat) === "concentric" ? circles(path, repeat) : chains(path);
  const width = strip(entry(groove, "profile"));
  const scale = scaling(entry(groove, "scale"));
  const one = { band: new Path2D(), line: new Path2D() };
  const factors = [0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1].map(scale.factor);
  for (const chain of lines) {
    for (const polygon of band(chain, width, scale, entry(groove, "ends") !== "flat")) trace(one.band, polygon, true);
    trace(one.line, chain.points, chain.closed);
  }
  const copies = placements(repeat);
  const shape = { band: new Path2D(), line: new Path2D() };
  for (const { p, q, angle, scale: size } of copies) {
    const matrix = new DOMMatrix().translateSelf(p, q).rotateSelf((angle * 180) / Math.PI).scaleSelf(size);
    shape.band.addPath(one.band, matrix);
    shape.line.addPath(one.line, matrix);
  }
  const reach = Math.max(-width[0], width[1]) * Math.max(...factors);
  return { chains: lines, placements: copies, reach, ...shape };
}

function circles(path: Json | undefined, repeat: Json | undefined): Chain[] {
  const center = numbers(entry(path, "center"), [0, 0] as const);
  const radius = number(entry(path, "radius"), 0), step = number(entry(repeat, "step"), 0);
  const count = Math.min(SHOWN, Math.floor(number(entry(repeat, "count"), 1)));
  const radii = Array.from({ length: Math.max(0, count) }, (_, index) => radius + index * step);
  return radii.filter((one) => one > 0).map((one) => circle(center, one));
}

function trace(into: Path2D, points: readonly (readonly [number, number])[], closed: boolean): void {
  for (const [index, [p, q]] of points.entries()) {
    if (index === 0) into.moveTo(p, q);
    else into.lineTo(p, q);
  }
  if (closed) into.closePath();
}

/** How many copies the canvas leaves out. */
export function leftOut(groove: Json): number {
  const repeat = entry(groove, "repeat");
  const counts = array(entry(repeat, "counts")).map((item) => number(item, 1));
  const total = counts.length === 2 ? (counts[0] ?? 1) * (counts[1] ?? 1) : number(entry(repeat, "count"), 1);
  return Math.max(0, total - SHOWN);
}

/** Where the copies of a groove stand: turned and scaled about (0, 0), then moved, as the renderer does. */
import { entry, number, numbers, type Json } from "../model/json";
import { kind } from "../model/scene";
import { radians, type Radians } from "./units";

export interface Placement {
  readonly p: number;
  readonly q: number;
  readonly angle: Radians;
  readonly scale: number;
}

export const SHOWN = 600; // copies that the canvas draws, at most
const UNMOVED: Placement = { p: 0, q: 0, angle: 0, scale: 1 };

/** How many grooves a repeat makes. */
export function count(repeat: Json | undefined): number {
  if (kind(repeat) === "grid") {
    const [i, j] = numbers(entry(repeat, "counts"), [1, 1] as const);
    return i * j;
  }
  return Math.max(1, number(entry(repeat, "count"), 1));
}

/** The first placements of a repeat; of concentric circles just the one, as they are paths of their own. */
export function placements(repeat: Json | undefined): Placement[] {
  const total = Math.min(SHOWN, Math.floor(count(repeat)));
  switch (kind(repeat)) {
    case "linear": {
      const [p, q] = numbers(entry(repeat, "step"), [0, 0] as const);
      return Array.from({ length: total }, (_, index) => ({ ...UNMOVED, p: index * p, q: index * q }));
    }
    case "grid": {
      const columns = Math.max(1, numbers(entry(repeat, "counts"), [1, 1] as const)[1]);
      const a = numbers(entry(entry(repeat, "steps"), 0), [0, 0] as const);
      const b = numbers(entry(entry(repeat, "steps"), 1), [0, 0] as const);
      return Array.from({ length: total }, (_, index) => {
        const i = Math.floor(index / columns), j = index % columns;
        return { ...UNMOVED, p: i * a[0] + j * b[0], q: i * a[1] + j * b[1] };
      });
    }
    case "scatter":
      return scatter(repeat, total);
    default:
      return [UNMOVED];
  }
}

/** Number n of seed s is output n + 1 of splitmix64 whose state is the mixed seed; four numbers a placement. */
function scatter(repeat: Json | undefined, total: number): Placement[] {
  const [p0, q0, p1, q1] = numbers(entry(repeat, "bounds"), [0, 0, 0, 0] as const);
  const angle = numbers(entry(repeat, "angle"), [0, 360] as const);
  const scale = numbers(entry(repeat, "scale"), [1, 1] as const);
  const state = mixed(BigInt(Math.max(0, Math.floor(number(entry(repeat, "seed"), 0)))));
  const uniform = (index: number): number => {
    const output = mixed(BigInt.asUintN(64, state + BigInt(index + 1) * 0x9e3779b97f4a7c15n));
    return Number(output >> 11n) * 2 ** -53;
  };
  const between = (low: number, high: number, index: number): number => low + uniform(index) * (high - low);
  return Array.from({ length: total }, (_, index) => ({
    p: between(p0, p1, 4 * index),
    q: between(q0, q1, 4 * index + 1),
    angle: radians(between(angle[0], angle[1], 4 * index + 2)),
    scale: between(scale[0], scale[1], 4 * index + 3),
  }));
}

function mixed(value: bigint): bigint {
  let z = BigInt.asUintN(64, value);
  z = BigInt.asUintN(64, (z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n);
  z = BigInt.asUintN(64, (z ^ (z >> 27n)) * 0x94d049bb133111ebn);
  return z ^ (z >> 31n);
}

/** A point of a placed copy, seen from the groove itself. */
export function unplaced(placement: Placement, point: readonly [number, number]): readonly [number, number] {
  const x = (point[0] - placement.p) / placement.scale, y = (point[1] - placement.q) / placement.scale;
  const cos = Math.cos(placement.angle), sin = Math.sin(placement.angle);
  return [cos * x + sin * y, cos * y - sin * x];
}

export function placed(placement: Placement, point: readonly [number, number]): readonly [number, number] {
  const x = point[0] * placement.scale, y = point[1] * placement.scale;
  const cos = Math.cos(placement.angle), sin = Math.sin(placement.angle);
  return [cos * x - sin * y + placement.p, sin * x + cos * y + placement.q];
}

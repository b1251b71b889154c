/** A camera about its target: azimuth, elevation and distance, and back to an origin. */
import { clamp, degrees, radians, type Degrees, type Vector3 } from "../geometry/units";
import { entry, numbers, withAt, type Json } from "./json";

export interface Orbit {
  /** Counter-clockwise about `up`. */
  readonly azimuth: Degrees;
  readonly elevation: Degrees;
  readonly distance: number;
}

const STEEPEST = 89; // degrees: a camera that looks along `up` does not know which way the picture stands
type Frame = readonly [Vector3, Vector3, Vector3];

export function orbitOf(camera: Json | undefined): Orbit {
  const [x, y, z] = inFrame(frame(upOf(camera)), offset(camera));
  const distance = Math.hypot(x, y, z);
  return {
    azimuth: degrees(Math.atan2(y, x)),
    elevation: degrees(Math.asin(distance > 0 ? clamp(z / distance, -1, 1) : 0)),
    distance,
  };
}

export function withOrbit(camera: Json, { azimuth, elevation, distance }: Orbit): Json {
  const [e1, e2, up] = frame(upOf(camera));
  const steep = radians(clamp(elevation, -STEEPEST, STEEPEST)), around = radians(azimuth);
  const [x, y, z] = [Math.cos(steep) * Math.cos(around), Math.cos(steep) * Math.sin(around), Math.sin(steep)];
  const target = targetOf(camera);
  const length = clamp(distance, 1e-6, 1e6);
  const origin = [0, 1, 2].map((i) => {
    const along = x * (e1[i] ?? 0) + y * (e2[i] ?? 0) + z * (up[i] ?? 0);
    return Number(((target[i] ?? 0) + length * along).toPrecision(7));
  });
  return withAt(camera, ["origin"], origin);
}

/** The camera and its target moved across the view, by shares of the distance. */
export function withPan(camera: Json, right: number, rise: number): Json {
  const back = offset(camera);
  const distance = Math.hypot(...back);
  const side = unit(cross(upOf(camera), back), [1, 0, 0]);
  const over = unit(cross(back, side), [0, 1, 0]);
  const move = (point: Vector3): number[] =>
    point.map((value, i) => Number((value + distance * (right * (side[i] ?? 0) + rise * (over[i] ?? 0))).toPrecision(7)));
  const moved = withAt(camera, ["origin"], move(numbers(entry(camera, "origin"), [0, 0, 0] as const)));
  return withAt(moved, ["target"], move(targetOf(camera)));
}

const upOf = (camera: Json | undefined): Vector3 => unit(numbers(entry(camera, "up"), [0, 0, 1] as const), [0, 0, 1]);
const targetOf = (camera: Json | undefined): Vector3 => numbers(entry(camera, "target"), [0, 0, 0] as const);

function offset(camera: Json | undefined): Vector3 {
  const origin = numbers(entry(camera, "origin"), [0, -3, 2] as const);
  const target = targetOf(camera);
  return [origin[0] - target[0], origin[1] - target[1], origin[2] - target[2]];
}

/** Three axes at right angles, the last of them `up`; the world's own where up is z. */
function frame(up: Vector3): Frame {
  const helper: Vector3 = Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const e2 = unit(cross(up, helper), [0, 1, 0]);
  return [cross(e2, up), e2, up];
}

function inFrame(axes: Frame, v: Vector3): Vector3 {
  const dot = (a: Vector3): number => a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
  return [dot(axes[0]), dot(axes[1]), dot(axes[2])];
}

function cross(a: Vector3, b: Vector3): Vector3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(v: Vector3, otherwise: Vector3): Vector3 {
  const length = Math.hypot(...v);
  return length > 1e-12 ? [v[0] / length, v[1] / length, v[2] / length] : otherwise;
}

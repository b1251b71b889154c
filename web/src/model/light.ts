/** Where a directional light comes from, and colours as people pick them. */
import { degrees, radians, clamp, type Degrees, type Vector3 } from "../geometry/units";
import { numbers, type Json } from "./json";

export interface Sun {
  /** Counter-clockwise from +x, seen from +z. */
  readonly azimuth: Degrees;
  readonly elevation: Degrees;
}

/** `direction` is the way the light travels; a sun stands where it comes from. */
export function sunOf(direction: Json | undefined): Sun {
  const [x, y, z] = numbers(direction, [0, 0, -1] as const);
  return { azimuth: degrees(Math.atan2(0 - y, 0 - x)), elevation: degrees(Math.atan2(0 - z, Math.hypot(x, y))) };
}

export function directionOf({ azimuth, elevation }: Sun): Vector3 {
  const [a, e] = [radians(azimuth), radians(clamp(elevation, -90, 90))];
  const tidy = (value: number): number => Number(value.toFixed(4)) + 0;
  return [tidy(-Math.cos(e) * Math.cos(a)), tidy(-Math.cos(e) * Math.sin(a)), tidy(-Math.sin(e))];
}

/** Linear RGB as the #rrggbb that it is on the screen. */
export function hexOf(rgb: readonly number[]): string {
  const channel = (value: number): string => {
    const v = clamp(value, 0, 1);
    const shown = v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
    return Math.round(shown * 255).toString(16).padStart(2, "0");
  };
  return "#" + [0, 1, 2].map((index) => channel(rgb[index] ?? 0)).join("");
}

export function rgbOf(hex: string): [number, number, number] {
  const channel = (at: number): number => {
    const v = parseInt(hex.slice(at, at + 2), 16) / 255;
    return Number((v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4).toFixed(4));
  };
  return [channel(1), channel(3), channel(5)];
}

/** The strength of a light and its colour, whose greatest part is 1. */
export function split(rgb: readonly number[]): { strength: number; color: readonly number[] } {
  const strength = Math.max(0, ...rgb);
  return { strength, color: strength > 0 ? rgb.map((value) => value / strength) : [1, 1, 1] };
}

export function joined(strength: number, color: readonly number[]): number[] {
  return color.map((value) => Number((value * strength).toPrecision(5)));
}

/** Points and angles, branded so that those of different spaces and units do not mix. */
declare const unit: unique symbol;
type Branded<T, Unit extends string> = T & { readonly [unit]?: Unit };

/** (p, q) on the pattern's plane, pattern units, q up. */
export type PatternPoint = Branded<readonly [number, number], "pattern">;
/** (x, y) on the canvas, CSS pixels, y down. */
export type ScreenPoint = Branded<readonly [number, number], "screen">;
export type Vector3 = readonly [number, number, number];
export type Radians = Branded<number, "radians">;
export type Degrees = Branded<number, "degrees">;

export const pattern = (p: number, q: number): PatternPoint => [p, q];
export const screen = (x: number, y: number): ScreenPoint => [x, y];
export const radians = (angle: Degrees | number): Radians => (angle * Math.PI) / 180;
export const degrees = (angle: Radians | number): Degrees => (angle * 180) / Math.PI;
export const clamp = (value: number, low: number, high: number): number => Math.min(high, Math.max(low, value));

/** The nearest multiple of a step, with no more digits than the step needs. */
export function rounded(value: number, step: number): number {
  const digits = clamp(Math.ceil(-Math.log10(step) - 1e-9), 0, 12);
  return Number((Math.round(value / step) * step).toFixed(digits)) + 0;
}

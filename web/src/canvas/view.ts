/** Which part of the pattern's plane the canvas shows. */
import { clamp, pattern, screen, type PatternPoint, type ScreenPoint } from "../geometry/units";

export interface View {
  /** The pattern's point in the middle of the canvas. */
  readonly center: PatternPoint;
  /** Pixels a pattern unit. */
  readonly zoom: number;
  readonly width: number;
  readonly height: number;
}

export interface Bounds {
  readonly low: PatternPoint;
  readonly high: PatternPoint;
}

const MARGIN = 0.86; // the share of the canvas that a fitted thing takes up

export function toScreen(view: View, [p, q]: PatternPoint): ScreenPoint {
  return screen(view.width / 2 + (p - view.center[0]) * view.zoom, view.height / 2 - (q - view.center[1]) * view.zoom);
}

export function toPattern(view: View, [x, y]: ScreenPoint): PatternPoint {
  return pattern(view.center[0] + (x - view.width / 2) / view.zoom, view.center[1] - (y - view.height / 2) / view.zoom);
}

export function panned(view: View, dx: number, dy: number): View {
  return { ...view, center: pattern(view.center[0] - dx / view.zoom, view.center[1] + dy / view.zoom) };
}

/** The point under `at` stays where it is. */
export function zoomed(view: View, factor: number, at: ScreenPoint): View {
  const fixed = toPattern(view, at);
  const zoom = clamp(view.zoom * factor, 1e-4, 1e7);
  const keep = view.zoom / zoom;
  const center = pattern(fixed[0] + (view.center[0] - fixed[0]) * keep, fixed[1] + (view.center[1] - fixed[1]) * keep);
  return { ...view, zoom, center };
}

export function fitted(view: View, { low, high }: Bounds): View {
  const [width, height] = [Math.max(high[0] - low[0], 1e-9), Math.max(high[1] - low[1], 1e-9)];
  const zoom = clamp(MARGIN * Math.min(view.width / width, view.height / height), 1e-4, 1e7);
  return { ...view, zoom, center: pattern((low[0] + high[0]) / 2, (low[1] + high[1]) / 2) };
}

/** The power of ten that a pixel is worth: drawn coordinates need no more digits. */
export function precision(view: View): number {
  return 10 ** clamp(Math.floor(Math.log10(1 / view.zoom)), -9, 3);
}

/** The distance of the grid's lines: 1, 2 or 5 times a power of ten, and at least `least` pixels. */
export function gridStep(view: View, least = 24): number {
  const wanted = least / view.zoom;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const factor = [1, 2, 5, 10].find((one) => one * power >= wanted) ?? 10;
  return factor * power;
}

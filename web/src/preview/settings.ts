/** How large the preview is rendered. `?preview=WIDTH` in the page's address sets the draft's width for good. */
import { clamp } from "../geometry/units";
import { at, entry, number, numbers, type Json } from "../model/json";

export interface Quality {
  readonly name: "draft" | "sharp";
  /** Pixels of the longer side, at most and at least. */
  readonly side: number;
  readonly least: number;
  /** Samples a pixel where a method samples, at most and at least. */
  readonly samples: number;
  readonly fewest: number;
  /** Seconds that it should not take longer than, as far as the last picture tells. */
  readonly patience: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
  readonly samples: number;
}

const asked = Number(new URLSearchParams(globalThis.location?.search ?? "").get("preview"));
const isAsked = asked >= 8;
const side = isAsked ? Math.min(asked, 2048) : 320;

export const draft: Quality = { name: "draft", side, least: side / 2, samples: 16, fewest: 4, patience: isAsked ? Infinity : 0.8 };
export const sharp: Quality = { name: "sharp", side: 2 * side, least: side, samples: 64, fewest: 16, patience: isAsked ? Infinity : 5 };

/**
 * The picture's size, in the shape of the scene's own, and its samples. `pace` is the time that the last picture took,
 * in seconds a sample of a pixel: methods that take no samples are quicker than it says. Infinite: nothing is known yet.
 */
export function sizeOf(doc: Json, quality: Quality, pace: number): Size {
  const [width, height] = numbers(at(doc, ["camera", "resolution"]), [640, 480] as const);
  const longer = Math.max(width, height, 1), share = Math.min(width, height) / longer;
  const most = clamp(Math.round(number(entry(entry(doc, "render"), "samples"), 256)), 1, quality.samples);
  const affordable = quality.patience === Infinity ? Infinity : quality.patience / Math.max(pace, 1e-12);
  const samples = clamp(Math.floor(affordable / (quality.least ** 2 * Math.max(share, 0.01))), Math.min(most, quality.fewest), most);
  const fitting = Math.sqrt(affordable / samples / Math.max(share, 0.01));
  const scale = clamp(fitting, quality.least, quality.side) / longer;
  const length = (one: number): number => Math.max(1, Math.round(one * scale));
  return { width: length(width), height: length(height), samples };
}

export const work = ({ width, height, samples }: Size): number => width * height * samples;

/** How large the preview is rendered. `?preview=WIDTH` in the page's address sets the draft's width. */
import { clamp } from "../geometry/units";
import { at, entry, number, numbers, type Json } from "../model/json";

export interface Quality {
  readonly name: "draft" | "sharp";
  /** Pixels of the longer side. */
  readonly side: number;
  /** Samples a pixel where a method samples, at most. */
  readonly samples: number;
}

const asked = Number(new URLSearchParams(globalThis.location?.search ?? "").get("preview"));
const side = asked >= 8 ? Math.min(asked, 2048) : 320;

export const draft: Quality = { name: "draft", side, samples: 16 };
export const sharp: Quality = { name: "sharp", side: 2 * side, samples: 64 };

/** The picture's size, in the shape of the scene's own, and its samples. */
export function request(doc: Json, quality: Quality): { resolution: string; samples: number } {
  const [width, height] = numbers(at(doc, ["camera", "resolution"]), [640, 480] as const);
  const scale = quality.side / Math.max(width, height, 1);
  const size = (length: number): number => Math.round(clamp(length * scale, 1, quality.side));
  const samples = number(entry(entry(doc, "render"), "samples"), 256);
  return { resolution: `${size(width)}x${size(height)}`, samples: clamp(Math.round(samples), 1, quality.samples) };
}

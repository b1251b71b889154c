/** The groove that a drawn path gets: like the one selected last, else a V that the surface's size goes with. */
import type { Canvas } from "../canvas/canvas";
import { lookBounds } from "../canvas/surface";
import { rounded } from "../geometry/units";
import type { Groove, Path } from "../api/types";
import { asJson } from "../model/edits";
import { entry, isObject, type Json, type JsonObject } from "../model/json";

const SHARE = 0.03; // of the shorter side of what a fresh look shows

let style: JsonObject | null = null;

/** Remembers a groove's looks for the next one that is drawn. */
export function rememberStyle(groove: Json | undefined): void {
  if (!isObject(groove) || !isObject(entry(groove, "profile"))) return;
  const keys = ["profile", "scale", "material", "priority", "ends"];
  style = Object.fromEntries(Object.entries(groove).filter(([key]) => keys.includes(key)));
}

export function forgetStyle(): void {
  style = null;
}

export function newGroove(canvas: Canvas, path: Path): Json {
  if (style) return { path: asJson(path), ...style };
  const { low, high } = lookBounds(canvas.editor.doc, canvas.editor.state.target);
  const raw = SHARE * Math.min(high[0] - low[0], high[1] - low[1]);
  const width = rounded(raw, 10 ** Math.floor(Math.log10(raw)));
  const groove: Groove = { path, profile: { type: "v", width, depth: Number((width / 2).toPrecision(6)) } };
  return asJson(groove);
}

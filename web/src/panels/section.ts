/** A small drawing of a cross-section, in true proportion where that fits. */
import { section } from "../geometry/profile";
import type { Json } from "../model/json";
import { s } from "../ui/dom";

const WIDTH = 240, HEIGHT = 64, MARGIN = 8;

export function sectionDrawing(profile: Json | undefined): SVGElement {
  const points = section(profile);
  const attributes = { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "section-drawing", role: "img", "aria-label": "Cross-section" };
  if (points.length < 2) return s("svg", attributes);
  const bs = points.map(([b]) => b), ws = points.map(([, w]) => w);
  const [left, right, low, high] = [Math.min(...bs), Math.max(...bs), Math.min(...ws, 0), Math.max(...ws, 0)];
  const wide = (WIDTH * 0.6) / Math.max(right - left, 1e-12), tall = (HEIGHT - 2 * MARGIN) / Math.max(high - low, 1e-12);
  const scale = Math.min(wide, tall);
  const surface = high > -low ? HEIGHT - MARGIN + low * scale : MARGIN + high * scale;
  const x = (b: number): number => WIDTH / 2 + (b - (left + right) / 2) * scale;
  const profileLine = points.map(([b, w]) => `${x(b).toFixed(2)},${(surface - w * scale).toFixed(2)}`).join(" ");
  const outline = `${-WIDTH},${surface} ${profileLine} ${2 * WIDTH},${surface}`;
  return s("svg", attributes, [
    s("polygon", { points: `${outline} ${2 * WIDTH},${HEIGHT} ${-WIDTH},${HEIGHT}`, class: "solid" }),
    s("polyline", { points: outline, class: "edge" }),
    s("line", { x1: x(0), x2: x(0), y1: 2, y2: HEIGHT - 2, class: "axis" }),
  ]);
}

/** What lies behind the grooves: the surface, the grid with its numbers, the tile. */
import { colors } from "./theme";
import { gridStep, toPattern, toScreen, type Bounds, type View } from "./view";
import { pattern, screen } from "../geometry/units";

export function paintBackdrop(context: CanvasRenderingContext2D, view: View, surface: Bounds | null): void {
  context.fillStyle = colors.background;
  context.fillRect(0, 0, view.width, view.height);
  if (surface) {
    context.fillStyle = colors.surface;
    context.fillRect(...rectangle(view, surface));
  }
  paintGrid(context, view);
  if (surface) outline(context, view, surface, colors.surfaceEdge, []);
}

export function paintTile(context: CanvasRenderingContext2D, view: View, tile: Bounds): void {
  outline(context, view, tile, colors.tile, [6, 4]);
}

function paintGrid(context: CanvasRenderingContext2D, view: View): void {
  const step = gridStep(view);
  const low = toPattern(view, screen(0, view.height)), high = toPattern(view, screen(view.width, 0));
  const digits = Math.max(0, Math.ceil(-Math.log10(step * 5)));
  context.font = "10px system-ui, sans-serif";
  context.lineWidth = 1;
  for (const axis of [0, 1] as const) {
    for (let index = Math.ceil(low[axis] / step); index * step <= high[axis]; index += 1) {
      const value = index * step;
      const [x, y] = toScreen(view, axis === 0 ? pattern(value, 0) : pattern(0, value));
      context.strokeStyle = index === 0 ? colors.axis : index % 5 === 0 ? colors.gridStrong : colors.grid;
      context.beginPath();
      if (axis === 0) line(context, Math.round(x) + 0.5, 0, Math.round(x) + 0.5, view.height);
      else line(context, 0, Math.round(y) + 0.5, view.width, Math.round(y) + 0.5);
      context.stroke();
      if (index % 5 !== 0) continue;
      context.fillStyle = colors.label;
      const label = Number(value.toFixed(digits + 1)).toString();
      if (axis === 0) context.fillText(label, x + 3, view.height - 5);
      else if (y < view.height - 20) context.fillText(label, 4, y - 3);
    }
  }
}

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
}

function rectangle(view: View, { low, high }: Bounds): [number, number, number, number] {
  const [x0, y1] = toScreen(view, low), [x1, y0] = toScreen(view, high);
  return [x0, y0, x1 - x0, y1 - y0];
}

function outline(context: CanvasRenderingContext2D, view: View, bounds: Bounds, color: string, dash: number[]): void {
  context.save();
  context.setLineDash(dash);
  context.strokeStyle = color;
  context.lineWidth = 1;
  context.strokeRect(...rectangle(view, bounds));
  context.restore();
}

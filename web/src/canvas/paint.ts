/** The picture on the canvas: backdrop, grooves with their real width, handles, what is being drawn. */
import { handles, HANDLES, type Handle } from "../geometry/handles";
import type { PatternPoint } from "../geometry/units";
import { entry, number, type Json } from "../model/json";
import { paintBackdrop, paintTile } from "./backdrop";
import { shapeOf } from "./shapes";
import { colors } from "./theme";
import { toPattern, toScreen, type Bounds, type View } from "./view";
import { screen } from "../geometry/units";

export interface Picture {
  readonly view: View;
  readonly grooves: readonly Json[];
  readonly surface: Bounds | null;
  readonly tile: Bounds | null;
  readonly selected: number | null;
  readonly point: number | null;
  readonly hovered: number | null;
  readonly wrong: ReadonlySet<number>;
  /** What a tool is drawing: the line so far and its points. */
  readonly draft: { readonly line: readonly PatternPoint[]; readonly points: readonly PatternPoint[] } | null;
}

const TILES = 400; // drawn copies of a tile, at most

export function paint(context: CanvasRenderingContext2D, picture: Picture): void {
  const { view, grooves, tile } = picture;
  paintBackdrop(context, view, picture.surface);
  for (const [p, q] of tile ? tilesInView(view, tile) : [[0, 0] as const]) {
    const isCopy = p !== 0 || q !== 0;
    context.save();
    context.globalAlpha = isCopy ? 0.35 : 1;
    for (const [index, groove] of grooves.entries()) {
      if (index !== picture.selected || isCopy) paintGroove(context, picture, groove, index, p, q);
    }
    context.restore();
  }
  if (tile) paintTile(context, view, tile);
  const selected = picture.selected === null ? undefined : grooves[picture.selected];
  if (selected !== undefined && picture.selected !== null) {
    paintGroove(context, picture, selected, picture.selected, 0, 0);
    paintHandles(context, view, handles(entry(selected, "path")), picture.point);
  }
  if (picture.draft) paintDraft(context, view, picture.draft);
}

function paintGroove(
  context: CanvasRenderingContext2D, picture: Picture, groove: Json, index: number, p: number, q: number,
): void {
  const shape = shapeOf(groove);
  if (!shape) return;
  const { view, selected, hovered, wrong } = picture;
  const isRidge = number(entry(entry(groove, "profile"), "depth"), 1) < 0;
  const isSelected = index === selected, isWrong = wrong.has(index);
  context.save();
  const [x, y] = toScreen(view, [p, q]);
  context.transform(view.zoom, 0, 0, -view.zoom, x, y);
  context.fillStyle = isSelected ? colors.selectedBand : isWrong ? colors.problemBand : isRidge ? colors.ridge : colors.band;
  context.fill(shape.band);
  const line = isRidge ? colors.ridgeLine : colors.line;
  context.strokeStyle = isSelected ? colors.selectedLine : isWrong ? colors.problemLine : index === hovered ? colors.hoverLine : line;
  context.lineWidth = (isSelected || index === hovered ? 1.5 : 1) / view.zoom;
  context.lineJoin = "round";
  context.stroke(shape.line);
  context.restore();
}

/** Where the copies of a tile stand that the canvas shows. */
function tilesInView(view: View, { high: [width, height] }: Bounds): (readonly [number, number])[] {
  const low = toPattern(view, screen(0, view.height)), high = toPattern(view, screen(view.width, 0));
  const [i0, i1] = [Math.floor(low[0] / width), Math.floor(high[0] / width)];
  const [j0, j1] = [Math.floor(low[1] / height), Math.floor(high[1] / height)];
  if ((i1 - i0 + 1) * (j1 - j0 + 1) > TILES) return [[0, 0]];
  const found: (readonly [number, number])[] = [];
  for (let i = Math.min(i0, 0); i <= Math.max(i1, 0); i += 1) {
    for (let j = Math.min(j0, 0); j <= Math.max(j1, 0); j += 1) found.push([i * width, j * height]);
  }
  return found.length > TILES ? [[0, 0]] : found;
}

function paintHandles(context: CanvasRenderingContext2D, view: View, all: readonly Handle[], chosen: number | null): void {
  if (all.length > HANDLES) return;
  for (const [index, { point, role, anchor }] of all.entries()) {
    const [x, y] = toScreen(view, point);
    context.lineWidth = 1.5;
    context.strokeStyle = role === "control" ? colors.control : colors.selectedLine;
    context.fillStyle = index === chosen ? context.strokeStyle : colors.handle;
    context.beginPath();
    if (role === "control") {
      if (anchor) {
        const [ax, ay] = toScreen(view, anchor);
        context.save();
        context.lineWidth = 1;
        context.moveTo(ax, ay);
        context.lineTo(x, y);
        context.stroke();
        context.restore();
        context.beginPath();
      }
      context.arc(x, y, 3.5, 0, 2 * Math.PI);
    } else if (role === "center" || role === "radius") context.arc(x, y, 4.5, 0, 2 * Math.PI);
    else context.rect(x - 4, y - 4, 8, 8);
    context.fill();
    context.stroke();
  }
}

function paintDraft(context: CanvasRenderingContext2D, view: View, draft: NonNullable<Picture["draft"]>): void {
  context.strokeStyle = colors.draft;
  context.fillStyle = colors.draft;
  context.lineWidth = 1.5;
  context.beginPath();
  for (const [index, point] of draft.line.entries()) {
    const [x, y] = toScreen(view, point);
    if (index === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  }
  context.stroke();
  for (const point of draft.points) {
    const [x, y] = toScreen(view, point);
    context.fillRect(x - 3, y - 3, 6, 6);
  }
}

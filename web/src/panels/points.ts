/** A polyline's points as numbers: what the canvas does with the pointer, with the keyboard alone. */
import { withoutHandle } from "../geometry/handles";
import { array, at, entry, number, withAt, type Place } from "../model/json";
import { kind } from "../model/scene";
import { h } from "../ui/dom";
import type { Fields } from "../ui/fields";

const LISTED = 40;

export function pointFields(fields: Fields, path: Place): HTMLElement[] {
  const { editor } = fields;
  const value = at(editor.doc, path);
  if (kind(value) !== "polyline") return [];
  const points = array(entry(value, "points"));
  const axes = entry(value, "space") === "world" ? ["x", "y", "z"] : ["p", "q"];
  const rows = points.slice(0, LISTED).map((_, index) => {
    const field = { label: `Point ${index + 1}`, place: [...path, "points", index], otherwise: [0, 0] };
    const row = fields.tuple(field, axes);
    row.classList.toggle("chosen", editor.state.point === index);
    const remove = h("button", {
      type: "button", class: "small", "aria-label": `Remove point ${index + 1}`, title: "Remove this point", disabled: points.length <= 2,
      onclick: () => {
        const next = withoutHandle(at(editor.doc, path), index);
        if (next !== null) editor.edit(withAt(editor.doc, path, next), null, { point: null });
      },
    }, ["×"]);
    row.querySelector(".controls")?.append(remove);
    return row;
  });
  if (points.length > LISTED) rows.push(h("p", { class: "muted note" }, [`and ${points.length - LISTED} points more`]));
  const add = h("button", { type: "button", onclick: () => addPoint(fields, path) }, ["Add point"]);
  return [...rows, h("div", { class: "buttons" }, [add])];
}

/** One more at the end, as far from the last as that is from the one before. */
function addPoint({ editor }: Fields, path: Place): void {
  const points = array(at(editor.doc, [...path, "points"]));
  const [before, last] = [array(points.at(-2)), array(points.at(-1))];
  const next = last.map((value, axis) => Number((2 * number(value, 0) - number(before[axis], 0)).toPrecision(10)));
  editor.edit(withAt(editor.doc, [...path, "points"], [...points, next]), null, { point: null });
}

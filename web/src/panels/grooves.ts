/** What is engraved: the choice of object and pattern, and the list of the pattern's grooves. */
import { leftOut } from "../canvas/shapes";
import { count } from "../geometry/placements";
import { isWorld } from "../geometry/flatten";
import type { Editor, State } from "../model/editor";
import { entry, number, type Json } from "../model/json";
import { format } from "../model/pointer";
import { grooves, groovePlace, kind, objects, targets, type Target } from "../model/scene";
import { freshId, h } from "../ui/dom";
import { Fields } from "../ui/fields";
import type { Binder, PanelPlan } from "../ui/panel";

const LISTED = 200;

export function groovesPanel(editor: Editor): PanelPlan {
  return {
    title: "Pattern",
    key: ({ target, groove, history }: State) => {
      const names = targets(history.present).map((one) => label(history.present, one)).join("|");
      const rows = grooves(history.present, target.pattern).slice(0, LISTED).map(summary).join("|");
      return `${names} ${target.object} ${target.pattern} ${groove} ${grooves(history.present, target.pattern).length} ${rows}`;
    },
    build: (bind) => [targetChoice(editor), list(editor), ...tileField(editor, bind)],
  };
}

function label(doc: Json, target: Target): string {
  if (target.object === null) return `${target.pattern ?? "nothing"} (unused)`;
  return `${target.object + 1} · ${kind(entry(objects(doc)[target.object], "shape"))} · ${target.pattern ?? "no pattern"}`;
}

function targetChoice(editor: Editor): HTMLElement {
  const id = freshId("target");
  const all = targets(editor.doc);
  const options = all.map((one, index) => h("option", { value: index }, [label(editor.doc, one)]));
  const select = h("select", { id }, options);
  const { target } = editor.state;
  select.selectedIndex = all.findIndex((one) => one.object === target.object && one.pattern === target.pattern);
  select.addEventListener("change", () => {
    const chosen = all[select.selectedIndex];
    if (chosen) editor.selectTarget(chosen);
  });
  const place = target.object === null ? [] : ["objects", target.object];
  return h("div", { class: "field", "data-pointer": place.length ? format(place) : null }, [
    h("label", { for: id, class: "label" }, ["Object"]), h("div", { class: "controls" }, [select]),
  ]);
}

export function summary(groove: Json): string {
  const profile = entry(groove, "profile"), path = entry(groove, "path");
  const copies = count(entry(groove, "repeat"));
  const width = entry(profile, "width");
  const size = typeof width === "number" ? ` ${Number(width.toPrecision(3))} × ${Number(number(entry(profile, "depth"), 0).toPrecision(3))}` : "";
  return `${kind(profile)}${size} · ${kind(path)}${isWorld(path) ? " (world)" : ""}${copies > 1 ? ` × ${copies}` : ""}`;
}

function list(editor: Editor): HTMLElement {
  const { target, groove: selected } = editor.state;
  const all = grooves(editor.doc, target.pattern);
  const rows = all.slice(0, LISTED).map((groove, index) => {
    const button = h("button", {
      type: "button", class: "groove-row", "aria-pressed": String(index === selected),
      onclick: () => editor.select(index === editor.state.groove ? null : index),
    }, [h("span", { class: "number" }, [String(index + 1)]), summary(groove)]);
    if (index === selected) requestAnimationFrame(() => button.scrollIntoView({ block: "nearest" }));
    const place = target.pattern === null ? "" : format(groovePlace(target.pattern, index));
    return h("li", { "data-pointer": place, "data-marks": "quiet" }, [button]);
  });
  if (all.length > LISTED) rows.push(h("li", { class: "muted note" }, [`and ${all.length - LISTED} more, on the canvas`]));
  const hidden = all.reduce((sum: number, groove) => sum + leftOut(groove), 0);
  if (hidden > 0) rows.push(h("li", { class: "muted note" }, [`${hidden} copies are not drawn here`]));
  if (all.length === 0) rows.push(h("li", { class: "muted note" }, ["No grooves yet: draw one on the plane."]));
  return h("ul", { class: "groove-list", "aria-label": "Grooves" }, rows);
}

function tileField(editor: Editor, bind: Binder): HTMLElement[] {
  const { pattern } = editor.state.target;
  if (pattern === null) return [];
  const fields = new Fields(editor, bind);
  const place = ["patterns", pattern, "tile"];
  const field = { label: "Tile", place, otherwise: null, title: "[width, height] after which the pattern repeats, or null" };
  return [fields.json(field)];
}

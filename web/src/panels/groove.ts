/** The selected groove: its cross-section, material, priority, ends, width along the path, copies and path. */
import { lookBounds } from "../canvas/surface";
import { handles, moved } from "../geometry/handles";
import { section } from "../geometry/profile";
import { pattern as patternPoint, rounded } from "../geometry/units";
import { duplicateGroove } from "../model/edits";
import type { Editor, State } from "../model/editor";
import { array, at, entry, number, type Json, type Place } from "../model/json";
import { groovePlace, kind, materialNames } from "../model/scene";
import { h } from "../ui/dom";
import { Fields } from "../ui/fields";
import type { Binder, PanelPlan } from "../ui/panel";
import { paths, profiles, repeats, scales } from "./kinds";
import { grooveMaterial } from "./groovematerial";
import { pointFields } from "./points";
import { sectionDrawing } from "./section";
import { unionFields } from "./union";

export function groovePanel(editor: Editor): PanelPlan {
  return { title: "Groove", key: (state) => keyOf(state), build: (bind) => build(editor, bind) };
}

function selected(state: State): { place: Place; groove: Json } | null {
  const { target, groove, history } = state;
  if (target.pattern === null || groove === null) return null;
  const place = groovePlace(target.pattern, groove);
  const found = at(history.present, place);
  return found === undefined ? null : { place, groove: found };
}

/** What the fields are, not what stands in them. */
function keyOf(state: State): string {
  const found = selected(state);
  if (!found) return "none";
  const of = (key: string): Json | undefined => entry(found.groove, key);
  const parts = ["profile", "scale", "repeat", "path"].map((key) => kind(of(key)));
  const material = of("material");
  const shape = Array.isArray(material) ? material.length : typeof material;
  const facets = Array.isArray(material) ? section(of("profile")).length : 0;
  const points = array(entry(of("path"), "points")).length;
  return [found.place.join("/"), ...parts, shape, facets, points, state.point, ...materialNames(state.history.present)].join("|");
}

function build(editor: Editor, bind: Binder): readonly (Node | string)[] {
  const found = selected(editor.state);
  if (!found) return [h("p", { class: "muted" }, ["Select a groove on the plane or in the list, or draw one."])];
  const { place } = found;
  const fields = new Fields(editor, bind);
  const { low, high } = lookBounds(editor.doc, editor.state.target);
  const raw = 0.03 * Math.min(high[0] - low[0], high[1] - low[1]);
  const size = number(at(found.groove, ["profile", "width"]), rounded(raw, 10 ** Math.floor(Math.log10(raw))));
  const drawing = h("div", { class: "section-frame" });
  bind(() => drawing.replaceChildren(sectionDrawing(at(editor.doc, [...place, "profile"]))));
  const isCircle = kind(entry(found.groove, "path")) === "circle";
  const offered = isCircle ? undefined : ["linear", "grid", "scatter"];
  const union = { label: "Repeat", place: [...place, "repeat"], kinds: repeats(size), otherwise: "" };
  return [
    drawing,
    ...unionFields(fields, { label: "Profile", place: [...place, "profile"], kinds: profiles(size), otherwise: "v" }),
    grooveMaterial(fields, place),
    fields.number({ label: "Priority", place: [...place, "priority"], otherwise: 0, title: "A higher one predominates where grooves meet." }),
    fields.select({ label: "Ends", place: [...place, "ends"], otherwise: "profile" }, [["profile", "Profile"], ["flat", "Flat"]]),
    group("Scale", unionFields(fields, { label: "Along path", place: [...place, "scale"], kinds: scales, otherwise: "constant" })),
    group("Copies", unionFields(fields, offered ? { ...union, offered } : union)),
    group("Path", [
      ...unionFields(fields, { label: "Path", place: [...place, "path"], kinds: paths, otherwise: "polyline", fixed: true }),
      ...pointFields(fields, [...place, "path"]),
    ]),
    h("div", { class: "buttons" }, [
      h("button", { type: "button", onclick: () => duplicate(editor) }, ["Duplicate"]),
      h("button", { type: "button", onclick: () => editor.removeGroove() }, ["Delete groove"]),
    ]),
  ];
}

function group(title: string, children: readonly HTMLElement[]): HTMLElement {
  return h("fieldset", {}, [h("legend", {}, [title]), ...children]);
}

/** A copy, a little to the side. */
function duplicate(editor: Editor): void {
  const found = selected(editor.state);
  const { target, groove } = editor.state;
  if (!found || target.pattern === null || groove === null) return;
  const path = entry(found.groove, "path") ?? null;
  const all = handles(path).map(({ point }) => point);
  const width = number(at(found.groove, ["profile", "width"]), 0.1);
  const by = all.length > 0 ? patternPoint(2 * width, 2 * width) : patternPoint(0, 0);
  editor.edit(duplicateGroove(editor.doc, target.pattern, groove, moved(path, by, 1e-9)), null, { groove: groove + 1, point: null });
}

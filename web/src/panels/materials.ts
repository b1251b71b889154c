/** The scene's materials. */
import type { Editor } from "../model/editor";
import { renameMaterial, usesMaterial } from "../model/edits";
import { entry, object } from "../model/json";
import { format } from "../model/pointer";
import { freeName, materialNames } from "../model/scene";
import { colorField } from "../ui/color";
import { freshId, h } from "../ui/dom";
import { Fields } from "../ui/fields";
import type { Binder, PanelPlan } from "../ui/panel";

const open = new Set<string>();

export function materialsPanel(editor: Editor): PanelPlan {
  return {
    title: "Materials",
    key: ({ history }) => materialNames(history.present).map((name) => `${name}:${usesMaterial(history.present, name)}`).join("|"),
    build: (bind) => [
      ...materialNames(editor.doc).map((name, index) => material(editor, bind, name, index)),
      h("div", { class: "buttons" }, [h("button", { type: "button", onclick: () => add(editor) }, ["Add material"])]),
    ],
  };
}

function add(editor: Editor): void {
  const name = freeName("material", materialNames(editor.doc));
  open.add(name);
  editor.set(["materials", name], { base_color: [0.6, 0.6, 0.6], metallic: 0, roughness: 0.5 }, null);
}

function material(editor: Editor, bind: Binder, name: string, index: number): HTMLElement {
  const fields = new Fields(editor, bind);
  const place = ["materials", name];
  const used = usesMaterial(editor.doc, name);
  const remove = h("button", {
    type: "button", disabled: used, title: used ? "It is in use." : "Remove this material", onclick: () => editor.remove(place),
  }, ["Remove"]);
  const share = (key: string, label: string, otherwise: number): HTMLElement =>
    fields.number({ label, place: [...place, key], otherwise, range: [0, 1] });
  const swatch = h("span", { class: "swatch", "aria-hidden": "true" });
  const color = colorField(fields, { label: "Colour", place: [...place, "base_color"], otherwise: [1, 1, 1] });
  bind(() => (swatch.style.background = color.querySelector("input")?.value ?? ""));
  const details = h("details", { class: "material", "data-pointer": format(place), "data-marks": "quiet", open: open.has(name) || index === 0 }, [
    h("summary", {}, [swatch, name]),
    nameField(editor, name),
    color,
    share("metallic", "Metallic", 0),
    share("roughness", "Roughness", 1),
    share("specular", "Specular", 1),
    share("transmission", "Transmission", 0),
    fields.number({ label: "Index (IOR)", place: [...place, "ior"], otherwise: 1.5, range: [1.01, 4] }),
    h("div", { class: "buttons" }, [remove]),
  ]);
  details.addEventListener("toggle", () => (details.open ? open.add(name) : open.delete(name)));
  return details;
}

function nameField(editor: Editor, name: string): HTMLElement {
  const id = freshId("name");
  const input = h("input", { id, type: "text", value: name, maxlength: 64, autocomplete: "off" });
  input.addEventListener("change", () => {
    const to = input.value;
    const taken = to !== name && Object.hasOwn(object(entry(editor.doc, "materials")), to);
    input.setCustomValidity(to === "" ? "A name is needed." : taken ? "Another material has this name." : "");
    if (!input.reportValidity() || to === name) return;
    open.add(to);
    editor.edit(renameMaterial(editor.doc, name, to));
  });
  return h("div", { class: "field" }, [h("label", { for: id, class: "label" }, ["Name"]), h("div", { class: "controls" }, [input])]);
}

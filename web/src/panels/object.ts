/** The object that the canvas shows: its shape, material and the mapping of the pattern onto it. */
import { uploadMesh } from "../api/client";
import type { Editor } from "../model/editor";
import { entry, text, type Place } from "../model/json";
import { kind, materialNames, objects, patternNames } from "../model/scene";
import { h } from "../ui/dom";
import { Fields } from "../ui/fields";
import type { PanelPlan } from "../ui/panel";
import type { Kinds } from "./kinds";
import { unionFields } from "./union";

const shapes: Kinds = {
  rectangle: { label: "Rectangle", fields: [{ key: "size", label: "Size", as: ["x", "y"], start: [2, 2] }] },
  sphere: { label: "Sphere", fields: [{ key: "radius", label: "Radius", as: "number", start: 1 }] },
  cylinder: {
    label: "Cylinder",
    fields: [
      { key: "radius", label: "Radius", as: "number", start: 1 },
      { key: "height", label: "Height", as: "number", start: 2 },
    ],
  },
  mesh: { label: "Mesh", fields: [{ key: "file", label: "File", as: "text", start: "" }] },
};

export function objectPanel(editor: Editor): PanelPlan {
  return {
    title: "Object",
    key: ({ target, history }) => {
      const shape = target.object === null ? "" : kind(entry(objects(history.present)[target.object], "shape"));
      return [target.object, shape, ...materialNames(history.present), "/", ...patternNames(history.present)].join("|");
    },
    build: (bind) => {
      const { object } = editor.state.target;
      if (object === null) return [h("p", { class: "muted" }, ["No object shows this pattern."])];
      const fields = new Fields(editor, bind);
      const place = ["objects", object];
      const names = materialNames(editor.doc).map((name) => [name, name] as const);
      const patterns = patternNames(editor.doc).map((name) => [name, name] as const);
      const putPattern = (name: string): void => editor.set([...place, "pattern"], name === "" ? null : name, null);
      return [
        ...unionFields(fields, { label: "Shape", place: [...place, "shape"], kinds: shapes, otherwise: "rectangle",
          offered: ["rectangle", "sphere", "cylinder"] }),
        meshUpload(editor, [...place, "shape"]),
        fields.select({ label: "Material", place: [...place, "material"], otherwise: text(names[0]?.[0], "") }, names),
        fields.select({ label: "Pattern", place: [...place, "pattern"], otherwise: null }, [["", "None"], ...patterns], putPattern),
        fields.tuple({ label: "Units a uv", place: [...place, "mapping", "scale"], otherwise: [1, 1] }, ["p", "q"]),
        fields.tuple({ label: "Offset", place: [...place, "mapping", "offset"], otherwise: [0, 0] }, ["p", "q"]),
      ];
    },
  };
}

/** The service reads no files of its own machine: a mesh is handed to it. */
function meshUpload(editor: Editor, shape: Place): HTMLElement {
  const input = h("input", { type: "file", accept: ".obj,.ply,.glb", hidden: true });
  const said = h("span", { class: "muted", "aria-live": "polite" });
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (!file) return;
    said.textContent = `Uploading ${file.name}…`;
    uploadMesh(file).then(
      (name) => editor.set(shape, { type: "mesh", file: name }, null),
      (error: unknown) => (said.textContent = error instanceof Error ? error.message : String(error)),
    );
  });
  const button = h("button", { type: "button", title: "OBJ, PLY or GLB, with uv", onclick: () => input.click() }, ["Use a mesh file…"]);
  return h("div", { class: "buttons" }, [button, input, said]);
}

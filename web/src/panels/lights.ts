/** The scene's lights. */
import type { Light } from "../api/types";
import { clamp } from "../geometry/units";
import type { Editor } from "../model/editor";
import { at, entry, text, type Json, type Place } from "../model/json";
import { directionOf, sunOf, type Sun } from "../model/light";
import { format } from "../model/pointer";
import { kind, lights } from "../model/scene";
import { powerField } from "../ui/color";
import { freshId, h } from "../ui/dom";
import { Fields, numberInput, show } from "../ui/fields";
import type { Binder, PanelPlan } from "../ui/panel";
import { lightSphere } from "./sphere";

const NEW: Record<string, Light> = {
  directional: { type: "directional", direction: [-0.5, 0.5, -0.7], irradiance: [2, 2, 2] },
  point: { type: "point", position: [1, -1, 1.5], intensity: [3, 3, 3] },
  constant: { type: "constant", radiance: [0.15, 0.15, 0.15] },
};
const LABELS: Record<string, string> = { directional: "Sun", point: "Point", constant: "Sky", envmap: "Picture of the sky" };

export function lightsPanel(editor: Editor): PanelPlan {
  return {
    title: "Lights",
    key: ({ history }) => lights(history.present).map(kind).join("|"),
    build: (bind) => [
      ...lights(editor.doc).map((light, index) => lightFields(editor, bind, light, ["lights", index])),
      h("div", { class: "buttons" }, Object.entries(NEW).map(([type, light]) =>
        h("button", { type: "button", onclick: () => editor.set(["lights"], [...lights(editor.doc), light as unknown as Json], null) },
          [`Add ${LABELS[type]?.toLowerCase() ?? type}`]))),
    ],
  };
}

function lightFields(editor: Editor, bind: Binder, light: Json, place: Place): HTMLElement {
  const fields = new Fields(editor, bind);
  const type = kind(light);
  const remove = h("button", { type: "button", class: "small", "aria-label": `Remove light ${Number(place[1]) + 1}`, title: "Remove this light",
    onclick: () => editor.remove(place) }, ["×"]);
  const power = (key: string, label: string): HTMLElement => powerField(fields, { label, place: [...place, key], otherwise: [1, 1, 1] });
  const inner: Record<string, () => HTMLElement[]> = {
    directional: () => [sunFields(editor, bind, [...place, "direction"]), power("irradiance", "Irradiance")],
    point: () => [
      fields.tuple({ label: "Position", place: [...place, "position"], otherwise: [0, 0, 1] }, ["x", "y", "z"]),
      power("intensity", "Intensity"),
    ],
    constant: () => [power("radiance", "Radiance")],
    envmap: () => [h("p", { class: "muted" }, [text(entry(light, "file"), "?")])],
  };
  return h("fieldset", { "data-pointer": format(place), "data-marks": "quiet" }, [
    h("legend", {}, [`${Number(place[1]) + 1} · ${LABELS[type] ?? type}`, remove]), ...(inner[type]?.() ?? []),
  ]);
}

function sunFields(editor: Editor, bind: Binder, place: Place): HTMLElement {
  const angle = (label: string, key: keyof Sun, low: number, high: number): HTMLElement => {
    const id = freshId("angle");
    const put = (value: number): void => {
      const sun = { ...sunOf(at(editor.doc, place)), [key]: clamp(value, low, high) };
      editor.set(place, [...directionOf(sun)], format(place) + key);
    };
    const input = numberInput(id, put);
    const slider = h("input", { type: "range", min: low, max: high, step: 1, "aria-label": `${label}, slider`, tabindex: -1 });
    slider.addEventListener("input", () => put(Number(slider.value)));
    bind(() => {
      const value = Number(sunOf(at(editor.doc, place))[key].toFixed(1));
      show(input, value);
      slider.value = String(value);
    });
    return h("div", { class: "field with-slider" }, [
      h("label", { for: id, class: "label" }, [label]), h("div", { class: "controls" }, [slider, input, h("span", { class: "unit" }, ["°"])]),
    ]);
  };
  const sliders = h("div", { class: "stack" }, [angle("Azimuth", "azimuth", -180, 180), angle("Elevation", "elevation", -90, 90)]);
  return h("div", { class: "sun", "data-pointer": format(place) }, [lightSphere(editor, bind, place), sliders]);
}

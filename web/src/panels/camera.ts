/** The camera and how the picture is rendered. */
import type { Editor } from "../model/editor";
import { entry, isObject } from "../model/json";
import { format } from "../model/pointer";
import { orbitOf, withOrbit, type Orbit } from "../model/orbit";
import { freshId, h } from "../ui/dom";
import { Fields, numberInput, show } from "../ui/fields";
import type { Binder, PanelPlan } from "../ui/panel";

const METHODS = ["auto", "base", "segment", "line", "lines", "area", "csg", "geometry", "relief"].map((name) => [name, name] as const);

export function cameraPanel(editor: Editor): PanelPlan {
  return {
    title: "Camera and picture",
    key: () => "",
    build: (bind) => {
      const fields = new Fields(editor, bind);
      return [
        orbitField(editor, bind, "Azimuth", "azimuth", [-180, 180]),
        orbitField(editor, bind, "Elevation", "elevation", [-89, 89]),
        orbitField(editor, bind, "Distance", "distance"),
        fields.tuple({ label: "Target", place: ["camera", "target"], otherwise: [0, 0, 0] }, ["x", "y", "z"]),
        fields.number({ label: "Field of view", place: ["camera", "fov"], otherwise: 40, unit: "°" }),
        fields.tuple({ label: "Size", place: ["camera", "resolution"], otherwise: [640, 480] }, ["w", "h"]),
        fields.number({ label: "Exposure", place: ["render", "exposure"], otherwise: 1 }),
        fields.number({ label: "Bounces", place: ["render", "bounces"], otherwise: 0 }),
        fields.select({ label: "Method", place: ["render", "method"], otherwise: "auto" }, METHODS),
      ];
    },
  };
}

function orbitField(editor: Editor, bind: Binder, label: string, key: keyof Orbit, range?: readonly [number, number]): HTMLElement {
  const id = freshId("orbit");
  const put = (value: number): void => {
    const camera = entry(editor.doc, "camera");
    if (isObject(camera)) editor.set(["camera"], withOrbit(camera, { ...orbitOf(camera), [key]: value }), `orbit ${key}`);
  };
  const input = numberInput(id, put);
  const slider = h("input", {
    type: "range", min: range?.[0] ?? 0, max: range?.[1] ?? 1, step: 1, "aria-label": `${label}, slider`, tabindex: -1,
  });
  slider.addEventListener("input", () => put(Number(slider.value)));
  bind(() => {
    const value = Number(orbitOf(entry(editor.doc, "camera"))[key].toPrecision(4));
    show(input, value);
    slider.value = String(value);
  });
  const pointer = format(["camera", "origin"]);
  const controls = range ? [slider, input, h("span", { class: "unit" }, ["°"])] : [input];
  return h("div", { class: `field ${range ? "with-slider" : ""}`, "data-pointer": key === "distance" ? pointer : null }, [
    h("label", { for: id, class: "label" }, [label]), h("div", { class: "controls" }, controls),
  ]);
}

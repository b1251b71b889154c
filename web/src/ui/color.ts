/** Colour fields: linear RGB in the document, sRGB in the browser's picker. */
import { hexOf, joined, rgbOf, split } from "../model/light";
import { numbers } from "../model/json";
import { format } from "../model/pointer";
import { freshId, h } from "./dom";
import { numberInput, row, show, type Field, type Fields } from "./fields";

const GREY = [0, 0, 0] as const;

export function colorField(fields: Fields, field: Field): HTMLElement {
  const id = freshId("color");
  const input = h("input", { id, type: "color" });
  const values = h("span", { class: "muted code" });
  input.addEventListener("input", () => fields.editor.set(field.place, rgbOf(input.value)));
  fields.bind(() => {
    const rgb = numbers(fields.read(field), GREY);
    if (hexOf(rgb) !== input.value) input.value = hexOf(rgb);
    values.textContent = rgb.map((value) => value.toFixed(2)).join(" ");
  });
  return row(field, id, "", [input, values]);
}

/** A light's power: a strength and a colour. */
export function powerField(fields: Fields, field: Field): HTMLElement {
  const id = freshId("power");
  const power = (): ReturnType<typeof split> => split(numbers(fields.read(field), GREY));
  const key = format(field.place);
  const strength = numberInput(id, (value) => fields.editor.set(field.place, joined(value, power().color), key));
  const color = h("input", { type: "color", "aria-label": `${field.label}, colour` });
  color.addEventListener("input", () => {
    const picked = split(rgbOf(color.value)).color;
    fields.editor.set(field.place, joined(power().strength, picked), key);
  });
  fields.bind(() => {
    show(strength, power().strength);
    const hex = hexOf(power().color);
    if (hex !== color.value) color.value = hex;
  });
  return row(field, id, "", [strength, color]);
}

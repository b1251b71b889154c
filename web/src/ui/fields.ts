/** Fields that show one value of the document and change it. Each says by its pointer which one. */
import type { Editor } from "../model/editor";
import { at, number, withAt, type Json, type Place } from "../model/json";
import { format } from "../model/pointer";
import { freshId, h } from "./dom";
import type { Binder } from "./panel";

export interface Field {
  readonly label: string;
  readonly place: Place;
  /** What holds where the document has nothing. */
  readonly otherwise: Json;
  readonly title?: string;
}

export interface NumberField extends Field {
  readonly unit?: string;
  /** With both, a slider stands beside the number. */
  readonly range?: readonly [number, number];
}

export class Fields {
  constructor(readonly editor: Editor, readonly bind: Binder) {}

  read(field: Field): Json {
    return at(this.editor.doc, field.place) ?? field.otherwise;
  }

  number(field: NumberField): HTMLElement {
    const id = freshId("number");
    const pointer = format(field.place);
    const put = (value: number): void => this.editor.set(field.place, value, pointer);
    const input = numberInput(id, put);
    if (field.title) input.title = field.title;
    const [low, high] = field.range ?? [0, 0];
    const slider = h("input", {
      type: "range", min: low, max: high, step: (high - low) / 200, "aria-label": `${field.label}, slider`, tabindex: -1,
    });
    slider.addEventListener("input", () => put(Number(Number(slider.value).toPrecision(4))));
    this.bind(() => {
      const value = this.read(field);
      show(input, value);
      slider.value = String(number(value, 0));
    });
    const controls = field.range ? [slider, input] : [input];
    return row(field, id, field.range ? "with-slider" : "", controls, field.unit);
  }

  /** Several numbers of one array, each with its own small label. */
  tuple(field: Field, labels: readonly string[]): HTMLElement {
    const inputs = labels.map((label, index) => {
      const place = [...field.place, index];
      const fallback = Array.isArray(field.otherwise) ? (field.otherwise[index] ?? 0) : 0;
      // Where the array itself is missing, the whole of it is put there.
      const put = (value: number): void => {
        const whole = Array.isArray(this.read(field)) ? this.read(field) : field.otherwise;
        this.editor.set(field.place, withAt(whole, [index], value), format(place));
      };
      const input = numberInput(freshId("number"), put);
      input.setAttribute("aria-label", `${field.label} ${label}`);
      this.bind(() => show(input, at(this.editor.doc, place) ?? fallback));
      return h("span", { class: "part", "data-pointer": format(place) }, [h("span", { class: "axis" }, [label]), input]);
    });
    return row(field, null, "tuple", inputs);
  }

  select(field: Field, options: readonly (readonly [string, string])[], change?: (value: string) => void): HTMLElement {
    const id = freshId("select");
    const select = h("select", { id }, options.map(([value, label]) => h("option", { value }, [label])));
    const put = change ?? ((value: string) => this.editor.set(field.place, value, null));
    select.addEventListener("change", () => put(select.value));
    this.bind(() => showOption(select, this.read(field)));
    return row(field, id, "", [select]);
  }

  checkbox(field: Field): HTMLElement {
    const id = freshId("checkbox");
    const input = h("input", { id, type: "checkbox" });
    input.addEventListener("change", () => this.editor.set(field.place, input.checked, null));
    this.bind(() => (input.checked = this.read(field) === true));
    return row(field, id, "", [input]);
  }

  text(field: Field): HTMLElement {
    const id = freshId("text");
    const input = h("input", { id, type: "text", spellcheck: false, autocomplete: "off", class: "code" });
    input.addEventListener("change", () => this.editor.set(field.place, input.value, null));
    this.bind(() => {
      if (document.activeElement !== input) input.value = String(this.read(field));
    });
    return row(field, id, "wide", [input]);
  }

  /** JSON of any kind, in one line of text. */
  json(field: Field): HTMLElement {
    const id = freshId("json");
    const input = h("input", { id, type: "text", spellcheck: false, class: "code" });
    input.addEventListener("change", () => {
      try {
        this.editor.set(field.place, JSON.parse(input.value) as Json, null);
        input.setCustomValidity("");
      } catch {
        input.setCustomValidity("This is not JSON.");
        input.reportValidity();
      }
    });
    this.bind(() => document.activeElement !== input && (input.value = JSON.stringify(this.read(field))));
    return row(field, id, "wide", [input]);
  }
}

/** A label with its controls, where a problem of this place will be marked. */
export function row(field: Field, id: string | null, kind: string, controls: readonly Node[], unit?: string): HTMLElement {
  const label = id === null ? h("span", { class: "label" }, [field.label]) : h("label", { for: id, class: "label" }, [field.label]);
  if (field.title) label.title = field.title;
  const inner = h("div", { class: "controls" }, [...controls, ...(unit ? [h("span", { class: "unit" }, [unit])] : [])]);
  return h("div", { class: `field ${kind}`, "data-pointer": format(field.place), role: id === null ? "group" : null,
    "aria-label": id === null ? field.label : null }, [label, inner]);
}

/** Takes effect while typing, as soon as it is a number; the arrow keys change its leading digits. */
export function numberInput(id: string, put: (value: number) => void): HTMLInputElement {
  const input = h("input", { id, type: "text", inputmode: "decimal", autocomplete: "off" });
  input.addEventListener("input", () => {
    const value = input.value.trim() === "" ? NaN : Number(input.value.replace(",", "."));
    input.setCustomValidity(Number.isFinite(value) ? "" : "This is not a number.");
    input.classList.toggle("not-a-number", !Number.isFinite(value));
    if (Number.isFinite(value)) put(value);
  });
  input.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault();
    const value = Number(input.value) || 0;
    const step = (value === 0 ? 0.1 : 10 ** Math.floor(Math.log10(Math.abs(value)) - 0.7)) * (event.shiftKey ? 10 : 1);
    const next = Number((value + (event.key === "ArrowUp" ? step : -step)).toPrecision(6));
    input.value = String(next);
    put(next);
  });
  input.addEventListener("blur", () => {
    input.setCustomValidity("");
    input.classList.remove("not-a-number");
    input.value = input.dataset["value"] ?? input.value;
  });
  return input;
}

/** The value, unless it is the one being typed. */
export function show(input: HTMLInputElement, value: Json): void {
  const text = typeof value === "number" ? String(Number(value.toPrecision(10))) : JSON.stringify(value);
  input.dataset["value"] = text;
  if (document.activeElement !== input || Number(input.value) !== value) {
    if (!(document.activeElement === input && input.classList.contains("not-a-number"))) input.value = text;
  }
}

/** A value that is none of the choices is shown as what it is. */
function showOption(select: HTMLSelectElement, value: Json): void {
  const text = typeof value === "string" ? value : value === null ? "" : JSON.stringify(value);
  const isKnown = [...select.options].some((option) => option.value === text);
  if (!isKnown) select.append(h("option", { value: text }, [`${text} (?)`]));
  select.value = text;
}

/** A groove's material: the object's, one by name, or one a facet. */
import { section } from "../geometry/profile";
import { array, at, type Json, type Place } from "../model/json";
import { materialNames } from "../model/scene";
import { h } from "../ui/dom";
import type { Fields } from "../ui/fields";

const FACETS = 32; // with a field of their own, at most

export function grooveMaterial(fields: Fields, groove: Place): HTMLElement {
  const { editor } = fields;
  const place = [...groove, "material"];
  const value = at(editor.doc, place);
  const names = materialNames(editor.doc).map((name) => [`=${name}`, name] as const);
  const whole = { label: "Material", place, otherwise: null };
  const options = [["", "The object's"], ...names, ["[]", "One a facet"]] as const;
  const put = (choice: string): void => {
    if (choice === "") editor.set(place, null, null);
    else if (choice !== "[]") editor.set(place, choice.slice(1), null);
    else {
      const now = at(editor.doc, place);
      const facets = Math.max(1, section(at(editor.doc, [...groove, "profile"])).length - 1);
      editor.set(place, Array.from({ length: facets }, () => (typeof now === "string" ? now : null)), null);
    }
  };
  const choice = new Choice(fields, () => tag(at(editor.doc, place)));
  const facets = Array.isArray(value) ? array(value).slice(0, FACETS) : [];
  const rows = facets.map((_, index) => {
    const at_ = [...place, index];
    const label = `Facet ${index + 1}`;
    const inner = new Choice(fields, () => tag(at(editor.doc, at_)));
    return inner.select({ label, place: at_, otherwise: null }, [["", "The object's"], ...names], (name) =>
      editor.set(at_, name === "" ? null : name.slice(1), null));
  });
  return h("div", { class: "stack" }, [choice.select(whole, options, put), ...rows]);
}

const tag = (value: Json | undefined): string => (typeof value === "string" ? `=${value}` : Array.isArray(value) ? "[]" : "");

/** A select whose options stand for values. */
class Choice {
  constructor(readonly fields: Fields, readonly now: () => string) {}

  select(field: Parameters<Fields["select"]>[0], options: Parameters<Fields["select"]>[1], put: (value: string) => void): HTMLElement {
    const row = this.fields.select(field, options, put);
    const select = row.querySelector("select");
    this.fields.bind(() => {
      if (!select) return;
      const value = this.now();
      if (![...select.options].some((option) => option.value === value)) {
        select.append(h("option", { value }, [`${value.slice(1)} (missing)`]));
      }
      select.value = value;
    });
    return row;
  }
}

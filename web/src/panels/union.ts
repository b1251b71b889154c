/** The fields of a value that says its type, and the choice of the type. */
import { retyped } from "../model/edits";
import { at, type Json, type Place } from "../model/json";
import { kind } from "../model/scene";
import type { Fields } from "../ui/fields";
import type { FieldPlan, Kinds } from "./kinds";

export interface Union {
  readonly label: string;
  readonly place: Place;
  readonly kinds: Kinds;
  /** The type of a value that is not there; "" where there may be none. */
  readonly otherwise: string;
  /** Types to choose from, where these are not all. */
  readonly offered?: readonly string[];
  readonly fixed?: boolean;
}

export function unionFields(fields: Fields, union: Union): HTMLElement[] {
  const { editor } = fields;
  const value = at(editor.doc, union.place);
  const type = value === undefined || value === null ? union.otherwise : kind(value);
  const offered = Object.entries(union.kinds).filter(([name]) => name === type || (union.offered?.includes(name) ?? true));
  const options = offered.map(([name, { label }]) => [name, label] as const);
  const place = [...union.place, "type"];
  const choice = { label: union.label, place, otherwise: union.otherwise };
  const change = (name: string): void => {
    const now = at(editor.doc, union.place);
    if (name === "") editor.remove(union.place);
    else {
      const defaults = (union.kinds[name]?.fields ?? []).map(({ key, start }): [string, Json] => [key, start]);
      const old = Array.isArray(now) ? undefined : now;
      // A step of a row is a pair, that of circles a number: what does not fit starts anew.
      const fitting = defaults.filter(([key, start]) => sameForm(at(old, [key]), start));
      const kept = Object.fromEntries(fitting.map(([key]) => [key, at(old, [key]) ?? null]));
      editor.set(union.place, retyped(kept, name, Object.fromEntries(defaults)), null);
    }
  };
  const none = union.otherwise === "" ? [["", "None"] as const] : [];
  const selects = union.fixed ? [] : [fields.select(choice, [...none, ...options], change)];
  const plans = union.kinds[type]?.fields ?? [];
  return [...selects, ...plans.map((plan) => planned(fields, union.place, plan))];
}

function sameForm(a: Json | undefined, b: Json): boolean {
  return a !== undefined && typeof a === typeof b && Array.isArray(a) === Array.isArray(b);
}

export function planned(fields: Fields, parent: Place, plan: FieldPlan): HTMLElement {
  const base = { label: plan.label, place: [...parent, plan.key], otherwise: plan.start };
  if (plan.as === "checkbox") return fields.checkbox(base);
  if (plan.as === "json") return fields.json(base);
  if (plan.as === "text") return fields.text(base);
  if (plan.as !== "number") return fields.tuple(base, plan.as);
  return fields.number({ ...base, ...(plan.unit ? { unit: plan.unit } : {}), ...(plan.range ? { range: plan.range } : {}) });
}

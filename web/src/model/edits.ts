/** Changes of a scene document as pure functions: a document in, a document out. */
import type { Groove } from "../api/types";
import { at, entry, isObject, object, withAt, without, type Json } from "./json";
import { freeName, groovePlace, grooves, groovesPlace, objects, patternNames, type Target } from "./scene";

/** Types of OpenAPI are JSON, though TypeScript cannot see it. */
export const asJson = (value: Groove | Groove["profile"] | Groove["path"]): Json => value as unknown as Json;

export interface Added {
  readonly doc: Json;
  readonly target: Target;
  readonly groove: number;
}

/** The document with one groove more at the end of the target's pattern, which is made where there is none. */
export function addGroove(doc: Json, target: Target, groove: Json): Added {
  if (target.pattern !== null) {
    const all = grooves(doc, target.pattern);
    return { doc: withAt(doc, groovesPlace(target.pattern), [...all, groove]), target, groove: all.length };
  }
  const pattern = freeName("pattern", patternNames(doc));
  let next = withAt(doc, ["patterns", pattern], { grooves: [groove] });
  if (target.object !== null) next = withAt(next, ["objects", target.object, "pattern"], pattern);
  return { doc: next, target: { ...target, pattern }, groove: 0 };
}

/** The document without one groove. A pattern must have one, so that the last takes its pattern along. */
export function removeGroove(doc: Json, pattern: string, index: number): Json {
  if (grooves(doc, pattern).length > 1) return without(doc, groovePlace(pattern, index));
  let next = without(doc, ["patterns", pattern]);
  for (const [number, item] of objects(doc).entries()) {
    if (entry(item, "pattern") === pattern) next = withAt(next, ["objects", number, "pattern"], null);
  }
  return next;
}

/** A copy of a groove right after it. */
export function duplicateGroove(doc: Json, pattern: string, index: number, path: Json): Json {
  const all = grooves(doc, pattern);
  const copy = { ...object(all[index]), path };
  return withAt(doc, groovesPlace(pattern), [...all.slice(0, index + 1), copy, ...all.slice(index + 1)]);
}

/** The document with a material under another name, and every use of the old name changed. */
export function renameMaterial(doc: Json, from: string, to: string): Json {
  const renamed = Object.entries(object(entry(doc, "materials"))).map(([name, material]) => [
    name === from ? to : name,
    material,
  ]);
  let next = withAt(doc, ["materials"], Object.fromEntries(renamed) as Json);
  for (const [index, item] of objects(next).entries()) {
    if (entry(item, "material") === from) next = withAt(next, ["objects", index, "material"], to);
  }
  const rename = (name: Json): Json => (name === from ? to : name);
  for (const pattern of patternNames(next)) {
    for (const [index, groove] of grooves(next, pattern).entries()) {
      const material = entry(groove, "material");
      if (material === from || (Array.isArray(material) && material.includes(from))) {
        const changed = Array.isArray(material) ? material.map(rename) : rename(material);
        next = withAt(next, [...groovePlace(pattern, index), "material"], changed);
      }
    }
  }
  return next;
}

/** Whether any object or groove is made of a material. */
export function usesMaterial(doc: Json, name: string): boolean {
  if (objects(doc).some((item) => entry(item, "material") === name)) return true;
  return patternNames(doc).some((pattern) =>
    grooves(doc, pattern).some((groove) => {
      const material = entry(groove, "material");
      return material === name || (Array.isArray(material) && material.includes(name));
    }),
  );
}

/** Another type of a union: the fields that both have are kept, the others take the given defaults. */
export function retyped(value: Json | undefined, type: string, defaults: Record<string, Json>): Json {
  const old = object(value);
  const fields = Object.entries(defaults).map(([key, fallback]) => [key, Object.hasOwn(old, key) ? old[key] : fallback]);
  return { type, ...(Object.fromEntries(fields) as Record<string, Json>) };
}

/** Sets a value, or takes its key away where `value` is null and null is the default. */
export function setOrDrop(doc: Json, place: readonly (string | number)[], value: Json | null): Json {
  if (value !== null) return withAt(doc, place, value);
  return isObject(at(doc, place.slice(0, -1))) ? without(doc, place) : doc;
}

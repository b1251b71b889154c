/** Where things are in a scene document. */
import { array, at, entry, isObject, object, text, type Json, type Place } from "./json";

export const groovesPlace = (pattern: string): Place => ["patterns", pattern, "grooves"];
export const groovePlace = (pattern: string, index: number): Place => [...groovesPlace(pattern), index];

export function grooves(doc: Json, pattern: string | null): Json[] {
  return pattern === null ? [] : array(at(doc, groovesPlace(pattern)));
}

export const patternNames = (doc: Json): string[] => Object.keys(object(entry(doc, "patterns")));
export const materialNames = (doc: Json): string[] => Object.keys(object(entry(doc, "materials")));
export const objects = (doc: Json): Json[] => array(entry(doc, "objects"));
export const lights = (doc: Json): Json[] => array(entry(doc, "lights"));

/** The type of a value that says so, as paths, profiles and lights do. */
export const kind = (value: Json | undefined): string => text(entry(value, "type"), "?");

/** What the canvas shows: a pattern, and the object that it is seen on (none for a pattern that nothing uses). */
export interface Target {
  readonly object: number | null;
  readonly pattern: string | null;
}

export function targets(doc: Json): Target[] {
  const used = objects(doc).map((item, index) => {
    const name = entry(item, "pattern");
    return { object: index, pattern: typeof name === "string" && isObject(at(doc, ["patterns", name])) ? name : null };
  });
  const unused = patternNames(doc).filter((name) => !used.some((target) => target.pattern === name));
  return [...used, ...unused.map((pattern) => ({ object: null, pattern }))];
}

/** The same target in a changed document, or the first that there is. */
export function kept(doc: Json, target: Target): Target {
  const all = targets(doc);
  return (
    (target.object !== null ? all.find((one) => one.object === target.object) : undefined) ??
    all.find((one) => one.pattern === target.pattern && target.pattern !== null) ??
    all[0] ?? { object: null, pattern: null }
  );
}

/** The first target worth a look: an object with a pattern. */
export function firstTarget(doc: Json): Target {
  const all = targets(doc);
  return all.find((one) => one.pattern !== null) ?? all[0] ?? { object: null, pattern: null };
}

/** A name that is not taken yet, as in material-2. */
export function freeName(stem: string, taken: readonly string[]): string {
  if (!taken.includes(stem)) return stem;
  let number = 2;
  while (taken.includes(`${stem}-${number}`)) number += 1;
  return `${stem}-${number}`;
}

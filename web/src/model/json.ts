/**
 * A scene document as it is: any JSON. The page reads it with tolerance, so that what the service refuses stays
 * editable, and changes only what was edited: everything else is kept by reference.
 */
export type Json = null | boolean | number | string | Json[] | JsonObject;
export interface JsonObject {
  [key: string]: Json;
}
/** The way from a document's root to one of its values. */
export type Place = readonly (string | number)[];

export function isObject(value: Json | undefined): value is JsonObject {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

/** One step down; undefined where there is nothing. */
export function entry(value: Json | undefined, key: string | number): Json | undefined {
  if (Array.isArray(value)) return value[Number(key)];
  return isObject(value) && Object.hasOwn(value, key) ? value[key] : undefined;
}

export function at(value: Json | undefined, place: Place): Json | undefined {
  return place.reduce<Json | undefined>(entry, value);
}

export function object(value: Json | undefined): JsonObject {
  return isObject(value) ? value : {};
}

export function array(value: Json | undefined): Json[] {
  return Array.isArray(value) ? value : [];
}

export function number(value: Json | undefined, otherwise: number): number {
  return typeof value === "number" && Number.isFinite(value) ? value : otherwise;
}

export function text(value: Json | undefined, otherwise: string): string {
  return typeof value === "string" ? value : otherwise;
}

/** The numbers of an array of fixed length; what is missing or no number comes from `otherwise`. */
export function numbers<T extends readonly number[]>(value: Json | undefined, otherwise: T): T {
  return otherwise.map((fallback, index) => number(entry(value, index), fallback)) as unknown as T;
}

/** The document with one value put in place; objects on the way are made where they are missing. */
export function withAt(value: Json | undefined, place: Place, next: Json): Json {
  const [key, ...rest] = place;
  if (key === undefined) return next;
  if (Array.isArray(value)) {
    const copy = [...value];
    copy[Number(key)] = withAt(value[Number(key)], rest, next);
    return copy;
  }
  const inner = withAt(entry(value, key), rest, next);
  return { ...object(value), [key]: inner };
}

/** The document without one value; the items after one of an array move up. */
export function without(value: Json | undefined, place: Place): Json {
  const key = place.at(-1);
  if (key === undefined) return null;
  const parent = at(value, place.slice(0, -1));
  if (Array.isArray(parent)) {
    return withAt(value, place.slice(0, -1), parent.filter((_, index) => index !== Number(key)));
  }
  if (!isObject(parent) || !Object.hasOwn(parent, key)) return value ?? null;
  const kept = Object.fromEntries(Object.entries(parent).filter(([name]) => name !== String(key)));
  return withAt(value, place.slice(0, -1), kept);
}

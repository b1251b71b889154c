/** JSON pointers (RFC 6901). */
import type { Place } from "./json";

export type Pointer = string;

export function format(place: Place): Pointer {
  return place.map((part) => "/" + String(part).replaceAll("~", "~0").replaceAll("/", "~1")).join("");
}

export function parse(pointer: Pointer): string[] {
  if (pointer === "") return [];
  return pointer
    .slice(1)
    .split("/")
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** Whether `inner` is the place `outer` or lies below it. */
export function covers(outer: Pointer, inner: Pointer): boolean {
  return inner === outer || inner.startsWith(outer + "/");
}

/** Scene files as text: read with a clear error, written with short values on one line. */
import { isObject, type Json } from "./json";

const WIDTH = 110;

export class NotAScene extends Error {}

export function parseScene(source: string): Json {
  let value: Json;
  try {
    value = JSON.parse(source) as Json;
  } catch (error) {
    throw new NotAScene(`This is not JSON: ${error instanceof Error ? error.message : String(error)}`);
  }
  if (!isObject(value)) throw new NotAScene("A scene is a JSON object; this file holds something else.");
  return value;
}

export function formatScene(value: Json): string {
  return lines(value, "", 0) + "\n";
}

function lines(value: Json, indent: string, taken: number): string {
  const short = inline(value);
  if (indent.length + taken + short.length <= WIDTH && indent !== "") return short;
  const inner = indent + "  ";
  if (Array.isArray(value) && value.length > 0) {
    const flat = value.every((item) => typeof item !== "object" || Array.isArray(item));
    const items = flat ? filled(value.map(inline), inner) : value.map((item) => inner + lines(item, inner, 1)).join(",\n");
    return `[\n${items}\n${indent}]`;
  }
  if (isObject(value) && Object.keys(value).length > 0) {
    const members = Object.entries(value).map(([key, item]) => {
      const name = `${JSON.stringify(key)}: `;
      return inner + name + lines(item, inner, name.length + 1);
    });
    return `{\n${members.join(",\n")}\n${indent}}`;
  }
  return short;
}

/** Many small items, as many on a line as there is room for. */
function filled(items: string[], indent: string): string {
  const rows: string[] = [];
  let row = "";
  for (const [index, item] of items.entries()) {
    const piece = index < items.length - 1 ? `${item},` : item;
    if (row !== "" && indent.length + row.length + piece.length + 1 > WIDTH) {
      rows.push(indent + row);
      row = piece;
    } else row = row === "" ? piece : `${row} ${piece}`;
  }
  return [...rows, indent + row].join("\n");
}

function inline(value: Json): string {
  if (Array.isArray(value)) return `[${value.map(inline).join(", ")}]`;
  if (!isObject(value)) return JSON.stringify(value);
  return `{${Object.entries(value).map(([key, item]) => `${JSON.stringify(key)}: ${inline(item)}`).join(", ")}}`;
}

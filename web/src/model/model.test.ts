import { describe, expect, it } from "vitest";
import { addGroove, removeGroove, renameMaterial, retyped } from "./edits";
import { begin, changed, DRAG, redone, undone } from "./history";
import { without, withAt, type Json } from "./json";
import { orbitOf, withOrbit } from "./orbit";
import { directionOf, hexOf, rgbOf, sunOf } from "./light";
import { covers, format, parse } from "./pointer";
import { formatScene, NotAScene, parseScene } from "./text";

const groove = (material: Json = null): Json => ({ path: { type: "polyline", points: [[0, 0], [1, 0]] }, material });
const scene = (): Json => ({
  materials: { stone: {}, brass: {} },
  patterns: { a: { tile: [1, 2], grooves: [groove("stone"), groove(["stone", null])] }, "b/~": { grooves: [groove()] } },
  objects: [{ material: "stone", pattern: "a" }, { material: "brass", pattern: "b/~" }],
});

describe("documents", () => {
  it("share what an edit leaves alone", () => {
    const doc = scene() as { patterns: { a: Json; "b/~": Json } };
    const next = withAt(doc as unknown as Json, ["patterns", "a", "grooves", 1, "priority"], 3) as typeof doc;
    expect(next.patterns["b/~"]).toBe(doc.patterns["b/~"]);
    expect(next.patterns.a).not.toBe(doc.patterns.a);
  });

  it("keep keys that look like the language's own", () => {
    const doc = parseScene('{"__proto__": {"a": 1}, "x": [1]}');
    expect(JSON.stringify(withAt(doc, ["x", 0], 2))).toBe('{"__proto__":{"a":1},"x":[2]}');
    expect(JSON.stringify(without(doc, ["__proto__"]))).toBe('{"x":[1]}');
  });

  it("survive being written and read", () => {
    expect(parseScene(formatScene(scene()))).toEqual(scene());
    expect(formatScene({ a: [[1, 2], [3, 4]] })).toBe('{\n  "a": [[1, 2], [3, 4]]\n}\n');
    expect(Math.max(...formatScene(withAt(scene(), ["n"], Array(500).fill(0.5))).split("\n").map((l) => l.length))).toBeLessThan(112);
  });

  it.each(["", "[1]", "null", "{", "3"])("are JSON objects, which %j is not", (text) => {
    expect(() => parseScene(text)).toThrow(NotAScene);
  });
});

describe("pointers", () => {
  it("escape what they must", () => {
    expect(format(["patterns", "b/~", 0])).toBe("/patterns/b~1~0/0");
    expect(parse("/patterns/b~1~0/0")).toEqual(["patterns", "b/~", "0"]);
    expect(parse("")).toEqual([]);
  });

  it("cover what lies below them, and not what merely begins alike", () => {
    expect(covers("/a/1", "/a/1/b")).toBe(true);
    expect(covers("/a/1", "/a/10")).toBe(false);
  });
});

describe("edits", () => {
  it("add a groove, and the pattern where there is none", () => {
    const bare = { objects: [{ pattern: null }], patterns: { pattern: { grooves: [groove()] } } };
    const added = addGroove(bare, { object: 0, pattern: null }, groove());
    expect(added.doc).toMatchObject({ objects: [{ pattern: "pattern-2" }], patterns: { "pattern-2": { grooves: [groove()] } } });
    expect(addGroove(scene(), { object: 0, pattern: "a" }, groove()).groove).toBe(2);
  });

  it("take a pattern away with its last groove", () => {
    const once = removeGroove(scene(), "a", 0);
    expect(once).toMatchObject({ patterns: { a: { tile: [1, 2], grooves: [groove(["stone", null])] } } });
    const twice = removeGroove(once, "a", 0) as { patterns: object };
    expect(Object.keys(twice.patterns)).toEqual(["b/~"]);
    expect(twice).toMatchObject({ objects: [{ pattern: null }, { pattern: "b/~" }] });
  });

  it("rename a material wherever it is used, in its place", () => {
    const next = renameMaterial(scene(), "stone", "slate") as { materials: object };
    expect(Object.keys(next.materials)).toEqual(["slate", "brass"]);
    expect(next).toMatchObject({
      objects: [{ material: "slate" }, { material: "brass" }],
      patterns: { a: { grooves: [{ material: "slate" }, { material: ["slate", null] }] } },
    });
  });

  it("keep the fields that two types share", () => {
    expect(retyped({ type: "v", width: 2, depth: 1 }, "round", { width: 9, depth: 9, facets: 16 }))
      .toEqual({ type: "round", width: 2, depth: 1, facets: 16 });
  });
});

describe("history", () => {
  it("goes back and forth", () => {
    const three = changed(changed(begin(1), 2, null, 0), 3, null, 0);
    expect(undone(three).present).toBe(2);
    expect(redone(undone(undone(three))).present).toBe(2);
    expect(undone(begin(1))).toEqual(begin(1));
    expect(redone(changed(undone(three), 4, null, 0)).present).toBe(4);
  });

  it("makes one step of a drag, and of typing without a pause", () => {
    const drag = changed(changed(begin(1), 2, `${DRAG}1`, 0), 3, `${DRAG}1`, 60_000);
    expect(undone(drag).present).toBe(1);
    const typed = changed(changed(begin(1), 2, "/width", 0), 3, "/width", 500);
    expect(undone(typed).present).toBe(1);
    expect(undone(changed(typed, 4, "/width", 9000)).present).toBe(3);
    expect(undone(changed(typed, 4, "/depth", 600)).present).toBe(3);
  });
});

describe("camera and light", () => {
  it.each([[0, -3, 2], [1, 2, 0.5], [-4, 0.1, -1]])("orbit and back: %f %f %f", (...origin) => {
    const camera = { origin, target: [0.5, 0, 0], up: [0, 0, 1] };
    const back = withOrbit(camera, orbitOf(camera)) as { origin: number[] };
    for (const axis of [0, 1, 2]) expect(back.origin[axis]).toBeCloseTo(origin[axis] ?? NaN, 5);
  });

  it("measures the azimuth from +x to +y where up is z", () => {
    expect(orbitOf({ origin: [0, 2, 0], target: [0, 0, 0] }).azimuth).toBeCloseTo(90);
    expect(orbitOf({ origin: [3, 0, 0], target: [0, 0, 0], up: [0, 0, 2] })).toMatchObject({ azimuth: 0, elevation: 0, distance: 3 });
  });

  it("stands the sun where the light comes from", () => {
    expect(sunOf([-1, 0, -1])).toMatchObject({ azimuth: 0, elevation: 45 });
    const sun = sunOf([...directionOf({ azimuth: 130, elevation: 20 })]);
    expect(sun.azimuth).toBeCloseTo(130, 1);
    expect(sun.elevation).toBeCloseTo(20, 1);
  });

  it("shows linear colours as sRGB", () => {
    expect(hexOf([0.2140, 1, 0])).toBe("#7fff00"); // 0.2140 is sRGB 0.5
    expect(hexOf(rgbOf("#3c78f0"))).toBe("#3c78f0");
  });
});

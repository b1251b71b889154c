import { describe, expect, it } from "vitest";
import { band } from "./band";
import { chains } from "./flatten";
import { handles, moved, withHandle, withoutHandle, withPoint } from "./handles";
import { placed, placements, unplaced } from "./placements";
import { section, strip } from "./profile";
import { scaling } from "./scaling";
import { smoothPath } from "./smooth";
import { formatCommands, parseCommands } from "./svgcommands";
import { pattern, rounded } from "./units";
import type { Json } from "../model/json";

describe("SVG path data", () => {
  it("become absolute commands", () => {
    expect(formatCommands(parseCommands("m1,2 3-4h5V6z l1 1"))).toBe("M 1 2 L 4 -2 L 9 -2 L 9 6 Z L 2 3");
    expect(formatCommands(parseCommands("M0 0C1 1 2 1 3 0S5-1 6 0"))).toBe("M 0 0 C 1 1 2 1 3 0 C 4 -1 5 -1 6 0");
    expect(formatCommands(parseCommands("M0 0q1 1 2 0t2 0"))).toBe("M 0 0 Q 1 1 2 0 Q 3 -1 4 0");
    expect(formatCommands(parseCommands("M0 0a1 1 0 01.5.5"))).toBe("M 0 0 A 1 1 0 0 1 0.5 0.5");
  });

  it("are read up to the first mistake", () => {
    expect(formatCommands(parseCommands("M0 0 L1 1 L2 oops"))).toBe("M 0 0 L 1 1");
    expect(parseCommands("L1 1")).toEqual([]);
  });

  it("draw half circles as arcs, with y up or down", () => {
    for (const flip of [false, true]) {
      const [chain] = chains({ type: "svg", d: "M1 0A1 1 0 0 1 -1 0", flip_y: flip });
      for (const [p, q] of chain?.points ?? []) {
        expect(Math.hypot(p, q)).toBeCloseTo(1, 9);
        expect(flip ? -q : q).toBeGreaterThan(-1e-9);
      }
    }
  });

  it("that are smooth go through the points drawn", () => {
    const [chain] = chains({ type: "svg", d: smoothPath([pattern(0, 0), pattern(1, 2), pattern(3, 1)], 0.01) });
    for (const point of [[0, 0], [1, 2], [3, 1]]) expect(chain?.points).toContainEqual(point);
  });
});

describe("handles", () => {
  const line: Json = { type: "polyline", points: [[0, 0], [1, 0], [1, 1]] };

  it("move, come and go", () => {
    expect(withHandle(line, 1, pattern(2.04, 3.06), 0.1)).toMatchObject({ points: [[0, 0], [2, 3.1], [1, 1]] });
    expect(moved(line, pattern(0.1, 0.2), 0.1)).toMatchObject({ points: [[0.1, 0.2], [1.1, 0.2], [1.1, 1.2]] });
    expect(withPoint(line, 0, pattern(0.5, 0), 0.1)).toMatchObject({ points: [[0, 0], [0.5, 0], [1, 0], [1, 1]] });
    expect(withoutHandle(line, 0)).toMatchObject({ points: [[1, 0], [1, 1]] });
    expect(withoutHandle({ type: "polyline", points: [[0, 0], [1, 0]] }, 0)).toBeNull();
  });

  it("of curves take their control points along", () => {
    const path: Json = { type: "svg", d: "M 0 0 C 1 0 2 1 3 1 C 4 1 5 0 6 0" };
    const roles = handles(path).map(({ role }) => role);
    expect(roles).toEqual(["corner", "control", "control", "corner", "control", "control", "corner"]);
    expect(withHandle(path, 3, pattern(3, 2), 0.1)).toMatchObject({ d: "M 0 0 C 1 0 2 2 3 2 C 4 2 5 0 6 0" });
    expect(withHandle(path, 1, pattern(1, 1), 0.1)).toMatchObject({ d: "M 0 0 C 1 1 2 1 3 1 C 4 1 5 0 6 0" });
    expect(moved({ type: "svg", d: "M0 0L1 1", flip_y: true }, pattern(1, 1), 0.1)).toMatchObject({ d: "M 1 -1 L 2 0" });
  });

  it("leave paths in world space alone", () => {
    const world: Json = { type: "polyline", space: "world", points: [[0, 0, 1], [1, 0, 1]] };
    expect(handles(world)).toEqual([]);
    expect(moved(world, pattern(1, 1), 0.1)).toBe(world);
  });
});

describe("bands", () => {
  const constant = scaling(undefined);
  const across = (polygons: ReturnType<typeof band>, axis: 0 | 1): [number, number] => {
    const all = polygons.flat().map((point) => point[axis]);
    return [Math.min(...all), Math.max(...all)];
  };

  it("have the groove's width, b positive to the left", () => {
    const chain = { points: [pattern(0, 0), pattern(4, 0)], closed: false };
    const flat = band(chain, [-0.25, 1], constant, false);
    expect([across(flat, 0), across(flat, 1)]).toEqual([[0, 4], [-0.25, 1]]);
    expect(across(band(chain, [-0.5, 0.5], constant, true), 0)).toEqual([-0.5, 4.5]);
  });

  it("are mitred at corners", () => {
    const [polygon] = band({ points: [pattern(0, 0), pattern(4, 0), pattern(4, 4)], closed: false }, [-1, 1], constant, false);
    const corners = (polygon ?? []).map(([p, q]) => `${p.toFixed(6)} ${q.toFixed(6)}`);
    expect(corners).toContain("3.000000 1.000000");
    expect(corners).toContain("5.000000 -1.000000");
  });

  it("follow the scale along the path", () => {
    const chain = { points: [pattern(0, 0), pattern(4, 0)], closed: false };
    const [polygon] = band(chain, [-1, 1], scaling({ type: "linear", start: 1, end: 0 }), false);
    for (const [p, q] of polygon ?? []) expect(Math.abs(q)).toBeCloseTo(1 - p / 4, 6);
  });
});

describe("profiles", () => {
  it("are those of the renderer", () => {
    expect(section({ type: "trapezoid", width: 2, floor: 1, depth: 0.5 })).toEqual([[-1, 0], [-0.5, -0.5], [0.5, -0.5], [1, 0]]);
    const half = section({ type: "round", width: 2, depth: 1, facets: 8 });
    expect(half).toHaveLength(9);
    for (const [b, w] of half) expect(Math.hypot(b, w)).toBeCloseTo(1, 9);
    expect(section({ type: "round", width: 2, depth: -0.5, facets: 2 })[1]).toEqual([0, 0.5]);
    expect(strip({ type: "scratch", width: 1, depth: 1, lip_width: 0.5, lip_height: 0.1 })).toEqual([-1, 1]);
    expect(section({ type: "new" })).toEqual([]);
  });
});

describe("copies", () => {
  it("stand where the renderer puts them", () => {
    expect(placements({ type: "grid", counts: [2, 2], steps: [[1, 0], [0, 3]] }).map(({ p, q }) => [p, q]))
      .toEqual([[0, 0], [0, 3], [1, 0], [1, 3]]);
    const scattered = placements({ type: "scatter", count: 1000, seed: 7, bounds: [0, 10, 1, 20] });
    expect(scattered).toHaveLength(600);
    // What renderer.repeats.scatter(2, 7, (0, 10, 1, 20), (0, 360), (1, 1)) gives.
    expect(scattered.slice(0, 2).map(({ p, q, angle }) => [p, q, angle])).toEqual(SCATTERED);
  });

  it("can be undone", () => {
    const placement = { p: 3, q: -1, angle: 0.7, scale: 2 };
    const [p, q] = unplaced(placement, placed(placement, [0.3, 0.4]));
    expect([p, q].map((value) => rounded(value, 1e-9))).toEqual([0.3, 0.4]);
  });
});

const SCATTERED = [
  [0.5243459416779314, 13.021390332168428, 5.9124536945527],
  [0.6636875270670158, 13.446067465363782, 2.503704565162979],
];

/** SVG path data: read into absolute commands, written again. */

/** M and L: x y · C: x1 y1 x2 y2 x y · Q: x1 y1 x y · A: rx ry turn large sweep x y · Z: nothing. */
export interface Command {
  readonly name: "M" | "L" | "C" | "Q" | "A" | "Z";
  readonly numbers: readonly number[];
}

const COUNTS: Record<string, number> = { M: 2, L: 2, H: 1, V: 1, C: 6, S: 4, Q: 4, T: 2, A: 7, Z: 0 };
const NUMBER = /[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?/y;

/** The commands up to the first mistake: as SVG asks, what stands before it is drawn. */
export function parseCommands(d: string): Command[] {
  const commands: Command[] = [];
  const reader = new Reader(d);
  let x = 0, y = 0, startX = 0, startY = 0; // the current point, and where the subpath began
  let controlX = 0, controlY = 0, before = ""; // the last control point, for the smooth commands
  for (let letter = reader.letter(); letter !== null; letter = reader.letter()) {
    const upper = letter.toUpperCase();
    const relative = letter !== upper;
    let name = upper;
    do {
      const raw = reader.numbers(COUNTS[upper] ?? 0, upper === "A");
      if (raw === null || (commands.length === 0 && upper !== "M")) return commands;
      const ox = relative ? x : 0, oy = relative ? y : 0;
      const made = absolute(name, raw, ox, oy, { x, y, controlX, controlY, before });
      if (made.name === "Z") [x, y] = [startX, startY];
      else [x, y] = made.numbers.slice(-2) as [number, number];
      if (made.name === "M") [startX, startY] = [x, y];
      const isCurve = made.name === "C" || made.name === "Q";
      [controlX, controlY] = isCurve ? (made.numbers.slice(-4, -2) as [number, number]) : [x, y];
      before = made.name;
      commands.push(made);
      if (name === "M") name = "L"; // further pairs are lines
    } while (upper !== "Z" && reader.hasNumber());
  }
  return commands;
}

interface Pen {
  x: number;
  y: number;
  controlX: number;
  controlY: number;
  before: string;
}

function absolute(name: string, n: readonly number[], ox: number, oy: number, pen: Pen): Command {
  const moved = n.map((value, index) => value + (index % 2 === 0 ? ox : oy));
  const reflected = (kind: string): number[] =>
    pen.before === kind ? [2 * pen.x - pen.controlX, 2 * pen.y - pen.controlY] : [pen.x, pen.y];
  switch (name) {
    case "H":
      return { name: "L", numbers: [(n[0] ?? 0) + ox, pen.y] };
    case "V":
      return { name: "L", numbers: [pen.x, (n[0] ?? 0) + oy] };
    case "S":
      return { name: "C", numbers: [...reflected("C"), ...moved] };
    case "T":
      return { name: "Q", numbers: [...reflected("Q"), ...moved] };
    case "A":
      return { name: "A", numbers: [...n.slice(0, 5), (n[5] ?? 0) + ox, (n[6] ?? 0) + oy] };
    default:
      return { name: name as Command["name"], numbers: moved };
  }
}

class Reader {
  #at = 0;

  constructor(readonly text: string) {}

  #skip(pattern: RegExp): void {
    while (this.#at < this.text.length && pattern.test(this.text.charAt(this.#at))) this.#at += 1;
  }

  letter(): string | null {
    this.#skip(/[\s,]/);
    const found = this.text.charAt(this.#at);
    if (!/[MLHVCSQTAZ]/i.test(found) || found === "") return null;
    this.#at += 1;
    return found;
  }

  hasNumber(): boolean {
    this.#skip(/[\s,]/);
    return /[\d.+-]/.test(this.text.charAt(this.#at));
  }

  /** The flags of an arc are single digits that nothing need set apart. */
  numbers(count: number, isArc: boolean): number[] | null {
    const found: number[] = [];
    while (found.length < count) {
      this.#skip(/[\s,]/);
      NUMBER.lastIndex = this.#at;
      const flag = isArc && (found.length === 3 || found.length === 4);
      const match = flag ? /^[01]/.exec(this.text.charAt(this.#at)) : NUMBER.exec(this.text);
      if (!match) return null;
      this.#at += match[0].length;
      found.push(Number(match[0]));
    }
    return found;
  }
}

export function formatCommands(commands: readonly Command[]): string {
  return commands.map(({ name, numbers }) => (numbers.length ? `${name} ${numbers.join(" ")}` : name)).join(" ");
}

/** The commands with every coordinate put through `move`; radii and angles of arcs stay. */
export function mapped(
  commands: readonly Command[],
  move: (x: number, y: number, command: number, pair: number) => readonly [number, number],
): Command[] {
  return commands.map(({ name, numbers }, index) => {
    const first = name === "A" ? 5 : 0;
    const next = [...numbers];
    for (let at = first; at + 1 < numbers.length; at += 2) {
      [next[at], next[at + 1]] = move(numbers[at] ?? 0, numbers[at + 1] ?? 0, index, (at - first) / 2);
    }
    return { name, numbers: next };
  });
}

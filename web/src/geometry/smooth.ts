/** A smooth curve through points: Catmull and Rom's, as the cubic Bézier curves of an SVG path. */
import { formatCommands, type Command } from "./svgcommands";
import { rounded, type PatternPoint } from "./units";

/** Path data with one C command from each point to the next, rounded to `step`. */
export function smoothPath(points: readonly PatternPoint[], step: number): string {
  const at = (index: number): PatternPoint => points[Math.min(points.length - 1, Math.max(0, index))] as PatternPoint;
  const numbers = (values: number[]): number[] => values.map((value) => rounded(value, step));
  const commands: Command[] = [{ name: "M", numbers: numbers([...at(0)]) }];
  for (let index = 0; index + 1 < points.length; index += 1) {
    const [a, b, c, d] = [at(index - 1), at(index), at(index + 1), at(index + 2)];
    const leaving = [b[0] + (c[0] - a[0]) / 6, b[1] + (c[1] - a[1]) / 6];
    const arriving = [c[0] - (d[0] - b[0]) / 6, c[1] - (d[1] - b[1]) / 6];
    commands.push({ name: "C", numbers: numbers([...leaving, ...arriving, ...c]) });
  }
  return formatCommands(commands);
}

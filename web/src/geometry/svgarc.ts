/** SVG's elliptical arcs: from end points to a centre (SVG 1.1, F.6.5 and F.6.6), and points along them. */
const STEP = Math.PI / 24;

export function arcPoints(from: readonly [number, number], n: readonly number[]): (readonly [number, number])[] {
  const [rx0 = 0, ry0 = 0, turn = 0, large = 0, sweep = 0, x = 0, y = 0] = n;
  const end = [[x, y] as const];
  let rx = Math.abs(rx0), ry = Math.abs(ry0);
  if (rx === 0 || ry === 0 || (x === from[0] && y === from[1])) return end;
  const cos = Math.cos((turn * Math.PI) / 180), sin = Math.sin((turn * Math.PI) / 180);
  const dx = (from[0] - x) / 2, dy = (from[1] - y) / 2;
  const u = cos * dx + sin * dy, v = cos * dy - sin * dx;
  const grow = Math.sqrt((u / rx) ** 2 + (v / ry) ** 2);
  if (grow > 1) [rx, ry] = [rx * grow, ry * grow]; // too small radii are scaled up
  const rest = (rx * ry) ** 2 / ((rx * v) ** 2 + (ry * u) ** 2) - 1;
  const factor = Math.sqrt(Math.max(0, rest)) * (large === sweep ? -1 : 1);
  const cu = (factor * rx * v) / ry, cv = (-factor * ry * u) / rx;
  const centerX = cos * cu - sin * cv + (from[0] + x) / 2;
  const centerY = sin * cu + cos * cv + (from[1] + y) / 2;
  const first = Math.atan2((v - cv) / ry, (u - cu) / rx);
  let swept = Math.atan2((-v - cv) / ry, (-u - cu) / rx) - first;
  if (sweep !== 0 && swept < 0) swept += 2 * Math.PI;
  if (sweep === 0 && swept > 0) swept -= 2 * Math.PI;
  const count = Math.max(1, Math.ceil(Math.abs(swept) / STEP));
  const points = Array.from({ length: count - 1 }, (_, index) => {
    const angle = first + (swept * (index + 1)) / count;
    const a = rx * Math.cos(angle), b = ry * Math.sin(angle);
    return [centerX + cos * a - sin * b, centerY + sin * a + cos * b] as const;
  });
  return [...points, ...end];
}

/** A little sphere lit as the scene is: dragging on it moves the sun. Seen from above, +x to the right, +y up. */
import type { Editor } from "../model/editor";
import { at, type Place } from "../model/json";
import { directionOf, sunOf } from "../model/light";
import { clamp, degrees } from "../geometry/units";
import { h } from "../ui/dom";
import type { Binder } from "../ui/panel";

const SIZE = 84, RADIUS = 38;
let drags = 0;

export function lightSphere(editor: Editor, bind: Binder, place: Place): HTMLElement {
  const canvas = h("canvas", {
    width: SIZE * 2, height: SIZE * 2, class: "light-sphere", tabindex: 0, role: "group",
    "aria-label": "Where the light comes from, seen from above. Drag, or use the arrow keys.",
  });
  const put = (azimuth: number, elevation: number, key: string): void =>
    editor.set(place, [...directionOf({ azimuth, elevation })], key);
  const point = (event: PointerEvent, key: string): void => {
    const box = canvas.getBoundingClientRect();
    const x = (event.clientX - box.left - box.width / 2) / RADIUS, y = -(event.clientY - box.top - box.height / 2) / RADIUS;
    const out = Math.hypot(x, y);
    put(degrees(Math.atan2(y, x)), degrees(Math.acos(clamp(out, 0, 0.999))), key);
  };
  canvas.addEventListener("pointerdown", (event) => {
    drags += 1;
    canvas.setPointerCapture(event.pointerId);
    point(event, `drag light ${drags}`);
  });
  canvas.addEventListener("pointermove", (event) => event.buttons & 1 && point(event, `drag light ${drags}`));
  canvas.addEventListener("keydown", (event) => {
    const { azimuth, elevation } = sunOf(at(editor.doc, place));
    const turn: Record<string, readonly [number, number]> = {
      ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5],
    };
    const by = turn[event.key];
    if (!by) return;
    event.preventDefault();
    put(azimuth + by[0], clamp(elevation + by[1], -90, 90), "light keys");
  });
  bind(() => paint(canvas, sunOf(at(editor.doc, place))));
  return canvas;
}

function paint(canvas: HTMLCanvasElement, { azimuth, elevation }: ReturnType<typeof sunOf>): void {
  const context = canvas.getContext("2d");
  if (!context) return;
  context.setTransform(2, 0, 0, 2, 0, 0);
  context.clearRect(0, 0, SIZE, SIZE);
  const [x, y] = directionOf({ azimuth, elevation });
  const middle = SIZE / 2, sunX = middle - x * RADIUS, sunY = middle + y * RADIUS;
  const shade = context.createRadialGradient(sunX, sunY, 2, sunX, sunY, RADIUS * 1.7);
  shade.addColorStop(0, elevation >= 0 ? "#f4f1ea" : "#4a4f58");
  shade.addColorStop(1, "#23272e");
  context.fillStyle = shade;
  context.beginPath();
  context.arc(middle, middle, RADIUS, 0, 2 * Math.PI);
  context.fill();
  context.strokeStyle = "#59616e";
  context.stroke();
  context.fillStyle = elevation >= 0 ? "#ffb347" : "#8a5a20";
  context.beginPath();
  context.arc(sunX, sunY, 4.5, 0, 2 * Math.PI);
  context.fill();
  context.strokeStyle = "#16181c";
  context.lineWidth = 1.5;
  context.stroke();
}

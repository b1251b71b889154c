/** The preview: the picture, what is going on with it, and turning the camera on it. */
import type { Editor } from "../model/editor";
import { entry, isObject } from "../model/json";
import { orbitOf, withOrbit, withPan } from "../model/orbit";
import { h } from "../ui/dom";
import type { Rendered, View } from "./renderer";

const TURN = 0.4; // degrees a pixel
const KEYS: Record<string, readonly [number, number]> = {
  ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5],
};

export class Preview implements View {
  readonly element: HTMLElement;
  readonly #image = h("img", { alt: "The rendered scene", draggable: false, hidden: true });
  readonly #status = h("span", { class: "preview-status" });
  readonly #stage: HTMLElement;
  #url = "";
  #drags = 0;

  constructor(readonly editor: Editor) {
    const label = "Rendered preview. Drag or use the arrow keys to turn the camera, the wheel or + and − to move closer or away, "
      + "Shift and drag to move across.";
    this.#stage = h("div", { class: "preview-stage", tabindex: 0, role: "group", "aria-label": label, title: "Drag turns the camera, the wheel moves it closer, Shift and drag moves it across." }, [
      this.#image, h("div", { class: "preview-bar", "aria-hidden": "true" }),
    ]);
    this.element = h("section", { class: "preview", "aria-label": "Preview" }, [
      this.#stage,
      h("div", { class: "preview-foot" }, [this.#status]),
    ]);
    this.#stage.addEventListener("pointerdown", (event) => this.#drag(event));
    this.#stage.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    this.#stage.addEventListener("keydown", (event) => this.#key(event));
  }

  busy(text: string | null): void {
    this.element.classList.toggle("busy", text !== null);
    if (text !== null && (this.#status.textContent === "" || text.startsWith("Compiling"))) this.#status.textContent = text;
  }

  show({ picture, quality, size, seconds, revision }: Rendered): void {
    const old = this.#url;
    this.#url = URL.createObjectURL(picture);
    this.#image.onload = () => {
      if (old) URL.revokeObjectURL(old);
      Object.assign(this.element.dataset, { revision: String(revision), quality: quality.name });
    };
    this.#image.src = this.#url;
    this.#image.hidden = false;
    this.element.classList.remove("stale");
    this.#status.textContent = `${size.width} × ${size.height} · ${seconds.toFixed(2)} s · ${quality.name}`;
  }

  clear(): void {
    this.#image.hidden = true;
    this.#status.textContent = "";
  }

  failed(text: string): void {
    this.element.classList.add("stale");
    this.#status.textContent = text;
  }

  #turn(azimuth: number, elevation: number, closer: number, key: string): void {
    const camera = entry(this.editor.doc, "camera");
    if (!isObject(camera)) return;
    const orbit = orbitOf(camera);
    const next = {
      azimuth: orbit.azimuth + azimuth,
      elevation: orbit.elevation + elevation,
      distance: orbit.distance * closer,
    };
    this.editor.set(["camera"], withOrbit(camera, next), key);
  }

  #drag(down: PointerEvent): void {
    if (down.button !== 0) return;
    this.#drags += 1;
    const key = `drag camera ${this.#drags}`;
    const stage = this.#stage;
    stage.setPointerCapture(down.pointerId);
    let [x, y] = [down.clientX, down.clientY];
    const move = (event: PointerEvent): void => {
      const [dx, dy] = [event.clientX - x, event.clientY - y];
      [x, y] = [event.clientX, event.clientY];
      const camera = entry(this.editor.doc, "camera");
      if (event.shiftKey && isObject(camera)) {
        this.editor.set(["camera"], withPan(camera, -dx / stage.clientHeight, dy / stage.clientHeight), key);
      } else this.#turn(-dx * TURN, dy * TURN, 1, key);
    };
    const end = (): void => {
      stage.removeEventListener("pointermove", move);
      stage.removeEventListener("pointerup", end);
      stage.removeEventListener("pointercancel", end);
    };
    stage.addEventListener("pointermove", move);
    stage.addEventListener("pointerup", end);
    stage.addEventListener("pointercancel", end);
  }

  #wheel(event: WheelEvent): void {
    event.preventDefault();
    this.#turn(0, 0, Math.exp(event.deltaY * 0.001), "camera wheel");
  }

  #key(event: KeyboardEvent): void {
    const turn = KEYS[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (turn) this.#turn(turn[0], turn[1], 1, "camera keys");
    else if (event.key === "+" || event.key === "=") this.#turn(0, 0, 1 / 1.1, "camera keys");
    else if (event.key === "-") this.#turn(0, 0, 1.1, "camera keys");
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

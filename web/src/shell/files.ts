/** Opening and saving: files, dropped files, examples, a new scene. */
import { example, exampleNames } from "../api/client";
import { blankScene } from "../model/blank";
import type { Editor } from "../model/editor";
import { entry, type Json } from "../model/json";
import { lights, objects } from "../model/scene";
import { formatScene, NotAScene, parseScene } from "../model/text";
import { forgetStyle } from "../tools/newgroove";
import { h } from "../ui/dom";

const LARGEST = 64 * 1024 * 1024; // bytes
const FIRST = "tiles"; // the example that a first visit opens, where there is one of this name

export class Files {
  readonly examples = h("select", { "aria-label": "Open an example", class: "examples" }, [h("option", { value: "" }, ["Examples"])]);
  readonly #input = h("input", { type: "file", accept: ".json,application/json", hidden: true, "aria-label": "Scene file" });

  constructor(readonly editor: Editor, readonly say: (text: string) => void) {
    this.#input.addEventListener("change", () => {
      const file = this.#input.files?.[0];
      this.#input.value = "";
      if (file) void this.read(file);
    });
    this.examples.addEventListener("change", () => {
      const name = this.examples.value;
      this.examples.value = "";
      if (name !== "" && this.#mayReplace()) void this.openExample(name);
    });
    document.body.append(this.#input);
    this.#acceptDrops();
  }

  create(): void {
    if (this.#mayReplace()) this.#open(blankScene(), "untitled.json");
  }

  choose(): void {
    this.#input.click();
  }

  save(): void {
    const url = URL.createObjectURL(new Blob([formatScene(this.editor.doc)], { type: "application/json" }));
    const { fileName } = this.editor.state;
    h("a", { href: url, download: fileName }).click();
    window.setTimeout(() => URL.revokeObjectURL(url), 10_000);
    this.editor.markSaved();
    this.say(`Saved as ${fileName}.`);
  }

  async read(file: File): Promise<void> {
    if (file.size > LARGEST) this.say(`${file.name} is too large for the page.`);
    else if (this.#mayReplace()) this.#openText(await file.text(), file.name);
  }

  /** Fills the menu; `open` starts with the first example that needs no file beside it. */
  async loadExamples(open: boolean): Promise<void> {
    try {
      const names = await exampleNames();
      this.examples.append(...names.map((name) => h("option", { value: name }, [name])));
      if (open) await this.#openFirst([...names].sort((a, b) => Number(b === FIRST) - Number(a === FIRST)));
    } catch {
      this.say("The service does not answer: there are no examples and no preview until it does.");
    }
  }

  async #openFirst(names: readonly string[]): Promise<void> {
    for (const name of names) {
      const text = await example(name);
      if (needsNoFile(parseScene(text))) {
        this.#openText(text, `${name}.json`);
        return;
      }
    }
  }

  async openExample(name: string): Promise<void> {
    try {
      this.#openText(await example(name), `${name}.json`);
    } catch (error) {
      this.say(error instanceof Error ? error.message : String(error));
    }
  }

  #openText(text: string, name: string): void {
    try {
      this.#open(parseScene(text), name);
    } catch (error) {
      if (!(error instanceof NotAScene)) throw error;
      this.say(`${name} was not opened. ${error.message}`);
    }
  }

  #open(doc: Json, name: string): void {
    forgetStyle();
    this.editor.open(doc, name);
    this.say("");
  }

  #mayReplace(): boolean {
    return !this.editor.isDirty || window.confirm("The changes to this scene have not been saved. Open another all the same?");
  }

  #acceptDrops(): void {
    const isFile = (event: DragEvent): boolean => event.dataTransfer?.types.includes("Files") ?? false;
    window.addEventListener("dragover", (event) => {
      if (!isFile(event)) return;
      event.preventDefault();
      document.body.classList.add("dropping");
    });
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && document.body.classList.remove("dropping"));
    window.addEventListener("drop", (event) => {
      document.body.classList.remove("dropping");
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      void this.read(file);
    });
  }
}

/** Meshes and pictures of the sky lie beside a scene file, where the service does not look. */
function needsNoFile(doc: Json): boolean {
  return ![...objects(doc).map((item) => entry(item, "shape")), ...lights(doc)].some((part) => entry(part, "file") !== undefined);
}

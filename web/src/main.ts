/** The page: one editor, and the parts that show it. */
import "./style/base.css";
import "./style/layout.css";
import "./style/panels.css";
import { blankScene } from "./model/blank";
import { Editor } from "./model/editor";
import { keepStored, restore } from "./model/storage";
import { Files } from "./shell/files";
import { installKeys } from "./shell/keys";
import { Shell } from "./shell/shell";

const stored = restore();
const editor = new Editor(stored?.doc ?? blankScene(), stored?.fileName ?? "untitled.json");
if (stored?.dirty) editor.store.update({ saved: null });

const shell = new Shell(editor);
const files = new Files(editor, (text) => shell.say(text));
shell.mount(document.getElementById("app") as HTMLElement, files);
installKeys(editor, shell, files);
keepStored(editor, () => shell.say("The browser has no room to keep this document: save it to a file."));

window.addEventListener("beforeunload", (event) => {
  if (editor.isDirty) event.preventDefault();
});

await files.loadExamples(stored === null);
shell.start();

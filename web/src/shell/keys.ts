/** Keys of the whole page. What a field needs for itself is left to it. */
import type { Editor, ToolName } from "../model/editor";
import type { Files } from "./files";
import type { Shell } from "./shell";

const TOOLS: Record<string, ToolName> = { v: "select", p: "polyline", c: "curve", o: "circle" };

export function installKeys(editor: Editor, shell: Shell, files: Files): void {
  window.addEventListener("keydown", (event) => {
    if (event.defaultPrevented) return;
    const isTyping = event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement;
    const handled = event.ctrlKey || event.metaKey ? command(event) : event.altKey ? false : plain(event, isTyping);
    if (handled) event.preventDefault();
  });

  function command(event: KeyboardEvent): boolean {
    const key = event.key.toLowerCase();
    if (key === "z") (event.shiftKey ? () => editor.redo() : () => editor.undo())();
    else if (key === "y") editor.redo();
    else if (key === "s") files.save();
    else if (key === "o") files.choose();
    else return false;
    return true;
  }

  function plain(event: KeyboardEvent, isTyping: boolean): boolean {
    if (isTyping) {
      if (event.key === "Escape" && event.target instanceof HTMLElement) event.target.blur();
      return false;
    }
    if (event.key === "Escape") return shell.cancel();
    // A focused button has Enter for itself, the tool the other keys.
    const isButton = event.target instanceof HTMLElement && event.target.closest("button, summary, .preview-stage, .light-sphere") !== null;
    if (isButton && (event.key === "Enter" || event.key.startsWith("Arrow"))) return false;
    if (shell.tool.key(event.key, event.shiftKey)) return true;
    const tool = TOOLS[event.key.toLowerCase()];
    if (tool) editor.chooseTool(tool);
    else if (event.key === "f") shell.canvas.fit();
    else if (event.key === "Delete" || event.key === "Backspace") editor.removeGroove();
    else return false;
    return true;
  }
}

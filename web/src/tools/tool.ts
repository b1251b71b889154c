/** What a tool does with the pointer and the keys that the canvas gets. */
import type { PatternPoint, ScreenPoint } from "../geometry/units";

export interface ToolEvent {
  readonly at: ScreenPoint;
  readonly point: PatternPoint;
  readonly shift: boolean;
  readonly alt: boolean;
}

export interface Draft {
  readonly line: readonly PatternPoint[];
  readonly points: readonly PatternPoint[];
}

export interface Tool {
  readonly hint: string;
  readonly cursor: string;
  down(event: ToolEvent): void;
  move(event: ToolEvent, pressed: boolean): void;
  up(event: ToolEvent): void;
  doubleClick(event: ToolEvent): void;
  /** Whether the key was the tool's. */
  key(name: string, shift: boolean): boolean;
  /** Gives up what it was doing; whether there was anything. */
  cancel(): boolean;
  draft(): Draft | null;
}

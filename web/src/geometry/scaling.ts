/** The factor on a cross-section along its path, by arc length t from 0 to 1. */
import { array, entry, number, type Json } from "../model/json";
import { kind } from "../model/scene";
import { radians } from "./units";

export interface Scaling {
  readonly isConstant: boolean;
  readonly factor: (t: number) => number;
}

export function scaling(scale: Json | undefined): Scaling {
  const value = (key: string, otherwise: number): number => number(entry(scale, key), otherwise);
  switch (kind(scale)) {
    case "linear": {
      const start = value("start", 1), end = value("end", 1);
      return { isConstant: false, factor: (t) => start + (end - start) * t };
    }
    case "sine": {
      const amplitude = value("amplitude", 0), periods = value("periods", 1), phase = radians(value("phase", 0));
      return { isConstant: false, factor: (t) => 1 + amplitude * Math.sin(2 * Math.PI * periods * t + phase) };
    }
    case "table":
      return { isConstant: false, factor: table(scale) };
    default: {
      const constant = value("value", 1);
      return { isConstant: true, factor: () => constant };
    }
  }
}

function table(scale: Json | undefined): (t: number) => number {
  const places = array(entry(scale, "t")).map((item) => number(item, 0));
  const values = array(entry(scale, "values")).map((item) => number(item, 1));
  return (t) => {
    const after = places.findIndex((place) => place >= t);
    if (after <= 0) return values[after === 0 ? 0 : values.length - 1] ?? 1;
    const low = places[after - 1] ?? 0, high = places[after] ?? 1;
    const share = high > low ? (t - low) / (high - low) : 0;
    const before = values[after - 1] ?? 1;
    return before + ((values[after] ?? before) - before) * share;
  };
}

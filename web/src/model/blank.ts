/** The scene of "New": one bare plate. */
import type { Scene } from "../api/types";
import type { Json } from "./json";

const scene: Scene = {
  intaglio: 1,
  camera: { origin: [0, -2.6, 2.2], target: [0, 0, 0], up: [0, 0, 1], fov: 35, resolution: [640, 480] },
  lights: [{ type: "directional", direction: [-0.7, 0.4, -0.6], irradiance: [3, 3, 3] }],
  materials: { stone: { base_color: [0.7, 0.68, 0.65], roughness: 1, specular: 0 } },
  objects: [
    {
      shape: { type: "rectangle", size: [2, 2] },
      mapping: { scale: [4, 4], offset: [0, 0] },
      material: "stone",
      pattern: null,
    },
  ],
};

export const blankScene = (): Json => structuredClone(scene) as unknown as Json;

/** The service's documents and the scene's parts, by the names that the service's OpenAPI document gives them. */
import type { components } from "../../generated/schema";

type Schemas = components["schemas"];

export type Finding = Schemas["Finding"];
export type ProblemDocument = Schemas["ProblemDocument"];
export type Validation = Schemas["Validation"];
export type Health = Schemas["Health"];
export type UploadedMesh = Schemas["UploadedMesh"];
export type Examples = Schemas["Examples"];

export type Scene = Schemas["Scene"];
export type Groove = Schemas["Groove"];
export type Pattern = Schemas["Pattern"];
export type Path = Groove["path"];
export type Profile = Groove["profile"];
export type Scale = NonNullable<Groove["scale"]>;
export type Repeat = NonNullable<Groove["repeat"]>;
export type Light = NonNullable<Scene["lights"]>[number];
export type Material = Schemas["Material"];

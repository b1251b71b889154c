/** Calls of the REST service. Every failure is a ServiceError that says what to tell the user. */
import type { paths } from "../../generated/schema";
import type { Json } from "../model/json";
import type { Examples, Finding, Health, ProblemDocument, UploadedMesh, Validation } from "./types";

type Route = keyof paths;
type RenderQuery = NonNullable<paths["/api/render"]["post"]["parameters"]["query"]>;

export class ServiceError extends Error {
  constructor(
    message: string,
    /** 0: the service did not answer. */
    readonly status: number,
    readonly problems: readonly Finding[] = [],
    /** Milliseconds after which to try again, where the service says so. */
    readonly retryAfter: number | null = null,
  ) {
    super(message);
  }
}

async function call(route: Route | `/api/examples/${string}`, init: RequestInit = {}): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(route, init);
  } catch (error) {
    if (init.signal?.aborted) throw error;
    throw new ServiceError("The service does not answer.", 0);
  }
  if (response.ok) return response;
  const seconds = Number(response.headers.get("Retry-After"));
  const retry = response.headers.has("Retry-After") && Number.isFinite(seconds) ? seconds * 1000 : null;
  const document = (await response.json().catch(() => null)) as Partial<ProblemDocument> | null;
  const message = document?.detail ?? document?.title ?? `The service answered ${response.status}.`;
  throw new ServiceError(message, response.status, document?.problems ?? [], retry);
}

function post(scene: Json, signal: AbortSignal, accept: string): RequestInit {
  const headers = { "Content-Type": "application/json", Accept: accept };
  return { method: "POST", body: JSON.stringify(scene), headers, signal };
}

export async function health(): Promise<Health> {
  return (await call("/api/health")).json() as Promise<Health>;
}

export async function validate(scene: Json, signal: AbortSignal): Promise<Validation> {
  return (await call("/api/validate", post(scene, signal, "application/json"))).json() as Promise<Validation>;
}

/** A PNG of the scene. */
export async function render(scene: Json, query: RenderQuery, signal: AbortSignal): Promise<Blob> {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value !== null && value !== undefined) parameters.set(name, String(value));
  }
  const route = `/api/render?${parameters}` as Route;
  return (await call(route, post(scene, signal, "image/png, application/problem+json"))).blob();
}

/** Hands a mesh to the service; what a scene says as `file` to use it. */
export async function uploadMesh(file: File): Promise<string> {
  const route = `/api/meshes?name=${encodeURIComponent(file.name)}` as Route;
  const headers = { "Content-Type": "application/octet-stream" };
  return ((await (await call(route, { method: "POST", body: file, headers })).json()) as UploadedMesh).file;
}

export async function exampleNames(): Promise<string[]> {
  return ((await (await call("/api/examples")).json()) as Examples).examples;
}

/** The text of an example scene. */
export async function example(name: string): Promise<string> {
  return (await call(`/api/examples/${encodeURIComponent(name)}`)).text();
}

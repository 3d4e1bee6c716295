// What the page and the server say to each other; PROTOCOL.md describes it.

export type Vector = [number, number, number];
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Options = { [key: string]: Json };

/** The tables of a document that can be edited. */
export type Table = 'part' | 'step' | 'output' | 'primitive';

export interface Part {
  index: number;
  name: string;
  mesh: string;
  /** The keys of its pose, as they are written. */
  pose: Options;
}

export interface Step {
  index: number;
  do: string;
  of: string[];
  /** The same as it is written, with the numbers of loops. */
  written_of?: string | string[] | null;
  /** The name of its result. */
  as: string;
  off: boolean;
  options: Options;
}

export interface Output {
  index: number;
  of: string | null;
  file: string;
}

export interface DocumentEvent {
  event: 'document';
  version: number;
  text: string;
  path: string | null;
  parts: Part[];
  steps: Step[];
  outputs: Output[];
  primitives: { [name: string]: Options };
  parameters: Options;
  can_undo: boolean;
  can_redo: boolean;
  shapes: string[];
}

export interface EvaluatedShape {
  name: string;
  revision: string;
  closed: boolean | null;
  crossings: number | null;
  faces: number;
  vertices: number;
  /** Whether no step has taken it up. */
  result: boolean;
}

export interface EvaluatedStep {
  index: number;
  name: string;
  known: boolean;
  report: Json;
}

export interface EvaluatedEvent {
  event: 'evaluated';
  version: number;
  milliseconds: number;
  steps: EvaluatedStep[];
  shapes: EvaluatedShape[];
}

export interface Remedy {
  label: string;
  edit?: { do: string; [key: string]: Json } | null;
}

/** A sentence with its place and its way out. */
export interface Failure {
  sentence: string;
  place?: Vector | null;
  remedy?: Remedy | null;
}

export interface FailedEvent extends Failure {
  event: 'failed';
  version: number;
  step?: number | null;
}

export type ServerEvent =
  | DocumentEvent
  | EvaluatedEvent
  | FailedEvent
  | { event: 'progress'; stage: string; fraction: number | null }
  | { event: 'cancelled'; version: number }
  | { event: 'autosave'; path: string };

/** A feature curve, a seam or a boundary loop, with points relative to the drawing origin of its shape. */
export interface Curve {
  id: number;
  /** The shape that a loop belongs to. */
  shape?: string;
  length: number;
  closed: boolean;
  convex?: boolean;
  angle?: number;
  seam?: boolean;
  points: Vector[];
  /** A point of the curve in model units, which names it in options such as `near`. */
  near?: Vector;
  /** A point of a loop in model units. */
  at?: Vector;
  /** The normals of both sides there. */
  normals?: [Vector, Vector];
}

export interface Curves {
  revision?: string;
  origin: Vector;
  curves: Curve[];
}

export interface MaxRadius {
  radius: number;
  limit?: string | null;
  place?: Vector | null;
}

/** A place on a shape, without coordinates that were rounded for drawing. */
export interface Pick {
  shape: string;
  face: number;
  bary: Vector;
}

/** A mesh as the server sends it for drawing. */
export interface MeshFrame {
  shape: string;
  revision: string;
  origin: Vector;
  positions: Float32Array;
  faces: Uint32Array;
  /** For each face 0 where it is new, k where it is of part k. */
  faceOrigin: Uint32Array;
}

/** One number for each vertex of a shape, to colour it by. */
export interface FieldFrame {
  field: string;
  shape: string;
  revision: string;
  values: Float32Array;
}

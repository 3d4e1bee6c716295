// What the page knows: the document, what was evaluated, what is selected. Panels subscribe to it and draw it.

import type {
  Curve, Curves, DocumentEvent, EvaluatedEvent, Failure, MaxRadius, MeshFrame, Part, Step, Table,
} from './protocol';

/** A row of a table of the document. */
export interface Row {
  table: Table;
  index: number;
}

/** What changed, so that a panel draws no more than it must. */
export type Change =
  | 'document' | 'evaluated' | 'mesh' | 'selection' | 'curves' | 'work' | 'failure' | 'connection' | 'log' | 'look' | 'tool';

export interface LogLine {
  kind: 'note' | 'warning' | 'error';
  text: string;
  failure?: Failure;
}

/** How the view draws shapes. */
export interface Look {
  wire: boolean;
  edges: boolean;
  colour: 'plain' | 'origin' | 'curvature' | 'quality' | 'zebra';
  grid: boolean;
  occlusion: boolean;
  parallel: boolean;
  section: boolean;
  up: 'y' | 'z';
}

/** Curves of a step or of a shape, with those that were picked. */
export interface CurveSet extends Curves {
  /** The step that blends along them, if there is one. */
  step: number | null;
  shape: string;
  /** Feature curves and seams, or boundary loops with their numbers. */
  kind: 'features' | 'loops';
  picked: Curve[];
}

const noDocument: DocumentEvent = {
  event: 'document', version: 0, text: '', path: null, parts: [], steps: [], outputs: [], primitives: {}, parameters: {},
  can_undo: false, can_redo: false, shapes: [],
};

export class Store {
  document = noDocument;
  evaluated: EvaluatedEvent | undefined;
  meshes = new Map<string, MeshFrame>();
  selection: Row[] = [];
  curves: CurveSet | undefined;
  largest: MaxRadius | undefined;
  work: { stage: string; fraction: number | null } | undefined;
  /** When the evaluation under way began. */
  workSince: number | undefined;
  failure: Failure | undefined;
  /** The version of the document that failed last. */
  failedVersion = -1;
  /** Requests that are not answered yet. */
  asking = 0;
  connected = false;
  /** What a click in the view means. */
  tool: 'select' | 'move' | 'rotate' | 'measure' | 'point' | 'path' = 'select';
  log: LogLine[] = [];
  look: Look = { wire: false, edges: true, colour: 'plain', grid: true, occlusion: false, parallel: false, section: false, up: 'z' };
  /** The size of what is drawn, for first values of lengths. */
  drawnSize: () => number = () => 2;
  private listeners: [Change[], () => void][] = [];

  /** Calls back when one of these changes. */
  on(changes: Change[], listener: () => void) {
    this.listeners.push([changes, listener]);
  }

  changed(...changes: Change[]) {
    for (const [wanted, listener] of this.listeners) {
      if (changes.some((change) => wanted.includes(change))) listener();
    }
  }

  say(text: string, kind: LogLine['kind'] = 'note', failure?: Failure) {
    const last = this.log.at(-1);
    if (last?.text === text) this.log.pop();
    this.log.push({ kind, text, failure });
    if (this.log.length > 200) this.log.shift();
    this.changed('log');
  }

  select(rows: Row[]) {
    this.selection = rows;
    this.changed('selection');
  }

  isSelected(row: Row): boolean {
    return this.selection.some((s) => s.table === row.table && s.index === row.index);
  }

  /** The last row of the selection, whose properties are shown. */
  get focus(): Row | undefined {
    return this.selection.at(-1);
  }

  /** The name of a primitive. */
  primitive(row: Row | undefined): string | undefined {
    return row?.table === 'primitive' ? Object.keys(this.document.primitives)[row.index] : undefined;
  }

  part(row: Row | undefined): Part | undefined {
    return row?.table === 'part' ? this.document.parts[row.index] : undefined;
  }

  step(row: Row | undefined): Step | undefined {
    return row?.table === 'step' ? this.document.steps[row.index] : undefined;
  }

  /** The name of the shape that a row makes. */
  shapeOf(row: Row): string | undefined {
    if (row.table === 'part') return this.document.parts[row.index]?.name;
    if (row.table === 'output') return this.document.outputs[row.index]?.of ?? undefined;
    const step = this.step(row);
    return step && resultOf(step);
  }

  /** The shape in the view that a row makes: a part that was taken up, and a step that was, are shown besides. */
  viewOf(row: Row): string | undefined {
    const name = this.shapeOf(row);
    if (name === undefined || row.table === 'output') return name;
    const latest = this.rowOf(name);
    const isLatest = latest?.table === row.table && latest.index === row.index;
    if (isLatest && this.document.shapes.includes(name)) return name;
    return row.table === 'part' ? `part:${name}` : `step:${row.index}`;
  }

  /** The row that makes the latest shape of this name, or `part:NAME`, or `step:N`. */
  rowOf(shape: string): Row | undefined {
    const [kind, rest] = [shape.slice(0, 5), shape.slice(5)];
    if (kind === 'step:') return { table: 'step', index: Number(rest) };
    if (kind === 'part:') return { table: 'part', index: this.document.parts.findIndex((p) => p.name === rest) };
    const step = this.document.steps.findLastIndex((s) => resultOf(s) === shape);
    if (step >= 0) return { table: 'step', index: step };
    const part = this.document.parts.findIndex((p) => p.name === shape);
    return part >= 0 ? { table: 'part', index: part } : undefined;
  }

  /** The names of the shapes in view that no step has taken up; all others in view are ghosts. */
  get results(): string[] {
    return (this.evaluated?.shapes ?? []).filter((s) => s.result).map((s) => s.name);
  }

  /** The names of the selected shapes, in the order of selection. */
  get shapes(): string[] {
    const names = this.selection.map((row) => this.shapeOf(row)).filter((n): n is string => n !== undefined);
    return [...new Set(names)];
  }

  /** A name that nothing in the document has yet. */
  freshName(stem: string): string {
    const taken = new Set([...Object.keys(this.document.primitives), ...this.document.parts.map((p) => p.name), ...this.document.steps.map(resultOf)]);
    let name = stem;
    for (let n = 2; taken.has(name); n++) name = `${stem}-${n}`;
    return name;
  }
}

/** The name of a step's result. */
export function resultOf(step: Step): string {
  return step.as;
}

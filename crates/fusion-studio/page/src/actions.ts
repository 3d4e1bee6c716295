// What a person can do, as requests to the server. Panels, keys and the view call these.

import { Refusal, upload, type Connection } from './connection';
import type { Failure, Json, Options, Pick, Remedy, Table, Vector } from './protocol';
import type { Row, Store } from './store';

/** Endings of files that can be dropped as parts. */
export const MESH_ENDINGS = ['obj', 'stl', 'ply', 'off', 'glb', 'gltf', '3mf'];

export class Actions {
  private drags = 0;

  constructor(readonly store: Store, readonly server: Connection) {}

  /** Asks the server; what it refuses is shown, and the answer is then undefined. */
  async ask<T = Json>(what: string, keys: object = {}): Promise<T | undefined> {
    this.store.asking++;
    try {
      return await this.server.ask<T>(what, keys);
    } catch (refusal) {
      this.refused(refusal);
      return undefined;
    } finally {
      this.store.asking--;
    }
  }

  /** Ask in the background: errors are not shown. */
  async quietly<T = Json>(what: string, keys: object = {}): Promise<T | undefined> {
    try {
      return await this.server.ask<T>(what, keys);
    } catch {
      return undefined;
    }
  }

  refused(refusal: unknown) {
    const failure: Failure = refusal instanceof Refusal ? refusal.failure : { sentence: String(refusal) };
    this.store.failure = failure;
    this.store.say(failure.sentence, 'error', failure);
    this.store.changed('failure');
  }

  dismiss() {
    this.store.failure = undefined;
    this.store.changed('failure');
  }

  async remedy(remedy: Remedy) {
    if (!remedy.edit) return;
    const { do: what, ...keys } = remedy.edit;
    this.dismiss();
    await this.ask(what, keys);
  }

  /** Uploads files and adds each as a part; documents are opened. */
  async addFiles(files: File[]) {
    const before = this.store.document.parts.length;
    for (const file of files) {
      const ending = file.name.split('.').pop()?.toLowerCase() ?? '';
      try {
        if (ending === 'toml') {
          await this.server.ask('text', { text: await file.text() });
          this.store.say(`Opened ${file.name}.`);
          continue;
        }
        if (!MESH_ENDINGS.includes(ending)) {
          throw new Refusal({ sentence: `${file.name} is no mesh file; the studio reads ${MESH_ENDINGS.join(', ')} and documents (toml).` });
        }
        this.store.say(`Adding ${file.name} (${bytes(file.size)}).`);
        const mesh = await upload(file);
        await this.server.ask('add_part', { mesh, name: this.store.freshName(stem(file.name)) });
      } catch (refusal) {
        this.refused(refusal);
      }
    }
    const after = this.store.document.parts.length;
    if (after > before) this.store.select([{ table: 'part', index: after - 1 }]);
  }

  /** Adds a step on the selected shapes, or on these. */
  async addStep(verb: string, of = this.store.shapes, options: Options = {}, made: (row: Row) => void = () => undefined) {
    const as = this.store.freshName(verb);
    const added = await this.ask<{ index?: number }>('add_step', { verb, of, as, options });
    if (!added) return undefined;
    const row: Row = { table: 'step', index: added.index ?? this.store.document.steps.length - 1 };
    made(row);
    this.store.select([row]);
    return row;
  }

  /** A number for all edits of one drag, which are undone together. */
  newDrag(): number {
    return ++this.drags + Date.now();
  }

  /** How a row is named in requests: primitives by name, all others by number. */
  private address(row: Row): { table: Table; index?: number; name?: string } {
    const name = this.store.primitive(row);
    return name === undefined ? { table: row.table, index: row.index } : { table: row.table, name };
  }

  /** Adds a primitive for parts to ride on. */
  async addPrimitive() {
    const size = this.store.drawnSize();
    const name = this.store.freshName('cylinder');
    const length = (share: number) => Number((size * share).toPrecision(2));
    const options = { shape: 'cylinder', radius: length(0.2), height: length(0.5) };
    if (!(await this.ask('add_primitive', { name, options }))) return;
    const index = Object.keys(this.store.document.primitives).indexOf(name);
    if (index >= 0) this.store.select([{ table: 'primitive', index }]);
  }

  /** Several values at once, undone together. */
  setAll(row: Row, values: Options, drag?: number) {
    const edits = Object.entries(values).map(([key, value]) => ({ table: row.table, index: row.index, key, value }));
    return this.ask<{ version?: number }>('set_all', { edits, ...(drag === undefined ? {} : { drag }) });
  }

  rename(row: Row, to: string) {
    return this.ask('rename', { table: row.table, index: row.index, to });
  }

  set(row: Row, key: string, value: Json, drag?: number) {
    return this.ask<{ version?: number }>('set', { ...this.address(row), key, value, ...(drag === undefined ? {} : { drag }) });
  }

  async removeSelected() {
    // Last rows first, so that the numbers of the others stay.
    const rows = [...this.store.selection].sort((a, b) => b.index - a.index);
    const order: Table[] = ['output', 'step', 'part', 'primitive'];
    rows.sort((a, b) => order.indexOf(a.table) - order.indexOf(b.table));
    this.store.select([]);
    for (const address of rows.map((row) => this.address(row))) await this.ask('remove', address);
  }

  async undo() {
    if (this.store.document.can_undo) await this.ask('undo');
  }

  async redo() {
    if (this.store.document.can_redo) await this.ask('redo');
  }

  async save(path: string) {
    if (await this.ask('save', { path })) this.store.say(`Saved ${path}.`);
  }

  pick(hit: Pick): Promise<Vector | undefined> {
    const { shape, face, bary } = hit;
    return this.ask<Vector | { point: Vector }>('pick', { shape, face, bary }).then((a) => (Array.isArray(a) ? a : a?.point));
  }
}

/** Sends the newest value of a drag when the one before has been evaluated, or is slow. */
export class Pacer<V> {
  private newest: V | undefined;
  private waiting = false;
  private timer = 0;

  constructor(private send: (value: V) => void, private store: Store) {}

  push(value: V) {
    this.newest = value;
    if (!this.waiting) this.go();
  }

  /** The server has evaluated what was sent last. */
  done() {
    if (!this.waiting) return;
    clearTimeout(this.timer);
    this.waiting = false;
    this.go();
  }

  private go() {
    if (this.newest === undefined) return;
    const value = this.newest;
    this.newest = undefined;
    this.waiting = true;
    // A value that takes long is not waited for, but has its chance: else nothing would be seen until the drag ends.
    const slow = Math.min(3000, Math.max(300, 2 * (this.store.evaluated?.milliseconds ?? 0)));
    this.timer = window.setTimeout(() => this.done(), slow);
    this.send(value);
  }
}

export function stem(file: string): string {
  const name = file.split(/[/\\]/).pop() ?? file;
  return name.replace(/\.[^.]+$/, '').replace(/[^\p{L}\p{N}_-]+/gu, '-') || 'part';
}

export function bytes(size: number): string {
  return size < 1e6 ? `${Math.max(1, Math.round(size / 1e3))} kB` : `${(size / 1e6).toFixed(1)} MB`;
}

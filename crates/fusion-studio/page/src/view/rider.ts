// A part that rides on a primitive is pulled along it: sideways round the axis, up and down along it.

import { Pacer, type Actions } from '../actions';
import type { Json, Options } from '../protocol';
import type { Row, Store } from '../store';
import type { Stage } from './stage';

/** Pixels of the mouse for once round the axis, and for the length of it. */
const ROUND = 600;

export class Rider {
  private pulled: { row: Row; on: Options; at: number[]; x: number; y: number; drag: number } | undefined;
  private newest: Json = null;
  private pacer: Pacer<Json>;

  constructor(private stage: Stage, private store: Store, private actions: Actions) {
    this.pacer = new Pacer((value) => void this.send(value), store);
    store.on(['evaluated', 'failure'], () => this.pacer.done());
  }

  /** Begins, if the selected part rides on a primitive and is under the pointer. */
  begin(shape: string | undefined, x: number, y: number): boolean {
    const row = this.store.focus;
    const on = this.store.part(row)?.pose.on as Options | undefined;
    if (!row || !on || this.store.tool !== 'move' || shape === undefined || shape !== this.store.viewOf(row)) return false;
    this.pulled = { row, on, at: on.at as number[], x, y, drag: this.actions.newDrag() };
    this.stage.orbit.enabled = false;
    return true;
  }

  get pulling(): boolean {
    return this.pulled !== undefined;
  }

  pull(x: number, y: number) {
    const { pulled } = this;
    if (!pulled) return;
    const u = pulled.at[0] + (x - pulled.x) / ROUND;
    const v = pulled.at[1] - (y - pulled.y) / ROUND;
    // Once round is where it began.
    const at = [u - Math.floor(u), Math.min(1, Math.max(0, v))].map((n) => Number(n.toFixed(4)));
    this.newest = { ...pulled.on, at };
    this.pacer.push(this.newest);
  }

  end() {
    if (this.newest !== null) void this.send(this.newest);
    this.newest = null;
    this.pulled = undefined;
    this.stage.orbit.enabled = true;
  }

  private async send(value: Json) {
    if (this.pulled) await this.actions.set(this.pulled.row, 'on', value, this.pulled.drag);
  }
}

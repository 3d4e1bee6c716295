// The radius of the picked curves: found in the step that blends them, or begun as a new blend.

import { Pacer, type Actions } from './actions';
import type { Json, MaxRadius, Options, Step, Vector } from './protocol';
import type { Row, Store } from './store';

/** Verbs whose steps have a radius of their own. */
export const BLENDING = ['union', 'difference', 'intersection', 'blend'];

export class Radius {
  private dragging: number | undefined;
  private begun: Promise<Row | undefined> | undefined;
  private shown: number | undefined;
  readonly pacer: Pacer<number>;
  /** Told the radius while it is dragged. */
  onDrag: (radius: number) => void = () => undefined;

  constructor(private store: Store, private actions: Actions) {
    this.pacer = new Pacer((value) => void this.send(value, this.dragging), store);
    store.on(['evaluated', 'failure'], () => this.pacer.done());
  }

  /** The step that blends along the curves that are shown. */
  get step(): Step | undefined {
    const index = this.store.curves?.step;
    const step = index === null || index === undefined ? undefined : this.store.document.steps[index];
    return step && BLENDING.includes(step.do) ? step : undefined;
  }

  /** The radius as a length; shares of the diagonal are turned into one. */
  get value(): number | undefined {
    if (this.dragging !== undefined && this.shown !== undefined) return this.shown;
    const radius = this.step?.options.radius;
    const one = Array.isArray(radius) ? radius[0] : radius;
    if (typeof one === 'number') return one;
    if (typeof one === 'string' && one.endsWith('%')) return (parseFloat(one) / 100) * this.diagonal();
    return undefined;
  }

  /** What a slider ends at while the largest radius is not known. */
  guess(): number {
    return Math.max(this.diagonal() * 0.1, (this.value ?? 0) * 2);
  }

  /** The size of the model, for shares of it. */
  diagonal: () => number = () => 1;

  /** Sets the radius once. */
  async put(value: number | null) {
    this.dragging = undefined;
    await this.send(value, undefined);
  }

  /** Gives a place of the curve a radius of its own, which is that of the whole to begin with. */
  async vary(at: Vector) {
    const index = this.store.curves?.step;
    if (!this.step || index === null || index === undefined || this.value === undefined) return;
    const listed = (this.step.options.radius_at as Json[] | undefined) ?? [];
    await this.actions.set({ table: 'step', index }, 'radius_at', [...listed, { at, radius: this.value }]);
  }

  /** A new value of a drag under way. */
  drag(value: number) {
    this.dragging ??= this.actions.newDrag();
    this.shown = value;
    this.onDrag(value);
    this.pacer.push(value);
  }

  end() {
    const last = this.shown;
    const drag = this.dragging;
    this.shown = undefined;
    this.pacer.done();
    if (last !== undefined) void this.send(last, drag);
    this.dragging = undefined;
    this.begun = undefined;
  }

  private async send(value: number | null, drag: number | undefined) {
    const set = this.store.curves;
    if (!set) return;
    const near = set.picked.map((c) => c.near).filter((at) => at !== undefined) as Json[];
    const some = near.length > 0 && near.length < set.curves.length;
    if (this.step && set.step !== null) {
      const row: Row = { table: 'step', index: set.step };
      const before = JSON.stringify(this.step.options.near ?? []);
      const values: Options = some && JSON.stringify(near) !== before ? { near, radius: value } : { radius: value };
      await this.actions.setAll(row, values, drag);
      return;
    }
    if (value === null || this.begun) return;
    // The first value makes the step; those that follow find it in `curves`.
    const options: { [key: string]: Json } = { radius: value };
    if (some) options.near = near;
    const { largest } = this.store;
    this.begun = this.actions.addStep('blend', [set.shape], options, (row) => {
      this.store.largest = largest;
      this.store.curves = { ...set, step: row.index };
    });
    await this.begun;
    this.store.changed('curves');
    if (drag === undefined) this.begun = undefined;
  }

  /** Asks how large a ball fits along the picked curves. */
  async askLargest() {
    const set = this.store.curves;
    if (!set || set.kind === 'loops') return;
    const curves = set.picked.map((c) => c.id);
    const subject = set.step === null ? { shape: set.shape } : { step: set.step };
    const answer = await this.actions.quietly<MaxRadius>('max_radius', { ...subject, curves });
    if (this.store.curves?.curves !== set.curves) return;
    this.store.largest = answer && answer.radius > 0 ? answer : undefined;
    this.store.changed('curves');
  }
}

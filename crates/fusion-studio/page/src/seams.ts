// Which curves the view shows: those that the step in focus blends, or those of the shape in focus.

import type { Actions } from './actions';
import type { Curve, Curves, Vector } from './protocol';
import { BLENDING, type Radius } from './radius';
import type { Store } from './store';

/** Faces beyond which curves are asked for only when their step is selected. */
const MANY = 400_000;

export class Seams {
  private asked = '';

  constructor(private store: Store, private actions: Actions, private radius: Radius) {
    store.on(['selection', 'evaluated', 'look'], () => void this.renew());
  }

  /** Asks for the curves if the selection or its shape changed. */
  private async renew() {
    const { store } = this;
    if (!store.look.edges) return this.drop();
    if (store.selection.length > 1) return this.renewLoops();
    const row = store.focus;
    const step = store.step(row);
    const shape = row ? store.viewOf(row) : undefined;
    if (!row || !shape || row.table === 'output') return this.drop();
    const blends = step !== undefined && BLENDING.includes(step.do);
    const known = store.evaluated?.shapes.find((s) => s.name === shape);
    if (!known && !blends) return this.drop();
    if (known && known.faces > MANY && !blends) return this.drop();
    // The curves of a step that blends do not depend on its radius.
    const { radius: _, radius_at: __, near: ___, ...others } = step?.options ?? {};
    const inputs = (step?.of ?? []).map((name) => JSON.stringify(store.part(store.rowOf(name)) ?? name));
    const key = blends ? JSON.stringify([row.index, step.do, step.of, inputs, others]) : `${shape} ${known?.revision}`;
    if (key === this.asked) return;
    const before = this.asked;
    this.asked = key;
    // A step that was just made of picked curves blends along these.
    if (blends && store.curves?.step === row.index && !before.startsWith(`[${row.index},`)) return;
    // A part's file is not known to be closed before it is looked at.
    if (!blends && known?.closed !== true && (await this.takeLoops(key, [shape]))) return;
    const answer = await this.ask(blends ? row.index : null, shape);
    if (this.asked !== key) return;
    if (!answer) {
      // A step that failed has no curves now; it may have some after the next edit.
      this.asked = '';
      store.curves = undefined;
    } else {
      const picked = store.curves?.step === (blends ? row.index : null) && store.curves.shape === shape ? samePlaces(store.curves.picked, answer.curves) : [];
      // Of a boolean only the seams are blended.
      const seams = answer.curves.filter((curve) => curve.seam);
      if (blends && step.do !== 'blend' && seams.length > 0) answer.curves = seams;
      store.curves = { ...answer, step: blends ? row.index : null, shape, kind: 'features', picked };
    }
    store.largest = undefined;
    store.changed('curves');
    if (answer && (blends || store.curves?.picked.length)) void this.radius.askLargest();
  }

  /** The loops of all selected shapes that have any. */
  private async renewLoops() {
    const { store } = this;
    const shapes = store.shapes.filter((name) => store.evaluated?.shapes.some((s) => s.name === name && s.closed !== true));
    if (shapes.length === 0) return this.drop();
    const key = JSON.stringify(shapes.map((name) => [name, store.evaluated?.shapes.find((s) => s.name === name)?.revision]));
    if (key === this.asked) return;
    this.asked = key;
    await this.takeLoops(key, shapes);
  }

  /** Shows the loops of these shapes; answers whether there are any, or the question has gone stale. */
  private async takeLoops(key: string, shapes: string[]): Promise<boolean> {
    const { store } = this;
    const curves: Curve[] = [];
    for (const shape of shapes) {
      const answer = await this.answer('loops', shape);
      const shift = (p: Vector): Vector => [p[0] + answer!.origin[0], p[1] + answer!.origin[1], p[2] + answer!.origin[2]];
      for (const loop of answer?.curves ?? []) curves.push({ ...loop, shape, closed: true, points: loop.points.map(shift) });
    }
    if (this.asked !== key) return true;
    if (curves.length === 0 && shapes.length === 1) return false;
    const was = store.curves?.kind === 'loops' ? store.curves.picked : [];
    const picked = curves.filter((c) => was.some((old) => old.shape === c.shape && old.id === c.id));
    store.curves = { origin: [0, 0, 0], curves, step: null, shape: shapes[0], kind: 'loops', picked };
    store.largest = undefined;
    store.changed('curves');
    return true;
  }

  private async ask(step: number | null, shape: string): Promise<Curves | undefined> {
    if (step === null) return this.answer('curves', shape);
    const answer = await this.answer('curves', shape, { step });
    if (answer) return answer;
    // The seams of a sharp result are still to be seen in it.
    const sharp = this.store.document.steps[step]?.options.radius === undefined;
    return sharp ? this.answer('curves', shape) : { origin: [0, 0, 0], curves: [] };
  }

  private async answer(what: string, shape: string, keys: object = { shape }): Promise<Curves | undefined> {
    const answer = await this.actions.quietly<Partial<Curves> & { loops?: Curve[] }>(what, keys);
    if (!answer) return undefined;
    const origin = answer.origin ?? this.store.meshes.get(shape)?.origin ?? [0, 0, 0];
    return { revision: answer.revision, origin, curves: answer.curves ?? answer.loops ?? [] };
  }

  private drop() {
    if (this.asked === '' && !this.store.curves) return;
    this.asked = '';
    this.store.curves = undefined;
    this.store.largest = undefined;
    this.store.changed('curves');
  }

  /** Picks a curve, or one more. */
  pick(curve: Curve | undefined, more: boolean) {
    const set = this.store.curves;
    if (!set) return;
    const others = more ? set.picked.filter((c) => c !== curve) : [];
    const again = set.picked.includes(curve as Curve) && more;
    set.picked = curve && !again ? [...others, curve] : others;
    this.store.changed('curves');
    void this.radius.askLargest();
  }
}

/** The curves that lie where the picked ones lay. */
function samePlaces(picked: Curve[], curves: Curve[]): Curve[] {
  return picked.map((old) => curves.find((c) => c.id === old.id && c.closed === old.closed)).filter((c) => c !== undefined);
}

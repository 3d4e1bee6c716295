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
    if (!store.look.edges || store.selection.length > 1) return this.drop();
    const row = store.focus;
    const step = store.step(row);
    const shape = row ? store.shapeOf(row) : undefined;
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
    this.asked = key;
    const kind = !blends && known && !known.closed ? 'loops' : 'features';
    const answer = await this.ask(blends ? row.index : null, shape, kind);
    if (this.asked !== key) return;
    if (!answer) {
      // A step that failed has no curves now; it may have some after the next edit.
      this.asked = '';
      store.curves = undefined;
    } else {
      const picked = store.curves?.step === (blends ? row.index : null) && store.curves.shape === shape ? samePlaces(store.curves.picked, answer.curves) : [];
      store.curves = { ...answer, step: blends ? row.index : null, shape, kind, picked };
    }
    store.largest = undefined;
    store.changed('curves');
    if (answer && (blends || store.curves?.picked.length)) void this.radius.askLargest();
  }

  private async ask(step: number | null, shape: string, kind: 'features' | 'loops'): Promise<Curves | undefined> {
    if (kind === 'loops') return this.answer('loops', { shape });
    if (step !== null) return (await this.answer('curves', { step })) ?? this.answer('curves', { shape });
    return this.answer('curves', { shape });
  }

  private async answer(what: string, keys: object): Promise<Curves | undefined> {
    const answer = await this.actions.quietly<Curves | Curve[]>(what, keys);
    if (!answer) return undefined;
    if (Array.isArray(answer)) return { origin: [0, 0, 0], curves: answer };
    const listed = answer as Curves & { loops?: Curve[] };
    return { origin: listed.origin ?? ([0, 0, 0] as Vector), curves: (listed.curves ?? listed.loops ?? []).map((c, i) => ({ ...c, id: c.id ?? i })) };
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

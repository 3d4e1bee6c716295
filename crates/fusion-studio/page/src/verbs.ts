// What the verbs of the toolbar do: most add a step on the selected shapes, some ask for more first.

import type { Actions } from './actions';
import type { Points } from './points';
import type { Options, Vector } from './protocol';
import type { Store } from './store';

/** Options to begin with, of verbs that do nothing without. */
const FIRST: { [verb: string]: Options } = { remesh: { edge_length: '1%' }, blend: { radius: '1%' } };

export class Verbs {
  constructor(private store: Store, private actions: Actions, private points: Points) {}

  run = (verb: string) => {
    if (verb === 'cut') return this.beginCut();
    if (verb === 'compose') return void this.actions.addStep(verb, this.openings());
    if (verb === 'blend') return void this.blend();
    void this.actions.addStep(verb, undefined, FIRST[verb]);
  };

  /** A cut needs a plane or a path: the section bar offers both. */
  private beginCut() {
    this.store.look.section = true;
    this.store.changed('look');
  }

  /** Cuts along a path through places that are clicked. */
  cutAlongPath = () => {
    const of = this.store.shapes;
    let path: Vector[] = [];
    this.store.look.section = false;
    this.store.changed('look');
    this.points.take((point) => {
      path = [...path, point];
      return 'more';
    }, 'Click three places or so round the limb, then Done.', () => {
      if (path.length >= 2) void this.actions.addStep('cut', of, { path });
    });
  };

  /** The picked loops of the selected shapes; all loops of those without a picked one. */
  private openings(): string[] {
    const { curves, shapes } = this.store;
    const picked = curves?.kind === 'loops' ? curves.picked : [];
    return shapes.flatMap((shape) => {
      const own = picked.filter((loop) => loop.shape === shape);
      return own.length > 0 ? own.map((loop) => `${shape}:${loop.id}`) : [shape];
    });
  }

  /** Blends the picked curves, or all sharp ones. */
  private async blend() {
    const { curves } = this.store;
    const near = (curves?.kind === 'features' ? curves.picked : []).map((c) => c.near).filter((p) => p !== undefined);
    await this.actions.addStep('blend', this.store.shapes, { ...FIRST.blend, ...(near.length > 0 ? { near } : {}) });
  }
}

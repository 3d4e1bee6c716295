// Clicks of places on the model for an option: each becomes an exact point, asked of the server.

import { Vector3 } from 'three';
import type { Actions } from './actions';
import { button, fill } from './dom';
import { setTool } from './panels/viewbar';
import type { Vector } from './protocol';
import type { Store } from './store';
import type { Hit } from './view/shapes';
import type { Drawn } from './view/stroke';
import type { View } from './view/view';

export class Points {
  private taker: ((point: Vector) => 'more' | 'stop') | undefined;
  private places: Vector3[] = [];
  private finish: (() => void) | undefined;

  constructor(private store: Store, private actions: Actions, private view: View, private hint: HTMLElement) {
    view.onPoint = (hit) => void this.click(hit);
    hint.hidden = true;
  }

  /** Lets the person click; each point is given to `take` until that says stop. */
  take(take: (point: Vector) => 'more' | 'stop', text: string, finish?: () => void) {
    this.finish = finish;
    this.taker = take;
    this.places = [];
    this.hint.hidden = false;
    fill(this.hint, text, button('apply', 'Done', 'No more points (Escape)', () => this.stop()));
    setTool(this.store, 'point');
  }

  /** Lets the person draw a stroke on the view. */
  draw(drawn: Drawn) {
    this.taker = () => 'stop';
    this.hint.hidden = false;
    fill(this.hint, 'Draw the silhouette with the left button, from one opening to the other.', button('close', 'Cancel', 'No stroke (Escape)', () => this.stop()));
    setTool(this.store, 'point');
    this.view.stroke.take((stroke, view) => {
      this.stop();
      drawn(stroke, view);
    });
  }

  /** Ends the clicks; answers whether there were any to end. */
  stop(): boolean {
    if (!this.taker) return false;
    this.taker = undefined;
    this.hint.hidden = true;
    this.view.marker.clear();
    this.view.stroke.stop();
    setTool(this.store, 'select');
    this.finish?.();
    this.finish = undefined;
    return true;
  }

  private async click(hit: Hit) {
    const take = this.taker;
    if (!take || this.view.stroke.waiting) return;
    const point = await this.actions.pick(hit);
    if (!point) return;
    this.places.push(new Vector3(...point));
    this.view.marker.show(this.places, true);
    if (take(point) === 'stop') this.stop();
  }
}

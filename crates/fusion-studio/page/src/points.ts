// Point options set by clicking on the model; the server returns the exact coordinates of each click.

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
  private vertex: ((vertex: number) => number[]) | undefined;
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

  /** Lets the person click vertices, by their numbers in the shape. */
  vertices(take: (vertices: number[]) => void) {
    const chosen: number[] = [];
    this.take(() => 'more', 'Click vertices; Escape ends.', () => chosen.length > 0 && take(chosen));
    this.vertex = (vertex) => {
      const at = chosen.indexOf(vertex);
      if (at < 0) chosen.push(vertex);
      else chosen.splice(at, 1);
      return chosen;
    };
  }

  /** Lets the person paint faces. */
  faces(take: (faces: number[]) => void) {
    const smaller = button('left', 'Smaller', 'A smaller brush', () => this.view.brush.resize(1 / 1.4));
    const larger = button('add', 'Larger', 'A larger brush', () => this.view.brush.resize(1.4));
    this.taker = () => 'more';
    this.hint.hidden = false;
    fill(this.hint, 'Paint with the left button; Alt takes paint away.', smaller, larger, button('apply', 'Done', 'Take what is painted (Escape)', () => this.stop()));
    setTool(this.store, 'point');
    this.view.brush.start();
    this.finish = () => {
      const painted = this.view.brush.stop();
      if (painted) take(painted.faces);
    };
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
    const { finish } = this;
    this.finish = this.vertex = undefined;
    finish?.();
    return true;
  }

  /** The corner of the face that is nearest to the pointer. */
  private clickVertex(hit: Hit, choose: (vertex: number) => number[]) {
    const frame = this.view.shapes.frame(hit.shape);
    if (!frame) return;
    const corner = hit.bary.indexOf(Math.max(...hit.bary));
    const chosen = choose(frame.faces[3 * hit.face + corner]);
    const place = (v: number) => new Vector3(...[0, 1, 2].map((k) => frame.positions[3 * v + k] + frame.origin[k]));
    this.view.marker.show(chosen.map(place));
  }

  private async click(hit: Hit) {
    const take = this.taker;
    if (!take || this.view.stroke.waiting || this.view.brush.active) return;
    if (this.vertex) return this.clickVertex(hit, this.vertex);
    const point = await this.actions.pick(hit);
    if (!point) return;
    this.places.push(new Vector3(...point));
    this.view.marker.show(this.places, true);
    if (take(point) === 'stop') this.stop();
  }
}

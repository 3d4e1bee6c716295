// What the mouse does in the view: orbit is the camera's, all else is decided here.

import { Vector3 } from 'three';
import type { Radius } from '../radius';
import type { Store } from '../store';
import type { Ball } from './ball';
import type { CurveLines } from './curves';
import type { Handles } from './handles';
import type { Gizmo } from './gizmo';
import type { Rider } from './rider';
import type { Hit, Shapes } from './shapes';
import type { Stage } from './stage';
import type { Curve } from '../protocol';

/** What a click means to the rest of the page. */
export interface Clicks {
  shape(hit: Hit | undefined, more: boolean): void;
  curve(curve: Curve, more: boolean, place: Vector3): void;
  measure(hit: Hit): void;
  point(hit: Hit): void;
  hover(hit: Hit | undefined): void;
}

/** Pixels that the mouse may move in a click. */
const STILL = 4;

export class Pointer {
  private down: { x: number; y: number } | undefined;
  private pulling: { x: number; y: number; radius: number; scale: number } | undefined;
  private hovering = false;

  constructor(
    private stage: Stage, private shapes: Shapes, private lines: CurveLines, private ball: Ball, private handles: Handles, private rider: Rider, private gizmo: Gizmo,
    private radius: Radius, private store: Store, private clicks: Clicks,
  ) {
    const canvas = stage.renderer.domElement;
    // Before the camera's own listeners, so that a pull on the ball does not orbit.
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.release(event));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  private press(event: PointerEvent) {
    if (event.button !== 0) return;
    const { offsetX: x, offsetY: y } = event;
    this.down = { x, y };
    const handle = this.store.tool === 'select' ? this.handles.under(x, y) : undefined;
    if (handle !== undefined) {
      this.handles.begin(handle);
      this.stage.orbit.enabled = false;
      (event.target as HTMLElement).setPointerCapture(event.pointerId);
      return;
    }
    if (this.store.tool === 'move' && !this.gizmo.busy) {
      const hit = this.shapes.hit(this.position(event));
      if (this.rider.begin(hit?.shape, x, y)) (event.target as HTMLElement).setPointerCapture(event.pointerId);
    }
    if (!this.ball.isUnder(x, y) || this.gizmo.busy || this.store.tool !== 'select') return;
    const ball = this.ball.onScreen();
    const reach = Math.max(8, Math.hypot(x - ball.x, y - ball.y));
    this.pulling = { x: ball.x, y: ball.y, radius: this.ball.radius, scale: reach };
    this.stage.orbit.enabled = false;
    (event.target as HTMLElement).setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent) {
    if (this.handles.pulling) return this.handles.pull(event.offsetX, event.offsetY);
    if (this.rider.pulling) return this.rider.pull(event.offsetX, event.offsetY);
    if (this.pulling) {
      // As far from the ball's centre as the pointer is, in shares of where it was taken.
      const { x, y, radius, scale } = this.pulling;
      const share = Math.hypot(event.offsetX - x, event.offsetY - y) / scale;
      const most = this.store.largest?.radius ?? Infinity;
      this.radius.drag(Number(Math.min(most, Math.max(radius * share, 1e-6 * radius)).toPrecision(3)));
      return;
    }
    if (event.buttons !== 0 || this.hovering) return;
    this.hovering = true;
    requestAnimationFrame(() => {
      this.hovering = false;
      this.hover(event);
    });
  }

  private hover(event: PointerEvent) {
    const pointer = this.position(event);
    const hit = this.shapes.hit(pointer, this.solid);
    this.clicks.hover(hit);
    const selecting = this.store.tool === 'select' || this.store.tool === 'move' || this.store.tool === 'rotate';
    this.lines.hover(selecting && !this.gizmo.busy ? this.lines.nearest(pointer, hit?.point)?.curve : undefined);
    const pulls = this.ball.isUnder(event.offsetX, event.offsetY) || this.handles.under(event.offsetX, event.offsetY) !== undefined;
    if (pulls && selecting) this.stage.renderer.domElement.style.cursor = 'nwse-resize';
  }

  private release(event: PointerEvent) {
    if (this.rider.pulling) this.rider.end();
    if (this.handles.pulling) {
      this.handles.end();
      this.stage.orbit.enabled = true;
      this.down = undefined;
      return;
    }
    if (this.pulling) {
      this.pulling = undefined;
      this.stage.orbit.enabled = true;
      const still = this.down && Math.hypot(event.offsetX - this.down.x, event.offsetY - this.down.y) <= STILL;
      this.radius.end();
      if (!still) return;
    }
    const { down } = this;
    this.down = undefined;
    if (!down || event.button !== 0 || this.gizmo.busy) return;
    if (Math.hypot(event.offsetX - down.x, event.offsetY - down.y) > STILL) return;
    const pointer = this.position(event);
    const hit = this.shapes.hit(pointer, this.solid);
    const more = event.shiftKey || event.ctrlKey || event.metaKey;
    const { tool } = this.store;
    if (tool === 'measure') return hit && this.clicks.measure(hit);
    if (tool === 'point' || tool === 'path') return hit && this.clicks.point(hit);
    const picked = this.lines.nearest(pointer, hit?.point);
    if (picked) this.clicks.curve(picked.curve, more, picked.place);
    else this.clicks.shape(hit, more);
  }

  /** A click goes through ghosts. */
  private solid = (shape: string) => this.store.results.includes(shape);

  /** The place of an event in the view, from -1 to 1. */
  private position(event: PointerEvent): Vector3 {
    const { clientWidth: width, clientHeight: height } = this.stage.host;
    return new Vector3((2 * event.offsetX) / width - 1, 1 - (2 * event.offsetY) / height, 0);
  }
}

// A stroke drawn on the view, put on the plane across the view through the middle of what is joined.

import { BufferGeometry, Line, LineBasicMaterial, Plane, Raycaster, Vector2, Vector3 } from 'three';
import type { Vector } from '../protocol';
import type { Stage } from './stage';

/** Told the points of a stroke and the direction of the view. */
export type Drawn = (stroke: Vector[], view: Vector) => void;

/** Pixels between points of a stroke. */
const STEP = 12;

export class Stroke {
  private line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xff4d6d, depthTest: false, transparent: true }));
  private points: Vector3[] = [];
  private last = new Vector2();
  private plane = new Plane();
  private taker: Drawn | undefined;

  constructor(private stage: Stage) {
    this.line.renderOrder = 13;
    this.line.frustumCulled = false;
    stage.overlay.add(this.line);
    const canvas = stage.renderer.domElement;
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', () => this.release());
  }

  /** Waits for a stroke, on the plane across the view through a place. */
  take(drawn: Drawn) {
    this.taker = drawn;
    this.stage.renderer.domElement.style.cursor = 'crosshair';
  }

  /** Whether a stroke is waited for. */
  get waiting(): boolean {
    return this.taker !== undefined;
  }

  stop() {
    this.taker = undefined;
    this.points = [];
    this.stage.orbit.enabled = true;
    this.stage.renderer.domElement.style.cursor = '';
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry();
    this.stage.draw();
  }

  private press(event: PointerEvent) {
    if (!this.taker || event.button !== 0) return;
    this.stage.orbit.enabled = false;
    const direction = this.stage.camera.getWorldDirection(new Vector3());
    this.plane.setFromNormalAndCoplanarPoint(direction, this.stage.bounds().center);
    this.points = [];
    this.add(event);
  }

  private move(event: PointerEvent) {
    if (this.points.length === 0 || event.buttons === 0) return;
    if (Math.hypot(event.offsetX - this.last.x, event.offsetY - this.last.y) >= STEP) this.add(event);
  }

  private add(event: PointerEvent) {
    const { clientWidth: width, clientHeight: height } = this.stage.host;
    this.last.set(event.offsetX, event.offsetY);
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * event.offsetX) / width - 1, 1 - (2 * event.offsetY) / height), this.stage.camera);
    const at = ray.ray.intersectPlane(this.plane, new Vector3());
    if (!at) return;
    this.points.push(at);
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setFromPoints(this.points);
    this.stage.draw();
  }

  private release() {
    const { taker } = this;
    if (!taker || this.points.length === 0) return;
    const tidy = (v: Vector3) => v.toArray().map((x) => (Math.abs(x) < 1e-9 ? 0 : Number(x.toPrecision(6)))) as Vector;
    const stroke = this.points.map(tidy);
    const view = tidy(this.stage.camera.getWorldDirection(new Vector3()));
    this.stop();
    if (stroke.length >= 3) taker(stroke, view);
  }
}

// Radii at places of a curve, as balls to pull: each is an entry of the step's `radius_at`.

import { Mesh, MeshPhongMaterial, Object3D, SphereGeometry, Vector3 } from 'three';
import { Pacer, type Actions } from '../actions';
import type { Json, Vector } from '../protocol';
import type { Row, Store } from '../store';
import type { Stage } from './stage';

interface Entry {
  at: Vector;
  radius: Json;
}

export class Handles {
  private group = new Object3D();
  private balls: Mesh[] = [];
  private entries: Entry[] = [];
  private pulled: { index: number; drag: number } | undefined;
  private pacer: Pacer<{ row: Row; entries: Entry[]; drag: number }>;

  constructor(private stage: Stage, private store: Store, private actions: Actions) {
    this.pacer = new Pacer(({ row, entries, drag }) => void this.actions.setAll(row, { radius_at: entries as unknown as Json }, drag), store);
    stage.overlay.add(this.group);
    store.on(['document', 'selection'], () => this.draw());
    store.on(['evaluated', 'failure'], () => this.pacer.done());
  }

  /** The ball under the pointer, in pixels of the canvas. */
  under(x: number, y: number): number | undefined {
    const found = this.balls.findIndex((_, i) => {
      const ball = this.onScreen(i);
      return Math.hypot(x - ball.x, y - ball.y) <= Math.max(ball.radius, 7);
    });
    return found < 0 ? undefined : found;
  }

  /** Where a ball is on the screen: centre and radius in pixels. */
  onScreen(index: number): { x: number; y: number; radius: number } {
    const { camera, host } = this.stage;
    const ball = this.balls[index];
    const centre = ball.position.clone().project(camera);
    const right = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
    const edge = ball.position.clone().addScaledVector(right, ball.scale.x).project(camera);
    const [w, h] = [host.clientWidth / 2, host.clientHeight / 2];
    return { x: (centre.x + 1) * w, y: (1 - centre.y) * h, radius: Math.abs(edge.x - centre.x) * w };
  }

  begin(index: number) {
    this.pulled = { index, drag: this.actions.newDrag() };
  }

  /** As large as the pointer is away from the ball's centre. */
  pull(x: number, y: number) {
    const row = this.store.focus;
    if (!this.pulled || !row) return;
    const { index, drag } = this.pulled;
    const ball = this.onScreen(index);
    const scale = this.balls[index].scale.x / Math.max(ball.radius, 1e-6);
    const radius = Number(Math.max(1e-9, Math.hypot(x - ball.x, y - ball.y) * scale).toPrecision(3));
    this.balls[index].scale.setScalar(radius);
    this.entries = this.entries.map((entry, i) => (i === index ? { ...entry, radius } : entry));
    this.pacer.push({ row, entries: this.entries, drag });
    this.stage.draw();
  }

  end() {
    const row = this.store.focus;
    if (this.pulled && row) void this.actions.setAll(row, { radius_at: this.entries as unknown as Json }, this.pulled.drag);
    this.pulled = undefined;
  }

  get pulling(): boolean {
    return this.pulled !== undefined;
  }

  private draw() {
    if (this.pulled) return;
    const listed = this.store.step(this.store.focus)?.options.radius_at;
    this.entries = Array.isArray(listed) ? (listed as unknown as Entry[]) : [];
    this.group.clear();
    this.balls = this.entries.map(({ at, radius }) => {
      const material = new MeshPhongMaterial({ color: 0x2fb5a8, transparent: true, opacity: 0.45, depthWrite: false, depthTest: false });
      const ball = new Mesh(new SphereGeometry(1, 32, 20), material);
      ball.position.set(...at);
      ball.scale.setScalar(this.length(radius));
      ball.renderOrder = 6;
      this.group.add(ball);
      return ball;
    });
    this.stage.draw();
  }

  private length(radius: Json): number {
    const share = typeof radius === 'string' && radius.endsWith('%');
    return Math.max(share ? (parseFloat(radius as string) / 100) * this.store.drawnSize() : Number(radius), 1e-9);
  }
}

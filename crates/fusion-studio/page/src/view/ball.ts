// The rolling ball at the picked curve: shows the radius in place, and is pulled to change it.

import { Mesh, MeshPhongMaterial, SphereGeometry, Vector3 } from 'three';
import type { Vector } from '../protocol';
import type { Stage } from './stage';

/** A place of a curve, and the normals of both sides there. */
export interface Stand {
  place: Vector3;
  normals: [Vector, Vector];
}

export class Ball {
  private mesh = new Mesh(
    new SphereGeometry(1, 40, 24),
    new MeshPhongMaterial({ color: 0xff7a18, transparent: true, opacity: 0.42, depthWrite: false, depthTest: false, shininess: 60 }),
  );
  private contact = new Vector3();
  /** Where the centre goes, for each unit of the radius. */
  private towards = new Vector3();
  radius = 0;

  constructor(private stage: Stage) {
    this.mesh.visible = false;
    this.mesh.renderOrder = 5;
    stage.overlay.add(this.mesh);
  }

  /** Draws the ball on both sides of a curve. */
  show(stand: Stand | undefined, convex: boolean, radius: number) {
    const shown = stand !== undefined && radius > 0;
    this.mesh.visible = shown;
    if (shown) {
      const [a, b] = stand.normals.map((n) => new Vector3(...n));
      this.contact.copy(stand.place);
      // The ball touches both sides: outside of a valley, inside of a ridge.
      this.towards.copy(a).add(b).divideScalar(Math.max(0.05, 1 + a.dot(b)));
      if (convex) this.towards.negate();
      this.resize(radius);
    }
    this.stage.draw();
  }

  resize(radius: number) {
    this.radius = radius;
    this.mesh.scale.setScalar(Math.max(radius, 1e-12));
    this.mesh.position.copy(this.contact).addScaledVector(this.towards, radius);
    this.stage.draw();
  }

  get visible(): boolean {
    return this.mesh.visible;
  }

  /** Where the ball is on the screen: centre and radius in pixels of the canvas. */
  onScreen(): { x: number; y: number; radius: number } {
    const { camera, host } = this.stage;
    const centre = this.mesh.position.clone().project(camera);
    const right = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
    const edge = this.mesh.position.clone().addScaledVector(right, this.radius).project(camera);
    const [w, h] = [host.clientWidth / 2, host.clientHeight / 2];
    return { x: (centre.x + 1) * w, y: (1 - centre.y) * h, radius: Math.abs(edge.x - centre.x) * w };
  }

  /** Whether the pointer, in pixels of the canvas, is on the ball. */
  isUnder(x: number, y: number): boolean {
    if (!this.visible) return false;
    const ball = this.onScreen();
    return Math.hypot(x - ball.x, y - ball.y) <= Math.max(ball.radius, 8);
  }
}

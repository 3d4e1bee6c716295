// A brush that paints faces of one shape; what was painted is told by the numbers of the faces.

import { Box3, BufferAttribute, BufferGeometry, Mesh, MeshBasicMaterial, Sphere, Triangle } from 'three';
import { tree } from './surface';
import type { Hit, Shapes } from './shapes';
import type { Stage } from './stage';

export class Brush {
  private faces = new Set<number>();
  private shape: string | undefined;
  private painting = false;
  private on = false;
  /** Reach of the brush, in pixels. */
  private reach = 24;
  private paint = new Mesh(
    new BufferGeometry(),
    new MeshBasicMaterial({ color: 0xff4d6d, transparent: true, opacity: 0.75, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -1 }),
  );

  constructor(private stage: Stage, private shapes: Shapes) {
    this.paint.frustumCulled = false;
    this.paint.raycast = () => undefined;
    stage.overlay.add(this.paint);
    const canvas = stage.renderer.domElement;
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.painting && this.dab(event));
    canvas.addEventListener('pointerup', () => this.release());
  }

  /** Begins to paint, with these faces painted already. */
  start() {
    this.faces.clear();
    this.shape = undefined;
    this.on = true;
    this.draw();
  }

  /** Makes the brush larger or smaller. */
  resize(by: number) {
    this.reach = Math.min(200, Math.max(3, this.reach * by));
  }

  /** Ends; answers the shape and its painted faces. */
  stop(): { shape: string; faces: number[] } | undefined {
    const { shape } = this;
    const faces = [...this.faces].sort((a, b) => a - b);
    this.on = false;
    this.faces.clear();
    this.draw();
    return shape === undefined || faces.length === 0 ? undefined : { shape, faces };
  }

  get active(): boolean {
    return this.on;
  }

  private press(event: PointerEvent) {
    if (!this.on || event.button !== 0 || !this.dab(event)) return;
    // Beside the model the mouse still orbits.
    this.painting = true;
    this.stage.orbit.enabled = false;
  }

  private release() {
    if (!this.painting) return;
    this.painting = false;
    this.stage.orbit.enabled = true;
  }

  /** Paints around the pointer; Alt takes paint away. */
  private dab(event: PointerEvent): boolean {
    const { clientWidth: width, clientHeight: height } = this.stage.host;
    const hit = this.shapes.hit({ x: (2 * event.offsetX) / width - 1, y: 1 - (2 * event.offsetY) / height });
    if (!hit || (this.shape !== undefined && hit.shape !== this.shape)) return false;
    this.shape = hit.shape;
    for (const face of this.around(hit)) this.faces[event.altKey ? 'delete' : 'add'](face);
    this.draw();
    return true;
  }

  private around(hit: Hit): number[] {
    const mesh = this.shapes.mesh(hit.shape);
    if (!mesh) return [];
    const size = this.reach * this.stage.pixel(hit.point);
    const sphere = new Sphere(mesh.worldToLocal(hit.point.clone()), size);
    const found = [hit.face];
    const nearest = hit.point.clone();
    tree(mesh.geometry).shapecast({
      intersectsBounds: (box: Box3) => box.intersectsSphere(sphere),
      intersectsTriangle: (triangle: Triangle, face: number) => {
        if (triangle.closestPointToPoint(sphere.center, nearest).distanceTo(sphere.center) <= size) found.push(face);
        return false;
      },
    });
    return found;
  }

  private draw() {
    const mesh = this.shape === undefined ? undefined : this.shapes.mesh(this.shape);
    this.paint.geometry.dispose();
    this.paint.geometry = new BufferGeometry();
    this.paint.visible = this.faces.size > 0 && mesh !== undefined;
    if (mesh && this.paint.visible) {
      const from = mesh.geometry.attributes.position.array;
      const corners = new Float32Array(9 * this.faces.size);
      let at = 0;
      for (const face of this.faces) {
        corners.set(from.slice(9 * face, 9 * face + 9), at);
        at += 9;
      }
      this.paint.geometry.setAttribute('position', new BufferAttribute(corners, 3));
      mesh.updateWorldMatrix(true, false);
      mesh.matrixWorld.decompose(this.paint.position, this.paint.quaternion, this.paint.scale);
    }
    this.stage.draw();
  }
}

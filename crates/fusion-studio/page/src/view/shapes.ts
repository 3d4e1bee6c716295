// The shapes in the view: one mesh for each, redrawn when its revision changes.

import {
  Color, DoubleSide, LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, MeshPhongMaterial, Object3D, Raycaster, ShaderMaterial, Vector3,
} from 'three';
import { acceleratedRaycast } from 'three-mesh-bvh';
import type { FieldFrame, MeshFrame, Pick, Vector } from '../protocol';
import type { Look } from '../store';
import { byField, byOrigin, partColour } from './colours';
import type { Stage } from './stage';
import { surface, tree } from './surface';
import { zebra } from './zebra';

Mesh.prototype.raycast = acceleratedRaycast;

/** How a shape is to be drawn. */
export interface Manner {
  selected: boolean;
  ghost: boolean;
  /** The last valid result, while a newer one is made or has failed. */
  dimmed: boolean;
  colour: Color;
}

/** A place that the pointer hits. */
export interface Hit extends Pick {
  point: Vector3;
  normal: Vector3;
}

class Shape {
  readonly group = new Object3D();
  readonly mesh: Mesh;
  private wire: Mesh;
  private material = new MeshPhongMaterial({
    side: DoubleSide, shininess: 28, specular: 0x2a2a2a, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  private stripes: ShaderMaterial = zebra();
  private coloured = '';

  constructor(public frame: MeshFrame) {
    this.mesh = new Mesh(surface(frame), this.material);
    this.mesh.userData.shape = frame.shape;
    const lines = new MeshBasicMaterial({ wireframe: true, transparent: true, opacity: 0.28, color: 0x0a0c10 });
    this.wire = new Mesh(this.mesh.geometry, lines);
    this.wire.raycast = () => undefined;
    this.group.add(this.mesh, this.wire);
    this.group.position.set(...frame.origin);
  }

  renew(frame: MeshFrame) {
    this.mesh.geometry.dispose();
    this.frame = frame;
    this.mesh.geometry = surface(frame);
    this.wire.geometry = this.mesh.geometry;
    this.group.matrixAutoUpdate = true;
    this.group.position.set(...frame.origin);
    this.group.rotation.set(0, 0, 0);
    this.group.scale.set(1, 1, 1);
    this.coloured = '';
  }

  draw(manner: Manner, look: Look, field: FieldFrame | undefined) {
    const material = this.material;
    this.colour(look, field);
    const coloured = this.coloured !== '' && !manner.ghost;
    const before = [material.vertexColors, material.transparent];
    material.vertexColors = coloured;
    material.color.copy(coloured ? new Color(0xffffff) : manner.colour);
    material.emissive.set(manner.selected ? 0x1d2c44 : 0x000000);
    const opacity = manner.ghost ? (manner.selected ? 0.38 : 0.16) : manner.dimmed ? 0.45 : 1;
    material.transparent = opacity < 1;
    material.opacity = opacity;
    material.depthWrite = !manner.ghost;
    if (before[0] !== material.vertexColors || before[1] !== material.transparent) material.needsUpdate = true;
    this.mesh.material = look.colour === 'zebra' && !manner.ghost ? this.stripes : material;
    this.mesh.renderOrder = manner.ghost ? 1 : 0;
    this.wire.visible = look.wire && !manner.ghost;
  }

  private colour(look: Look, field: FieldFrame | undefined) {
    const fresh = field && field.revision === this.frame.revision ? field : undefined;
    const wanted = look.colour === 'origin' ? 'origin' : fresh ? fresh.field : '';
    if (wanted === this.coloured) return;
    if (wanted === 'origin') byOrigin(this.mesh.geometry, this.frame);
    else if (fresh) byField(this.mesh.geometry, this.frame, fresh.values, fresh.field === 'curvature');
    this.coloured = wanted;
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.material.dispose();
    this.stripes.dispose();
    (this.wire.material as LineBasicMaterial).dispose();
  }
}

export class Shapes {
  private shapes = new Map<string, Shape>();
  private ray = new Raycaster();
  readonly fields = new Map<string, FieldFrame>();

  constructor(private stage: Stage) {
    this.ray.firstHitOnly = true;
  }

  /** Takes a mesh that the server sent; answers whether it was not there before. */
  take(frame: MeshFrame): boolean {
    const old = this.shapes.get(frame.shape);
    if (old) old.renew(frame);
    else {
      const shape = new Shape(frame);
      this.shapes.set(frame.shape, shape);
      this.stage.content.add(shape.group);
    }
    this.stage.draw();
    return !old;
  }

  /** Removes all shapes but these. */
  prune(names: string[]) {
    for (const [name, shape] of this.shapes) {
      if (names.includes(name)) continue;
      this.stage.content.remove(shape.group);
      shape.dispose();
      this.shapes.delete(name);
    }
  }

  /** Draws these shapes, each in its manner; others wait to be evaluated. */
  draw(manners: Map<string, Manner>, look: Look) {
    for (const [name, shape] of this.shapes) {
      const manner = manners.get(name);
      if (manner) shape.draw(manner, look, this.fields.get(name));
      shape.group.visible = manner !== undefined;
    }
    this.stage.draw();
  }

  /** What the pointer hits first, with the face's number and barycentric coordinates. */
  hit(pointer: { x: number; y: number }, only?: (shape: string) => boolean): Hit | undefined {
    const { camera } = this.stage;
    this.ray.setFromCamera(new Vector3(pointer.x, pointer.y, 0) as never, camera);
    const shown = [...this.shapes.values()].filter((s) => s.group.visible && (only?.(s.frame.shape) ?? true));
    for (const shape of shown) tree(shape.mesh.geometry);
    const planes = this.stage.renderer.clippingPlanes as { distanceToPoint(p: Vector3): number }[];
    // A cut-away half must not be hit.
    this.ray.firstHitOnly = planes.length === 0;
    const found = this.ray.intersectObjects(shown.map((s) => s.mesh), false);
    const hit = found.find((i) => planes.every((plane) => plane.distanceToPoint(i.point) >= 0));
    if (!hit || hit.faceIndex === undefined || hit.faceIndex === null) return undefined;
    const shape = hit.object.userData.shape as string;
    const mesh = hit.object as Mesh;
    const bary = barycentric(mesh, hit.faceIndex, hit.point);
    const normal = hit.face!.normal.clone().transformDirection(mesh.matrixWorld);
    return { shape, face: hit.faceIndex, bary, point: hit.point, normal };
  }

  /** The object of a shape, for the gizmo. */
  object(shape: string): Object3D | undefined {
    return this.shapes.get(shape)?.group;
  }

  mesh(shape: string): Mesh | undefined {
    return this.shapes.get(shape)?.mesh;
  }

  frame(shape: string): MeshFrame | undefined {
    return this.shapes.get(shape)?.frame;
  }

  get names(): string[] {
    return [...this.shapes.keys()];
  }
}

/** The colour of the shape of part k, or of a step's result. */
export function shapeColour(part: number | undefined): Color {
  return part === undefined ? new Color('#b9c0ca') : partColour(part);
}

function barycentric(mesh: Mesh, face: number, point: Vector3): Vector {
  const p = mesh.geometry.attributes.position;
  const local = point.clone().applyMatrix4(new Matrix4().copy(mesh.matrixWorld).invert());
  const [a, b, c] = [0, 1, 2].map((k) => new Vector3().fromBufferAttribute(p as never, 3 * face + k));
  const area = (u: Vector3, v: Vector3, w: Vector3) => v.clone().sub(u).cross(w.clone().sub(u)).length();
  const weights = [area(local, b, c), area(a, local, c), area(a, b, local)];
  const sum = weights[0] + weights[1] + weights[2] || 1;
  return weights.map((w) => w / sum) as Vector;
}

// Feature curves, seams and boundary loops as lines that light up under the pointer.

import { Color, Object3D, Vector3 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Curve, Vector } from '../protocol';
import type { CurveSet } from '../store';
import type { Stage } from './stage';

const CONVEX = new Color('#3d4a5c');
const CONCAVE = new Color('#7a5a2e');
const SEAM = new Color('#f5a524');
const LOOP = new Color('#2fb5a8');
/** How near the pointer must come, in pixels. */
const REACH = 9;

export class CurveLines {
  private group = new Object3D();
  private all = lines(2.5, -2);
  private hovered = lines(5, -6);
  private picked = lines(5, -4);
  private set: CurveSet | undefined;
  private over: Curve | undefined;

  constructor(private stage: Stage) {
    this.group.add(this.all, this.picked, this.hovered);
    this.hovered.material.color.set('#ffffff');
    this.picked.material.color.set('#ff7a18');
    this.hovered.renderOrder = 4;
    this.picked.renderOrder = 3;
    stage.overlay.add(this.group);
    stage.renderer.domElement.addEventListener('pointerleave', () => this.hover(undefined));
  }

  /** Draws these curves instead of those before. */
  show(set: CurveSet | undefined, visible: boolean) {
    this.set = set;
    this.group.visible = visible && set !== undefined;
    if (set) {
      this.group.position.set(...set.origin);
      fill(this.all, set.curves, (curve) => colour(curve, set.kind));
      fill(this.picked, set.picked);
    }
    this.hover(undefined);
    this.stage.draw();
  }

  /** Lights a curve up. */
  hover(curve: Curve | undefined) {
    if (curve === this.over) return;
    this.over = curve;
    fill(this.hovered, curve ? [curve] : []);
    this.stage.renderer.domElement.style.cursor = curve ? 'pointer' : '';
    this.stage.draw();
  }

  /** The curve that is nearest to the pointer on the screen, unless the surface hides it. */
  nearest(pointer: { x: number; y: number }, surface: Vector3 | undefined): { curve: Curve; place: Vector3 } | undefined {
    const { set } = this;
    if (!set || !this.group.visible) return undefined;
    const { camera, host } = this.stage;
    const [width, height] = [host.clientWidth / 2, host.clientHeight / 2];
    const matrix = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    const slack = 0.02 * this.stage.bounds().radius;
    const hidden = surface ? surface.distanceTo(camera.position) + slack : Infinity;
    const origin = new Vector3(...set.origin);
    let best: { curve: Curve; place: Vector3 } | undefined;
    let least = REACH;
    const [from, to, world] = [new Vector3(), new Vector3(), new Vector3()];
    const project = (point: Vector, out: Vector3) => {
      world.set(...point).add(origin);
      const far = world.distanceTo(camera.position) > hidden;
      out.copy(world).applyMatrix4(matrix);
      return !far && out.z < 1;
    };
    for (const curve of set.curves) {
      const { points } = curve;
      let seen = points.length > 0 && project(points[0], from);
      for (let i = 1; i < points.length + (curve.closed ? 1 : 0); i++) {
        const seenNext = project(points[i % points.length], to);
        if (seen && seenNext) {
          const distance = toSegment(pointer, from, to, width, height);
          if (distance.pixels < least) {
            const [a, b] = [points[i - 1], points[i % points.length]].map((p) => new Vector3(...p).add(origin));
            [best, least] = [{ curve, place: a.lerp(b, distance.along) }, distance.pixels];
          }
        }
        from.copy(to);
        seen = seenNext;
      }
    }
    return best;
  }
}

/** The colour of a curve, for lines and lists. */
export function colour(curve: Curve, kind: CurveSet['kind']): Color {
  if (kind === 'loops') return LOOP;
  return curve.seam ? SEAM : curve.convex ? CONVEX : CONCAVE;
}

function lines(width: number, nearer: number): LineSegments2 & { material: LineMaterial } {
  const material = new LineMaterial({ linewidth: width, vertexColors: false, polygonOffset: true, polygonOffsetFactor: nearer, polygonOffsetUnits: nearer });
  const object = new LineSegments2(new LineSegmentsGeometry(), material);
  object.frustumCulled = false;
  object.visible = false;
  return object as LineSegments2 & { material: LineMaterial };
}

function fill(object: LineSegments2, curves: Curve[], paint?: (curve: Curve) => Color) {
  const positions: number[] = [];
  const colours: number[] = [];
  for (const curve of curves) {
    const { points } = curve;
    const ends = curve.closed ? points.length : points.length - 1;
    const c = paint?.(curve);
    for (let i = 0; i < ends; i++) {
      positions.push(...points[i], ...points[(i + 1) % points.length]);
      if (c) colours.push(c.r, c.g, c.b, c.r, c.g, c.b);
    }
  }
  object.visible = positions.length > 0;
  if (positions.length === 0) return;
  object.geometry.dispose();
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(positions);
  if (paint) geometry.setColors(colours);
  const material = object.material as LineMaterial;
  if (material.vertexColors !== (paint !== undefined)) {
    material.vertexColors = paint !== undefined;
    material.needsUpdate = true;
  }
  object.geometry = geometry;
}

/** Distance in pixels from the pointer to a segment, all in clip coordinates, and where along it. */
function toSegment(p: { x: number; y: number }, a: Vector3, b: Vector3, width: number, height: number): { pixels: number; along: number } {
  const [ax, ay, bx, by] = [a.x * width, a.y * height, b.x * width, b.y * height];
  const [px, py] = [p.x * width - ax, p.y * height - ay];
  const [dx, dy] = [bx - ax, by - ay];
  const length = dx * dx + dy * dy;
  const t = length > 0 ? Math.min(1, Math.max(0, (px * dx + py * dy) / length)) : 0;
  return { pixels: Math.hypot(px - t * dx, py - t * dy), along: t };
}

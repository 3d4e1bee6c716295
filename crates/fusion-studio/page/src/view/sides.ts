// The normals of the two faces at a curve, read from the mesh that is drawn; the ball touches both.

import { Box3, Sphere, Triangle, Vector3 } from 'three';
import type { Vector } from '../protocol';
import type { Shapes } from './shapes';
import { tree } from './surface';

/** Faces that turn by less belong to one side. */
const SAME = Math.cos((8 * Math.PI) / 180);

/** The normals at a place of a curve, if the shape has a crease there. */
export function sides(shapes: Shapes, shape: string, at: Vector3): [Vector, Vector] | undefined {
  const mesh = shapes.mesh(shape);
  const frame = shapes.frame(shape);
  if (!mesh || !frame) return undefined;
  const place = at.clone().sub(new Vector3(...frame.origin));
  const reach = new Sphere(place, 1e-4 * (mesh.geometry.boundingSphere?.radius ?? 1));
  const normals: Vector3[] = [];
  tree(mesh.geometry).shapecast({
    intersectsBounds: (box: Box3) => box.intersectsSphere(reach),
    intersectsTriangle: (triangle: Triangle) => {
      const nearest = triangle.closestPointToPoint(place, new Vector3());
      if (nearest.distanceTo(place) <= reach.radius && triangle.getArea() > 0) {
        const normal = triangle.getNormal(new Vector3());
        if (!normals.some((n) => n.dot(normal) > SAME)) normals.push(normal);
      }
      return false;
    },
  });
  return normals.length >= 2 ? [normals[0].toArray() as Vector, normals[1].toArray() as Vector] : undefined;
}

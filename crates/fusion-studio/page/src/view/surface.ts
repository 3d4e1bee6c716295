// The drawing geometry of a mesh: one vertex for each corner, with normals that break at creases.

import { BufferAttribute, BufferGeometry } from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import type { MeshFrame } from '../protocol';

/** Faces that turn by more than this are drawn with a crease between them. */
const CREASE = Math.cos((35 * Math.PI) / 180);

/** Makes the geometry to draw and to pick. Face k of it is face k of the mesh. */
export function surface(frame: MeshFrame): BufferGeometry {
  const { positions, faces } = frame;
  const corners = new Float32Array(3 * faces.length);
  for (let c = 0; c < faces.length; c++) {
    const v = 3 * faces[c];
    corners[3 * c] = positions[v];
    corners[3 * c + 1] = positions[v + 1];
    corners[3 * c + 2] = positions[v + 2];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(corners, 3));
  geometry.setAttribute('normal', new BufferAttribute(cornerNormals(corners, faces, positions.length / 3), 3));
  geometry.computeBoundingSphere();
  return geometry;
}

/** The tree for picking, made when it is first needed. Indirect: faces keep their numbers. */
export function tree(geometry: BufferGeometry): MeshBVH {
  geometry.boundsTree ??= new MeshBVH(geometry, { indirect: true });
  return geometry.boundsTree as MeshBVH;
}

/** For each corner the mean normal of the faces around its vertex that do not turn away by a crease. */
function cornerNormals(corners: Float32Array, faces: Uint32Array, vertexCount: number): Float32Array {
  const count = faces.length / 3;
  // Weighted by area, and of length one.
  const areas = new Float32Array(3 * count);
  const units = new Float32Array(3 * count);
  for (let f = 0; f < count; f++) faceNormal(corners, f, areas, units);
  // The faces around each vertex, as lists one behind the other.
  const first = new Uint32Array(vertexCount + 1);
  for (const v of faces) first[v + 1]++;
  for (let v = 0; v < vertexCount; v++) first[v + 1] += first[v];
  const fill = first.slice(0, vertexCount);
  const around = new Uint32Array(faces.length);
  for (let c = 0; c < faces.length; c++) around[fill[faces[c]]++] = (c / 3) | 0;
  const normals = new Float32Array(3 * faces.length);
  for (let c = 0; c < faces.length; c++) {
    const own = 3 * ((c / 3) | 0);
    const [ux, uy, uz] = [units[own], units[own + 1], units[own + 2]];
    let [x, y, z] = [0, 0, 0];
    for (let i = first[faces[c]]; i < first[faces[c] + 1]; i++) {
      const f = 3 * around[i];
      if (ux * units[f] + uy * units[f + 1] + uz * units[f + 2] < CREASE) continue;
      x += areas[f];
      y += areas[f + 1];
      z += areas[f + 2];
    }
    const length = Math.hypot(x, y, z);
    normals[3 * c] = length > 0 ? x / length : ux;
    normals[3 * c + 1] = length > 0 ? y / length : uy;
    normals[3 * c + 2] = length > 0 ? z / length : uz;
  }
  return normals;
}

function faceNormal(p: Float32Array, face: number, areas: Float32Array, units: Float32Array) {
  const c = 9 * face;
  const [ax, ay, az] = [p[c + 3] - p[c], p[c + 4] - p[c + 1], p[c + 5] - p[c + 2]];
  const [bx, by, bz] = [p[c + 6] - p[c], p[c + 7] - p[c + 1], p[c + 8] - p[c + 2]];
  const [x, y, z] = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
  const length = Math.hypot(x, y, z) || 1;
  const o = 3 * face;
  areas[o] = x;
  areas[o + 1] = y;
  areas[o + 2] = z;
  units[o] = x / length;
  units[o + 1] = y / length;
  units[o + 2] = z / length;
}

// Models for the scenarios, made here: no scenario needs a file from elsewhere.

/** @typedef {[number, number, number]} Point */

/**
 * An OBJ file.
 * @param {Point[]} points
 * @param {number[][]} faces
 */
function obj(points, faces) {
  const lines = points.map((p) => `v ${p.map((x) => Number(x.toPrecision(9))).join(' ')}`);
  return [...lines, ...faces.map((f) => `f ${f.map((i) => i + 1).join(' ')}`), ''].join('\n');
}

/**
 * A closed body around a centre, with bumps as a scan has them; `rings` times `2 * rings` faces or so.
 * @param {number} rings
 * @param {Point} centre
 * @param {number} radius
 * @param {number} bumps
 */
export function scan(rings, centre, radius, bumps = 0.04) {
  /** @type {Point[]} */
  const points = [];
  const around = 2 * rings;
  /** @type {(u: number, v: number) => Point} */
  const at = (u, v) => {
    const r = radius * (1 + bumps * Math.sin(3 * u + 1) * Math.sin(v) ** 2 + 0.5 * bumps * Math.cos(5 * v));
    return [centre[0] + r * Math.sin(v) * Math.cos(u), centre[1] + r * Math.sin(v) * Math.sin(u), centre[2] + r * Math.cos(v)];
  };
  points.push(at(0, 0));
  for (let i = 1; i < rings; i++) for (let j = 0; j < around; j++) points.push(at((2 * Math.PI * j) / around, (Math.PI * i) / rings));
  points.push(at(0, Math.PI));
  const last = points.length - 1;
  const id = (/** @type {number} */ i, /** @type {number} */ j) => 1 + (i - 1) * around + (j % around);
  const faces = [];
  for (let j = 0; j < around; j++) {
    faces.push([0, id(1, j), id(1, j + 1)], [last, id(rings - 1, j + 1), id(rings - 1, j)]);
    for (let i = 1; i < rings - 1; i++) faces.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)], [id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
  }
  return obj(points, faces);
}

/**
 * A box of three extents, each side of n by n squares.
 * @param {Point} size
 * @param {number} n
 * @param {Point} centre
 */
export function box(size, n = 4, centre = [0, 0, 0]) {
  /** @type {Map<string, number>} */
  const ids = new Map();
  /** @type {Point[]} */
  const points = [];
  const id = (/** @type {number[]} */ grid) => {
    const key = grid.join();
    const old = ids.get(key);
    if (old !== undefined) return old;
    ids.set(key, points.length);
    points.push(/** @type {Point} */ (grid.map((g, k) => centre[k] + size[k] * (g / n - 0.5))));
    return points.length - 1;
  };
  const faces = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const side of [0, n]) {
      for (let a = 0; a < n; a++) {
        for (let b = 0; b < n; b++) {
          const corner = (/** @type {number} */ da, /** @type {number} */ db) => {
            const grid = [0, 0, 0];
            grid[axis] = side;
            grid[(axis + 1) % 3] = a + da;
            grid[(axis + 2) % 3] = b + db;
            return id(grid);
          };
          const square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
          if (side === 0) square.reverse();
          faces.push([square[0], square[1], square[2]], [square[0], square[2], square[3]]);
        }
      }
    }
  }
  return obj(points, faces);
}

/**
 * A tube along z, open at both ends.
 * @param {number} radius
 * @param {number} from
 * @param {number} to
 */
export function tube(radius, from, to, around = 32, rings = 8) {
  /** @type {Point[]} */
  const points = [];
  const faces = [];
  for (let i = 0; i <= rings; i++) {
    for (let j = 0; j < around; j++) {
      const angle = (2 * Math.PI * j) / around;
      points.push([radius * Math.cos(angle), radius * Math.sin(angle), from + ((to - from) * i) / rings]);
    }
  }
  for (let i = 0; i < rings; i++) {
    for (let j = 0; j < around; j++) {
      const k = (j + 1) % around;
      const [a, b, c, d] = [i * around + j, i * around + k, (i + 1) * around + k, (i + 1) * around + j];
      faces.push([a, b, c], [a, c, d]);
    }
  }
  return obj(points, faces);
}

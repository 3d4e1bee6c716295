// Colours of faces and vertices: by origin, or by a number that the server gives for each vertex.

import { BufferAttribute, Color, type BufferGeometry } from 'three';
import type { MeshFrame } from '../protocol';

/** What is new is amber; parts take the others in turn. */
const NEW = new Color('#f5a524');
const PARTS = ['#6fa8dc', '#8fc98a', '#c59bd8', '#e39a8d', '#79c7c5', '#c9c07a'].map((c) => new Color(c));

/** The colour of part k, from 0. */
export function partColour(k: number): Color {
  return PARTS[k % PARTS.length];
}

/** Colours each face by where it came from. */
export function byOrigin(geometry: BufferGeometry, frame: MeshFrame) {
  const { faceOrigin } = frame;
  const colours = new Float32Array(9 * faceOrigin.length);
  for (let f = 0; f < faceOrigin.length; f++) {
    const colour = faceOrigin[f] === 0 ? NEW : partColour(faceOrigin[f] - 1);
    for (let c = 0; c < 3; c++) colour.toArray(colours, 9 * f + 3 * c);
  }
  geometry.setAttribute('color', new BufferAttribute(colours, 3));
}

/** Colours each vertex by a number: blue below, white between, red above, over the middle nine tenths of all values. */
export function byField(geometry: BufferGeometry, frame: MeshFrame, values: Float32Array, symmetric: boolean) {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  const at = (share: number) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? 0;
  let [low, high] = [at(0.05), at(0.95)];
  if (symmetric) [low, high] = [-Math.max(-low, high, 1e-30), Math.max(-low, high, 1e-30)];
  const colours = new Float32Array(3 * frame.faces.length);
  const colour = new Color();
  for (let c = 0; c < frame.faces.length; c++) {
    const share = (values[frame.faces[c]] - low) / (high - low || 1);
    ramp(colour, share).toArray(colours, 3 * c);
  }
  geometry.setAttribute('color', new BufferAttribute(colours, 3));
}

const [BLUE, WHITE, RED] = ['#3b6fd4', '#f2f2f2', '#d4503b'].map((c) => new Color(c));

function ramp(colour: Color, share: number): Color {
  const s = Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0.5));
  return s < 0.5 ? colour.lerpColors(BLUE, WHITE, 2 * s) : colour.lerpColors(WHITE, RED, 2 * s - 1);
}

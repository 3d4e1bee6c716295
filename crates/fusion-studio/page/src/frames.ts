// Decodes the server's binary frames: the length of a JSON header, the header, then its arrays back to back.

import type { FieldFrame, MeshFrame, Vector } from './protocol';

interface ArrayEntry {
  name: string;
  type: 'f32' | 'u32';
  length: number;
}

interface Header {
  frame: string;
  shape: string;
  revision: string;
  what?: string;
  origin?: Vector;
  arrays: ArrayEntry[];
}

export type Frame = { mesh: MeshFrame } | { field: FieldFrame };

/** Decodes a frame without copying its arrays. */
export function decode(buffer: ArrayBuffer): Frame {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))) as Header;
  const arrays = new Map<string, Float32Array | Uint32Array>();
  let offset = 4 + length;
  for (const { name, type, length } of header.arrays) {
    const array = type === 'f32' ? new Float32Array(buffer, offset, length) : new Uint32Array(buffer, offset, length);
    arrays.set(name, array);
    offset += array.byteLength;
  }
  const { shape, revision } = header;
  if (header.frame !== 'mesh') {
    const values = arrays.get('values') as Float32Array;
    return { field: { field: header.what ?? header.frame, shape, revision, values } };
  }
  const positions = arrays.get('positions') as Float32Array;
  const faces = arrays.get('faces') as Uint32Array;
  const faceOrigin = (arrays.get('face_origin') ?? new Uint32Array(faces.length / 3)) as Uint32Array;
  return { mesh: { shape, revision, origin: header.origin ?? [0, 0, 0], positions, faces, faceOrigin } };
}

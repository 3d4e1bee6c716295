// Primitives that parts ride on: drawn as glass, where their place is written in the document itself.

import { BoxGeometry, BufferGeometry, CylinderGeometry, DoubleSide, EdgesGeometry, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, Object3D, SphereGeometry, Vector3 } from 'three';
import type { Options } from '../protocol';
import type { Stage } from './stage';

export class Primitives {
  private group = new Object3D();
  private shown = '';

  constructor(private stage: Stage) {
    stage.content.add(this.group);
  }

  /** Draws these primitives instead of those before. */
  show(primitives: { [name: string]: Options }, selected: string | undefined) {
    const key = JSON.stringify([primitives, selected]);
    if (key === this.shown) return;
    this.shown = key;
    for (const child of this.group.children) child.traverse((o) => (o as Mesh).geometry?.dispose());
    this.group.clear();
    for (const [name, options] of Object.entries(primitives)) {
      const body = draw(options, name === selected);
      if (body) this.group.add(body);
    }
    this.stage.draw();
  }
}

/** One that stands on a loop or on another is resolved by the server alone, and not drawn. */
function draw(options: Options, selected: boolean): Object3D | undefined {
  if (options.loop || options.on) return undefined;
  const geometry = solid(options);
  if (!geometry) return undefined;
  const body = new Object3D();
  const colour = selected ? 0xff7a18 : 0x8f7ad1;
  const glass = new MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.13, side: DoubleSide, depthWrite: false });
  const lines = new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.7 });
  body.add(new Mesh(geometry, glass), new LineSegments(new EdgesGeometry(geometry, 12), lines));
  const vector = (key: string, fallback: number[]) => new Vector3(...((options[key] as number[] | undefined) ?? fallback));
  body.position.copy(vector('base', [0, 0, 0]));
  body.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), vector('axis', [0, 0, 1]).normalize());
  return body;
}

/** Rises along z from the origin. */
function solid(options: Options): BufferGeometry | undefined {
  const height = Number(options.height ?? 1);
  const radius = options.radius as number | number[] | undefined;
  const [base, top] = Array.isArray(radius) ? radius : [radius ?? 1, radius ?? 1];
  switch (options.shape) {
    case 'box': {
      const [x, y, z] = (options.size as number[] | undefined) ?? [1, 1, 1];
      return new BoxGeometry(x, y, z).translate(0, 0, z / 2);
    }
    case 'sphere': return new SphereGeometry(base, 32, 16);
    case 'cylinder':
    case 'cone': return new CylinderGeometry(top, base, height, 48, 1).rotateX(Math.PI / 2).translate(0, 0, height / 2);
    default: return undefined;
  }
}

// Handles that move and turn a shape; the pose that comes out goes to the document.

import { Matrix4, Object3D, Quaternion, Vector3 } from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import type { Json, Options } from '../protocol';
import type { Stage } from './stage';

/** Told about a drag: while it goes on and, last, when it ends. */
export type Moved = (pose: { translate?: Json; rotate?: Json; scale?: Json }, ends: boolean) => void;

export class Gizmo {
  readonly controls: TransformControls;
  /** Stands at the centre of the shape and is what the handles move. */
  private handle = new Object3D();
  private start = new Matrix4();
  private pose: Options = {};
  private target: Object3D | undefined;
  private moved: Moved | undefined;
  private touched = false;

  constructor(private stage: Stage) {
    this.controls = new TransformControls(stage.camera, stage.renderer.domElement);
    this.controls.setSize(0.8);
    stage.overlay.add(this.handle);
    stage.scene.add(this.controls.getHelper());
    this.controls.addEventListener('change', () => stage.draw());
    this.controls.addEventListener('dragging-changed', ({ value }) => {
      stage.orbit.enabled = !value;
      if (value) this.begin();
      else if (this.touched) this.tell(true);
    });
    this.controls.addEventListener('objectChange', () => {
      this.touched = true;
      this.tell(false);
    });
  }

  /** Puts the handles on a shape, whose pose is as written in the document. */
  attach(target: Object3D | undefined, centre: Vector3, pose: Options, mode: 'translate' | 'rotate', moved: Moved) {
    if (this.controls.dragging) return;
    this.controls.setMode(mode);
    this.target = target;
    this.pose = pose;
    this.moved = moved;
    this.handle.position.copy(centre);
    this.handle.quaternion.identity();
    this.handle.scale.set(1, 1, 1);
    this.handle.updateMatrixWorld();
    if (target) this.controls.attach(this.handle);
    else this.controls.detach();
    this.stage.draw();
  }

  detach() {
    if (this.controls.dragging) return;
    this.controls.detach();
    this.target = undefined;
    this.stage.draw();
  }

  /** Whether the pointer is on a handle, which then has the mouse. */
  get busy(): boolean {
    return this.controls.dragging || this.controls.axis !== null;
  }

  /** Steps of the handles while a key is held: of a length, and of 15 degrees. */
  snap(length: number | null) {
    this.controls.setTranslationSnap(length);
    this.controls.setRotationSnap(length === null ? null : Math.PI / 12);
  }

  private begin() {
    this.touched = false;
    this.handle.updateMatrixWorld();
    this.start.copy(this.handle.matrixWorld);
  }

  private tell(ends: boolean) {
    this.handle.updateMatrixWorld();
    // What the drag did so far, in the space of the document.
    const change = this.handle.matrixWorld.clone().multiply(this.start.clone().invert());
    this.moved?.(this.controls.mode === 'translate' ? shifted(this.pose, change) : turned(this.pose, change), ends);
  }

  /** Whether the shape in the view follows the handles until the server sends it moved. */
  get follows(): Object3D | undefined {
    return this.target;
  }
}

const vector = (value: Json | undefined): Vector3 => new Vector3(...((value as number[] | null | undefined) ?? [0, 0, 0]));

function shifted(pose: Options, change: Matrix4) {
  const by = new Vector3().setFromMatrixPosition(change);
  return { translate: tidy(vector(pose.translate).add(by).toArray()) };
}

/** A turn about the handles: the document turns about the origin, so that its shift changes as well. */
function turned(pose: Options, change: Matrix4) {
  const by = new Quaternion().setFromRotationMatrix(change);
  const old = pose.rotate as { axis: number[]; angle: number } | null | undefined;
  const before = new Quaternion();
  if (old) before.setFromAxisAngle(new Vector3(...old.axis).normalize(), (old.angle * Math.PI) / 180);
  const all = by.multiply(before);
  if (all.w < 0) all.set(-all.x, -all.y, -all.z, -all.w);
  const angle = (2 * Math.acos(Math.min(1, all.w)) * 180) / Math.PI;
  const axis = new Vector3(all.x, all.y, all.z);
  const translate = tidy(vector(pose.translate).applyMatrix4(change).toArray());
  if (axis.length() < 1e-9) return { rotate: null, translate };
  return { rotate: { axis: tidy(axis.normalize().toArray()), angle: tidy([angle])[0] }, translate };
}

/** Numbers that people can read in a document: six digits are finer than a hand on a mouse. */
function tidy(values: number[]): number[] {
  const size = Math.max(...values.map(Math.abs), 1e-12);
  const digit = 10 ** (Math.floor(Math.log10(size)) - 6);
  return values.map((value) => Number((Math.round(value / digit) * digit).toPrecision(10)));
}

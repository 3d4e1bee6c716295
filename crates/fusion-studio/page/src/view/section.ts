// The section plane: hides what lies before it, is moved by a slider, and can become a cut.

import { DoubleSide, Mesh, MeshBasicMaterial, Plane, PlaneGeometry, Vector3 } from 'three';
import { button, fill, h } from '../dom';
import type { Vector } from '../protocol';
import type { Store } from '../store';
import type { Stage } from './stage';

type Axis = 'x' | 'y' | 'z' | 'view';

export class Section {
  private normal = new Vector3(1, 0, 0);
  private share = 0.5;
  private axis: Axis = 'x';
  private sheet = new Mesh(
    new PlaneGeometry(2, 2),
    new MeshBasicMaterial({ color: 0x4c9be8, transparent: true, opacity: 0.12, side: DoubleSide, depthWrite: false }),
  );

  constructor(private stage: Stage, private bar: HTMLElement, private store: Store, private cut: () => void, private path: () => void) {
    this.sheet.visible = false;
    stage.overlay.add(this.sheet);
    store.on(['look'], () => this.draw());
    store.on(['selection'], () => this.drawBar());
    this.draw();
  }

  /** A point of the plane and its normal, which points to what is hidden. */
  get plane(): { point: Vector; normal: Vector } | undefined {
    if (!this.store.look.section) return undefined;
    const sphere = this.stage.bounds();
    const point = sphere.center.clone().addScaledVector(this.normal, (2 * this.share - 1) * sphere.radius);
    const tidy = (v: Vector3): Vector => v.toArray().map((n) => Number(n.toPrecision(6))) as Vector;
    return { point: tidy(point), normal: tidy(this.normal) };
  }

  private draw() {
    this.drawBar();
    this.place();
  }

  private drawBar() {
    this.bar.hidden = !this.store.look.section;
    if (this.bar.hidden) return fill(this.bar);
    const slider = h('input', { type: 'range', min: '0', max: '1', step: '0.002', value: String(this.share), 'aria-label': 'Place of the section plane', title: 'Place of the section plane' });
    slider.addEventListener('input', () => {
      this.share = Number(slider.value);
      this.place();
    });
    const axes = (['x', 'y', 'z', 'view'] as Axis[]).map((axis) => {
      const element = h('button', { title: axis === 'view' ? 'Across the line of sight' : `Across the ${axis} axis`, onclick: () => this.along(axis) }, axis);
      element.setAttribute('aria-pressed', String(this.axis === axis));
      return element;
    });
    const cut = button('cut', 'Cut here', 'Cut the selected shape off at this plane; what is hidden goes', this.cut);
    cut.disabled = this.store.shapes.length !== 1;
    if (cut.disabled) cut.title += '. Select one shape first.';
    const path = button('target', 'Click a path', 'Cut along a path over the surface instead: click places round a limb', this.path);
    path.disabled = cut.disabled;
    fill(this.bar, h('span', { className: 'name' }, 'Section'), ...axes, slider, button('flip', '', 'The other side', () => {
      this.normal.negate();
      this.share = 1 - this.share;
      this.draw();
    }), cut, path, button('close', '', 'Without the section plane (C)', () => {
      this.store.look.section = false;
      this.store.changed('look');
    }));
  }

  private along(axis: Axis) {
    this.axis = axis;
    if (axis === 'view') this.stage.camera.getWorldDirection(this.normal).negate();
    else this.normal.set(axis === 'x' ? 1 : 0, axis === 'y' ? 1 : 0, axis === 'z' ? 1 : 0);
    this.draw();
  }

  private place() {
    const { plane } = this;
    this.sheet.visible = plane !== undefined;
    if (!plane) return this.stage.section([]);
    const point = new Vector3(...plane.point);
    const normal = new Vector3(...plane.normal);
    // A little behind the plane, which would cut it away.
    this.sheet.position.copy(point).addScaledVector(normal, -2e-3 * this.stage.bounds().radius);
    this.sheet.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), normal.clone().normalize());
    this.sheet.scale.setScalar(this.stage.bounds().radius * 1.05);
    this.stage.section([new Plane().setFromNormalAndCoplanarPoint(normal.clone().negate(), point)]);
  }
}

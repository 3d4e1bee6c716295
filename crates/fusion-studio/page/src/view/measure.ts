// Measures between two places: a line in the view with the server's numbers on it.

import { BufferGeometry, Line, LineBasicMaterial, Object3D, Vector3 } from 'three';
import type { Actions } from '../actions';
import { fill, h, number } from '../dom';
import type { Hit } from './shapes';
import type { Stage } from './stage';

interface Measured {
  distance?: number;
  angle?: number;
}

export class Measure {
  private first: Hit | undefined;
  private ends: Vector3[] = [];
  private line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xff4d6d, depthTest: false }));
  private group = new Object3D();
  private label = h('div', { className: 'measure-label', hidden: true });

  constructor(private stage: Stage, private actions: Actions, host: HTMLElement) {
    this.line.renderOrder = 10;
    this.line.frustumCulled = false;
    this.group.add(this.line);
    this.group.visible = false;
    stage.overlay.add(this.group);
    host.append(this.label);
    stage.beforeDrawing(() => this.place());
  }

  /** The first click, or the second, which is measured. */
  async click(hit: Hit) {
    if (!this.first) {
      this.clear();
      this.first = hit;
      this.show([hit.point, hit.point], 'Click the second place.');
      return;
    }
    const a = this.first;
    this.first = undefined;
    const request = { shape_a: a.shape, shape_b: hit.shape, face_a: a.face, bary_a: a.bary, face_b: hit.face, bary_b: hit.bary };
    const measured = await this.actions.ask<Measured>('measure', request);
    if (!measured) return this.clear();
    const angle = measured.angle === undefined || measured.angle === null ? '' : ` · ${number(measured.angle, 4)}° between the faces`;
    const text = `${number(measured.distance ?? a.point.distanceTo(hit.point), 6)}${angle}`;
    this.show([a.point, hit.point], text);
    this.actions.store.say(`Measured: ${text}.`);
  }

  /** The line follows the pointer until the second click. */
  move(point: Vector3 | undefined) {
    if (this.first && point) this.show([this.first.point, point], this.label.textContent ?? '');
  }

  clear() {
    this.first = undefined;
    this.group.visible = false;
    this.label.hidden = true;
    this.stage.draw();
  }

  private show(ends: Vector3[], text: string) {
    this.ends = ends;
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setFromPoints(ends);
    this.group.visible = true;
    this.label.hidden = false;
    fill(this.label, text);
    this.stage.draw();
  }

  private place() {
    if (this.label.hidden) return;
    const middle = this.ends[0].clone().lerp(this.ends[1], 0.5).project(this.stage.camera);
    const { clientWidth: width, clientHeight: height } = this.stage.host;
    this.label.style.transform = `translate(${((middle.x + 1) / 2) * width}px, ${((1 - middle.y) / 2) * height}px)`;
  }
}

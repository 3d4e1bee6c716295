// Short texts at places of the model, such as the numbers of boundary loops.

import { Vector3 } from 'three';
import { h } from '../dom';
import type { Stage } from './stage';

export class Labels {
  private labels: { element: HTMLElement; place: Vector3 }[] = [];

  constructor(private stage: Stage, private host: HTMLElement) {
    stage.beforeDrawing(() => this.place());
  }

  /** Shows these texts instead of those before; a click on one calls back. */
  show(texts: { text: string; place: Vector3; on: boolean; click: (more: boolean) => void }[]) {
    for (const { element } of this.labels) element.remove();
    this.labels = texts.map(({ text, place, on, click }) => {
      const element = h('button', { className: on ? 'label on' : 'label', title: 'Click to choose this loop; Shift-click for more', onclick: (e: MouseEvent) => click(e.shiftKey) }, text);
      this.host.append(element);
      return { element, place };
    });
    this.stage.draw();
  }

  private place() {
    const { clientWidth: width, clientHeight: height } = this.stage.host;
    for (const { element, place } of this.labels) {
      const at = place.clone().project(this.stage.camera);
      element.style.transform = `translate(-50%, -50%) translate(${((at.x + 1) / 2) * width}px, ${((1 - at.y) / 2) * height}px)`;
      element.hidden = at.z > 1;
    }
  }
}

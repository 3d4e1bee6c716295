// Marks a place in the view for a while, so that the eye finds it after a flight; and the points of a path.

import { BufferGeometry, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, Object3D, SphereGeometry, Vector3 } from 'three';
import type { Stage } from './stage';

export class Marker {
  private group = new Object3D();
  private dots: Mesh[] = [];
  private line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xff4d6d, depthTest: false, transparent: true }));

  constructor(private stage: Stage) {
    this.line.renderOrder = 11;
    this.line.frustumCulled = false;
    this.group.add(this.line);
    stage.overlay.add(this.group);
    // Dots keep their size on the screen.
    stage.beforeDrawing(() => {
      for (const dot of this.dots) dot.scale.setScalar(5 * stage.pixel(dot.position));
    });
  }

  /** Marks these places, with a line between them if there are several. */
  show(places: Vector3[], closed = false) {
    for (const dot of this.dots) this.group.remove(dot);
    this.dots = places.map((place) => {
      const dot = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({ color: 0xff4d6d, depthTest: false, transparent: true }));
      dot.position.copy(place);
      dot.renderOrder = 12;
      this.group.add(dot);
      return dot;
    });
    this.line.geometry.dispose();
    const ends = closed && places.length > 2 ? [...places, places[0]] : places;
    this.line.geometry = new BufferGeometry().setFromPoints(ends.length > 1 ? ends : []);
    this.stage.draw();
  }

  clear() {
    this.show([]);
  }
}

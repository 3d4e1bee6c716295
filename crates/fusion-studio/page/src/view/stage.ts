// The canvas, its camera and lights. Draws only when something asked for it.

import {
  AmbientLight, Box3, Color, DirectionalLight, Frustum, GridHelper, HemisphereLight, Object3D, PerspectiveCamera, Plane, Scene,
  Sphere, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Occlusion } from './occlusion';

export type Preset = 'front' | 'back' | 'left' | 'right' | 'top' | 'bottom' | 'corner';

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(40, 1, 0.01, 1000);
  readonly renderer: WebGLRenderer;
  readonly orbit: OrbitControls;
  /** What is fitted into the view and has shadows of the section plane. */
  readonly content = new Object3D();
  readonly overlay = new Object3D();
  /** How often the view was drawn; for tests. */
  drawn = 0;
  private grid: GridHelper | undefined;
  /** Whether hollows are darkened. */
  occluded = false;
  private occlusion: Occlusion | undefined;
  private asked = false;
  private before: (() => void)[] = [];
  private flight = 0;
  /** Whether the camera is on its way to somewhere. */
  flying = false;
  private up: 'y' | 'z' = 'z';

  constructor(readonly host: HTMLElement) {
    // Tests run without a graphics card, where antialiasing takes most of the time.
    const antialias = !new URLSearchParams(location.search).has('plain');
    this.renderer = new WebGLRenderer({ antialias, preserveDrawingBuffer: false });
    this.renderer.setPixelRatio(antialias ? Math.min(devicePixelRatio, 2) : 1);
    host.append(this.renderer.domElement);
    this.orbit = new OrbitControls(this.camera, this.renderer.domElement);
    this.orbit.zoomToCursor = true;
    this.orbit.addEventListener('change', () => this.draw());
    const key = new DirectionalLight(0xffffff, 2.1);
    key.position.set(-0.6, 0.9, 1.2);
    this.camera.add(key);
    const rim = new DirectionalLight(0xcfe0ff, 0.6);
    rim.position.set(1, -0.4, 0.3);
    this.camera.add(rim);
    this.scene.add(this.camera, this.content, this.overlay, new AmbientLight(0xffffff, 0.45));
    this.scene.add(new HemisphereLight(0xffffff, 0x8a8378, 0.7));
    this.setUp('z');
    new ResizeObserver(() => this.resize()).observe(host);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.recolour());
    this.recolour();
  }

  /** Asks for the next frame. */
  draw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.render());
  }

  /** Called before each frame. */
  beforeDrawing(action: () => void) {
    this.before.push(action);
  }

  /** Draws at once; the canvas can be read in the same tick. */
  render() {
    this.asked = false;
    for (const action of this.before) action();
    if (this.occluded) {
      this.occlusion ??= new Occlusion(this.renderer, this.scene, this.camera);
      this.occlusion.render(this.host.clientWidth, this.host.clientHeight, this.renderer.getPixelRatio(), this.bounds().radius);
    } else this.renderer.render(this.scene, this.camera);
    this.drawn++;
  }

  /** Takes the background from the style sheet. */
  recolour() {
    const style = getComputedStyle(document.documentElement);
    this.scene.background = new Color(style.getPropertyValue('--view').trim() || '#20242b');
    this.setGrid(this.grid?.visible ?? true);
  }

  setUp(axis: 'y' | 'z') {
    this.up = axis;
    this.camera.up.set(0, axis === 'y' ? 1 : 0, axis === 'z' ? 1 : 0);
    // The controls take the axis when they are made; this is how they keep it.
    const controls = this.orbit as unknown as { _quat: { setFromUnitVectors(a: Vector3, b: Vector3): void; clone(): { invert(): unknown } }; _quatInverse: unknown };
    controls._quat.setFromUnitVectors(this.camera.up, new Vector3(0, 1, 0));
    controls._quatInverse = controls._quat.clone().invert();
    this.look('corner');
  }

  setGrid(visible: boolean) {
    if (this.grid) this.scene.remove(this.grid);
    const style = getComputedStyle(document.documentElement);
    const colour = new Color(style.getPropertyValue('--grid').trim() || '#3a414c');
    const sphere = this.bounds();
    // Squares of a round size, about twenty across what there is.
    const step = roundLength(Math.max(sphere.radius, 1e-9) * 0.3);
    const squares = 2 * Math.ceil((2.2 * sphere.radius) / step);
    const grid = new GridHelper(squares * step, squares, colour, colour);
    if (this.up === 'z') grid.rotation.x = Math.PI / 2;
    // Under what there is, so that no line of it runs through a shape.
    const floor = this.floor();
    grid.position.set(round(sphere.center.x, step), this.up === 'y' ? floor : round(sphere.center.y, step), this.up === 'z' ? floor : round(sphere.center.z, step));
    grid.visible = visible;
    this.grid = grid;
    this.scene.add(grid);
    this.draw();
  }

  private floor(): number {
    const box = new Box3().setFromObject(this.content);
    return box.isEmpty() ? 0 : box.min[this.up];
  }

  /** Whether a sphere lies in the view as a whole. */
  sees(sphere: Sphere): boolean {
    this.camera.updateMatrixWorld();
    const matrix = this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse);
    const frustum = new Frustum().setFromProjectionMatrix(matrix);
    return frustum.planes.every((plane) => plane.distanceToPoint(sphere.center) >= sphere.radius * 0.8);
  }

  /** The sphere around everything that is shown. */
  bounds(): Sphere {
    const box = new Box3().setFromObject(this.content);
    return box.isEmpty() ? new Sphere(new Vector3(), 2) : box.getBoundingSphere(new Sphere());
  }

  /** Looks from a side at everything. */
  look(from: Preset) {
    const directions: { [key in Preset]: [number, number, number] } = {
      front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0], top: [0, -0.001, 1], bottom: [0, -0.001, -1],
      corner: [0.55, -1, 0.55],
    };
    const [x, y, z] = directions[from];
    const direction = this.up === 'z' ? new Vector3(x, y, z) : new Vector3(x, z, -y);
    this.frame(this.bounds(), direction.normalize());
  }

  /** Moves the camera so that a sphere fills the view, from where it looks now or along a direction. */
  frame(sphere: Sphere, direction = this.camera.position.clone().sub(this.orbit.target).normalize()) {
    const half = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect));
    const distance = (1.22 * Math.max(sphere.radius, 1e-9)) / Math.sin(narrow);
    const to = sphere.center.clone().addScaledVector(direction, distance);
    this.fly(to, sphere.center);
  }

  /** Shows a place from nearby. */
  flyTo(place: Vector3, radius: number) {
    this.frame(new Sphere(place, radius));
  }

  private fly(position: Vector3, target: Vector3) {
    cancelAnimationFrame(this.flight);
    const [fromPosition, fromTarget] = [this.camera.position.clone(), this.orbit.target.clone()];
    const start = performance.now();
    const quick = matchMedia('(prefers-reduced-motion: reduce)').matches || this.drawn === 0;
    const step = () => {
      const t = quick ? 1 : Math.min(1, (performance.now() - start) / 250);
      const s = t * t * (3 - 2 * t);
      this.camera.position.lerpVectors(fromPosition, position, s);
      this.orbit.target.lerpVectors(fromTarget, target, s);
      this.clip();
      this.orbit.update();
      this.draw();
      this.flying = t < 1;
      if (this.flying) this.flight = requestAnimationFrame(step);
    };
    step();
  }

  /** Shows in parallel projection, to all intents: from so far away that the lines of sight hardly spread. */
  setParallel(on: boolean) {
    const fov = on ? 1.5 : 40;
    if (this.camera.fov === fov) return;
    const spread = (angle: number) => Math.tan((angle * Math.PI) / 360);
    const { target } = this.orbit;
    const away = this.camera.position.clone().sub(target).multiplyScalar(spread(this.camera.fov) / spread(fov));
    this.camera.fov = fov;
    this.camera.position.copy(target).add(away);
    this.clip();
    this.orbit.update();
    this.draw();
  }

  /** The length that a pixel covers at a place. */
  pixel(at: Vector3): number {
    const height = 2 * Math.tan((this.camera.fov * Math.PI) / 360) * at.distanceTo(this.camera.position);
    return height / Math.max(1, this.host.clientHeight);
  }

  /** Near and far planes around what there is. */
  clip() {
    const sphere = this.bounds();
    const distance = this.camera.position.distanceTo(sphere.center);
    this.camera.far = distance + 20 * sphere.radius;
    this.camera.near = Math.max(this.camera.far * 1e-5, (distance - 2 * sphere.radius) * 0.5, sphere.radius * 1e-3);
    this.camera.updateProjectionMatrix();
  }

  /** Hides what lies before a plane. */
  section(planes: Plane[]) {
    this.renderer.clippingPlanes = planes;
    this.draw();
  }

  private resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height);
    this.render();
  }
}

/** The largest of 1, 2 and 5 times a power of ten that is not above a length. */
function roundLength(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * (length >= 5 * power ? 5 : length >= 2 * power ? 2 : 1);
}

function round(value: number, step: number): number {
  return Math.round(value / step) * step;
}

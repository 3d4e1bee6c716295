// The view as a whole: keeps what is drawn in step with what the page knows.

import { Matrix4, Sphere, Vector3 } from 'three';
import type { Actions } from '../actions';
import { Pacer } from '../actions';
import type { Curve, Options, Vector } from '../protocol';
import type { Radius } from '../radius';
import type { Seams } from '../seams';
import type { Row, Store } from '../store';
import { Ball, type Stand } from './ball';
import { Brush } from './brush';
import { CurveLines } from './curves';
import { Gizmo } from './gizmo';
import { Marker } from './marker';
import { Measure } from './measure';
import { Pointer } from './pointer';
import { shapeColour, Shapes, type Hit, type Manner } from './shapes';
import { Handles } from './handles';
import { Labels } from './labels';
import { Primitives } from './primitives';
import { Rider } from './rider';
import { sides } from './sides';
import { Stage } from './stage';
import { Stroke } from './stroke';

/** Keys of a part that set it somewhere by other means than handles. */
const PLACED = ['on', 'snap', 'drop'];

export class View {
  readonly stage: Stage;
  readonly shapes: Shapes;
  readonly lines: CurveLines;
  readonly ball: Ball;
  readonly gizmo: Gizmo;
  readonly measure: Measure;
  readonly marker: Marker;
  readonly stroke: Stroke;
  readonly brush: Brush;
  readonly handles: Handles;
  private labels: Labels;
  private primitives: Primitives;
  /** Takes the places that are clicked while the tool is `point`. */
  onPoint: ((hit: Hit) => void) | undefined;
  private moves: Pacer<{ row: Row; pose: Options; drag: number }>;
  private drag: number | undefined;
  /** Where the ball touches a picked curve, and the sides there. */
  private stands = new WeakMap<Curve, Stand>();
  private shownGhosts = '';
  private fields = '';

  constructor(host: HTMLElement, private store: Store, private actions: Actions, private radius: Radius, private seams: Seams) {
    this.stage = new Stage(host);
    this.shapes = new Shapes(this.stage);
    this.lines = new CurveLines(this.stage);
    this.ball = new Ball(this.stage);
    this.gizmo = new Gizmo(this.stage);
    this.measure = new Measure(this.stage, actions, host);
    this.marker = new Marker(this.stage);
    this.primitives = new Primitives(this.stage);
    this.handles = new Handles(this.stage, store, actions);
    this.brush = new Brush(this.stage, this.shapes);
    this.stroke = new Stroke(this.stage);
    this.labels = new Labels(this.stage, host);
    this.moves = new Pacer(({ row, pose, drag }) => void this.sendPose(row, pose, drag), store);
    radius.diagonal = store.drawnSize = () => 2 * this.stage.bounds().radius;
    radius.onDrag = (value) => this.ball.resize(value);
    new Pointer(this.stage, this.shapes, this.lines, this.ball, this.handles, new Rider(this.stage, store, actions), this.gizmo, radius, store, {
      shape: (hit, more) => this.clicked(hit, more),
      curve: (curve, more, place) => {
        this.stand(curve, place);
        seams.pick(curve, more);
      },
      measure: (hit) => void this.measure.click(hit),
      point: (hit) => this.onPoint?.(hit),
      hover: (hit) => this.measure.move(store.tool === 'measure' ? hit?.point : undefined),
    });
    store.on(['evaluated', 'failure'], () => this.moves.done());
    store.on(['evaluated'], () => this.shapes.prune(store.evaluated?.shapes.map((s) => s.name) ?? []));
    store.on(['document', 'evaluated', 'mesh', 'selection', 'failure', 'work', 'look'], () => this.draw());
    store.on(['selection', 'document'], () => void this.askGhosts());
    store.on(['selection', 'mesh', 'tool', 'document'], () => this.drawGizmo());
    store.on(['curves', 'look'], () => this.drawCurves());
    store.on(['document'], () => this.drawBall());
    store.on(['document', 'selection'], () => this.primitives.show(store.document.primitives, store.primitive(store.focus)));
    store.on(['look', 'evaluated'], () => this.drawLook());
    store.on(['tool'], () => store.tool !== 'measure' && this.measure.clear());
    addEventListener('theme', () => this.stage.recolour());
  }

  /** Shows what is selected, or everything. */
  focus() {
    const sphere = this.sphereOf(this.store.selection.map((row) => this.store.viewOf(row) ?? ''));
    this.stage.frame(sphere ?? this.stage.bounds());
  }

  fit() {
    this.stage.setGrid(this.store.look.grid);
    this.stage.frame(this.stage.bounds());
  }

  /** A shape that has come into the view is shown as a whole. */
  welcome(shape: string) {
    if (this.shapes.names.length === 1) return this.fit();
    const sphere = this.sphereOf([shape]);
    this.stage.setGrid(this.store.look.grid);
    if (sphere && (this.stage.flying || !this.stage.sees(sphere))) this.fit();
  }

  /** Shows a place of the model and marks it. */
  flyTo = (place: Vector) => {
    const at = new Vector3(...place);
    this.marker.show([at]);
    this.stage.flyTo(at, this.stage.bounds().radius * 0.18);
  };

  private clicked(hit: Hit | undefined, more: boolean) {
    this.marker.clear();
    const row = hit && this.store.rowOf(hit.shape);
    if (!row) {
      if (!more) this.store.select([]);
      return;
    }
    if (!more) return this.store.select([row]);
    const rest = this.store.selection.filter((s) => s.table !== row.table || s.index !== row.index);
    this.store.select(rest.length < this.store.selection.length ? rest : [...this.store.selection, row]);
  }

  private draw() {
    const { store } = this;
    const manners = new Map<string, Manner>();
    const failed = store.failure !== undefined && (store.failure as { event?: string }).event === 'failed';
    const selected = store.selection.map((row) => store.viewOf(row));
    const shown = new Set(store.evaluated?.shapes.map((s) => s.name));
    const results = store.results;
    for (const name of this.shapes.names) {
      if (!shown.has(name)) continue;
      const row = store.rowOf(name);
      const part = row?.table === 'part' ? row.index : undefined;
      const ghost = !results.includes(name);
      manners.set(name, { selected: selected.includes(name), ghost, dimmed: failed || (store.work !== undefined && this.late()), colour: shapeColour(part) });
    }
    this.shapes.draw(manners, store.look);
  }

  /** Whether an evaluation takes so long that what is seen must be marked as old. */
  private late(): boolean {
    return this.store.workSince !== undefined && performance.now() - this.store.workSince > 600;
  }

  /** Selected parts that a step has taken up are shown as ghosts, so that they can be moved. */
  private async askGhosts() {
    const { store } = this;
    const names = store.selection.map((row) => store.viewOf(row)).filter((n): n is string => n !== undefined && /^(part|step):/.test(n));
    const key = names.join('\n');
    if (key === this.shownGhosts) return;
    this.shownGhosts = key;
    await this.actions.quietly('show', { names });
  }

  private drawGizmo() {
    const { store, gizmo } = this;
    const row = store.focus;
    const part = store.part(row);
    const turning = store.tool === 'rotate';
    const free = part && PLACED.every((key) => part.pose[key] === undefined);
    if (!row || !part || !free || !(turning || store.tool === 'move')) return gizmo.detach();
    const object = this.shapes.object(store.viewOf(row) ?? part.name);
    const sphere = this.sphereOf([store.viewOf(row) ?? part.name]);
    if (!object || !sphere) return gizmo.detach();
    const start = object.matrix.clone();
    const { pose } = part;
    const shape = store.viewOf(row) ?? part.name;
    gizmo.attach(object, sphere.center, pose, turning ? 'rotate' : 'translate', (next, ends) => {
      this.drag ??= this.actions.newDrag();
      this.preview(shape, start, pose, next as Options);
      this.moves.push({ row, pose: next as Options, drag: this.drag });
      if (ends) this.drag = undefined;
    });
  }

  /** The shape follows the handles at once; the server's mesh replaces it. */
  private preview(shape: string, start: Matrix4, before: Options, after: Options) {
    const object = this.shapes.object(shape);
    if (!object || after.rotate !== undefined) return;
    const [a, b] = [before.translate, after.translate].map((t) => new Vector3(...((t as number[] | null) ?? [0, 0, 0])));
    object.position.setFromMatrixPosition(start).add(b).sub(a);
    this.stage.draw();
  }

  private async sendPose(row: Row, pose: Options, drag: number) {
    await this.actions.setAll(row, pose, drag);
  }

  private drawCurves() {
    const set = this.store.curves;
    this.lines.show(set, this.store.look.edges);
    const loops = set?.kind === 'loops' && this.store.look.edges ? set.curves : [];
    this.labels.show(loops.map((loop) => ({
      text: String(loop.id), place: new Vector3(...loop.at!), on: set!.picked.includes(loop), click: (more) => this.seams.pick(loop, more),
    })));
    this.drawBall();
  }

  /** The ball stands where a curve was clicked, with the sides that it had when its crease could be seen. */
  private stand(curve: Curve, place: Vector3) {
    const { curves, evaluated } = this.store;
    const sharp = curves && evaluated?.shapes.find((s) => s.name === curves.shape)?.revision === curves.revision;
    const normals = sharp ? sides(this.shapes, curves.shape, place) : undefined;
    if (normals) this.stands.set(curve, { place, normals });
    else if (!this.stands.has(curve) && curve.normals && curve.near) {
      this.stands.set(curve, { place: new Vector3(...curve.near), normals: curve.normals });
    }
  }

  private drawBall() {
    const set = this.store.curves;
    const curve = set && set.kind === 'features' ? set.picked.at(-1) : undefined;
    // A ball to begin with, where there is no fillet yet.
    const radius = this.radius.value ?? (curve ? Math.min(this.store.largest?.radius ?? Infinity, this.radius.diagonal() * 0.03) : 0);
    this.ball.show(curve && this.stands.get(curve), curve?.convex === true, radius);
  }

  private async drawLook() {
    const { look, evaluated } = this.store;
    this.stage.occluded = look.occlusion;
    this.stage.setParallel(look.parallel);
    this.stage.setGrid(look.grid);
    if (look.colour !== 'curvature' && look.colour !== 'quality') {
      this.shapes.fields.clear();
      this.fields = '';
      return this.draw();
    }
    const key = JSON.stringify([look.colour, evaluated?.shapes]);
    if (key === this.fields) return;
    this.fields = key;
    for (const shape of this.store.results) await this.actions.quietly(look.colour, { shape });
  }

  private sphereOf(names: string[]): Sphere | undefined {
    let all: Sphere | undefined;
    for (const name of names) {
      const mesh = this.shapes.mesh(name);
      if (!mesh?.geometry.boundingSphere) continue;
      mesh.updateWorldMatrix(true, false);
      const sphere = mesh.geometry.boundingSphere.clone().applyMatrix4(mesh.matrixWorld);
      all = all ? all.union(sphere) : sphere;
    }
    return all;
  }
}

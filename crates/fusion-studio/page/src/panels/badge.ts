// The badge of the shape in focus: closed, oriented, crossings; a click flies to the place.

import type { Actions } from '../actions';
import { button, fill, h, number } from '../dom';
import type { Vector } from '../protocol';
import type { Store } from '../store';

/** What the server tells of a shape. */
interface Info {
  closed: boolean;
  manifold: boolean;
  boundary_loops: { edges: number; length: number; at: Vector }[] | null;
  self_intersections: number | null;
  /** Places of some crossings. */
  crossings: Vector[];
  defects: { kind: string; count: number }[];
  volume: number | null;
  faces: number;
}

export function badge(host: HTMLElement, store: Store, actions: Actions, flyTo: (place: Vector) => void) {
  let asked = '';
  let timer = 0;

  const ask = () => {
    clearTimeout(timer);
    const shape = store.shapes.at(-1) ?? store.evaluated?.shapes.at(-1)?.name;
    const known = store.evaluated?.shapes.find((s) => s.name === shape);
    if (!shape || !known || store.work) {
      if (!shape) fill(host);
      return;
    }
    const key = `${shape} ${known.revision}`;
    if (key === asked) return;
    // Crossings take a while on large shapes: not at every value of a drag.
    timer = window.setTimeout(async () => {
      const info = await actions.quietly<Info>('info', { shape });
      if (!info) return;
      asked = key;
      draw(shape, info);
    }, 350);
  };

  const draw = (shape: string, info: Info) => {
    const loops = info.boundary_loops ?? [];
    const crossings = info.self_intersections;
    const wrong = info.defects.map((d) => `${d.count} × ${d.kind}`).join(', ');
    fill(host,
      h('strong', {}, shape),
      mark(info.closed ? 'closed' : loops.length === 1 ? '1 boundary loop' : `${loops.length} boundary loops`, info.closed ? 'It has no boundary.' : 'It is open.', info.closed, loops[0]?.at),
      mark(info.manifold ? 'oriented' : 'not manifold', info.manifold ? 'All faces agree about the outside.' : `What is wrong: ${wrong}.`, info.manifold, undefined),
      crossings !== null && mark(crossings === 0 ? 'no crossings' : `${crossings} crossings`, crossings === 0 ? 'No face crosses another.' : 'Faces cross each other.', crossings === 0, info.crossings[0]),
      h('small', {}, [`${info.faces.toLocaleString('en')} faces`, info.volume !== null && `volume ${number(info.volume)}`].filter(Boolean).join(' · ')));
  };

  function mark(text: string, title: string, good: boolean, place: Vector | undefined): HTMLElement {
    if (place) return Object.assign(button('target', text, `${title} Click to fly there.`, () => flyTo(place)), { className: good ? 'mark good' : 'mark bad' });
    return h('span', { className: good ? 'mark good' : 'mark bad', title }, text);
  }

  store.on(['evaluated', 'selection', 'document', 'work'], ask);
}

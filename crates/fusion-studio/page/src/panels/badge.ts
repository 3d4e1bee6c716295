// The badge of the shape in focus: closed, oriented, crossings; a click flies to the place.

import type { Actions } from '../actions';
import { button, fill, h } from '../dom';
import type { Vector } from '../protocol';
import type { Store } from '../store';

interface Place {
  at?: Vector;
  place?: Vector;
}

/** What the server knows of a shape; it may say more than this. */
interface Info {
  closed?: boolean;
  oriented?: boolean;
  crossings?: number | Place[] | { count: number; places?: (Vector | Place)[] };
  places?: { [what: string]: Vector[] };
  volume?: number;
  area?: number;
  faces?: number;
  vertices?: number;
  boundary_loops?: number;
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
    const crossings = count(info.crossings);
    const crossing = firstPlace(info.crossings);
    const open = info.closed === false;
    fill(host,
      h('strong', {}, shape),
      mark(open ? 'open' : 'closed', open ? 'It has boundary loops; they are shown in green where curves are shown.' : 'It has no boundary.', !open, first(info, 'boundary')),
      mark(info.oriented === false ? 'not oriented' : 'oriented', info.oriented === false ? 'Neighbouring faces disagree about the outside.' : 'All faces agree about the outside.', info.oriented !== false, first(info, 'orientation')),
      crossings !== undefined && mark(crossings === 0 ? 'no crossings' : `${crossings} crossings`, crossings === 0 ? 'No face crosses another.' : 'Faces cross each other; click to see where.', crossings === 0, crossing),
      h('small', {}, [info.faces && `${info.faces.toLocaleString('en')} faces`, info.volume !== undefined && info.volume !== null && `volume ${Number(info.volume.toPrecision(4))}`].filter(Boolean).join(' · ')));
  };

  function mark(text: string, title: string, good: boolean, place: Vector | undefined): HTMLElement {
    if (place) return Object.assign(button('target', text, `${title} Click to fly there.`, () => flyTo(place)), { className: good ? 'mark good' : 'mark bad' });
    return h('span', { className: good ? 'mark good' : 'mark bad', title }, text);
  }

  store.on(['evaluated', 'selection', 'document', 'work'], ask);
}

function count(crossings: Info['crossings']): number | undefined {
  if (crossings === undefined || crossings === null) return undefined;
  if (typeof crossings === 'number') return crossings;
  return Array.isArray(crossings) ? crossings.length : crossings.count;
}

function firstPlace(crossings: Info['crossings']): Vector | undefined {
  if (typeof crossings !== 'object' || crossings === null) return undefined;
  const first = Array.isArray(crossings) ? crossings[0] : crossings.places?.[0];
  if (Array.isArray(first)) return first as Vector;
  return first?.at ?? first?.place;
}

function first(info: Info, what: string): Vector | undefined {
  return info.places?.[what]?.[0];
}

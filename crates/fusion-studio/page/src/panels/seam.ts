// The card of the picked curves: their radius, with a slider that ends at the largest ball that fits.

import { button, h, number, symbol } from '../dom';
import type { Radius } from '../radius';
import type { Store } from '../store';

export function seamCard(store: Store, radius: Radius, flyTo: (place: [number, number, number]) => void, vary: () => void): HTMLElement | false {
  const set = store.curves;
  if (!set || (set.picked.length === 0 && !radius.step)) return false;
  if (set.kind === 'loops') return false;
  const picked = set.picked.length > 0 ? set.picked : set.curves;
  const length = picked.reduce((sum, c) => sum + c.length, 0);
  const seams = picked.every((c) => c.seam);
  const what = picked.length === 0 ? 'Fillet' : `${picked.length} ${seams ? 'seam' : 'feature curve'}${picked.length > 1 ? 's' : ''}`;
  const largest = store.largest?.radius ?? radius.guess();
  const value = radius.value ?? 0;
  // Small radii are wanted more often than the largest, so they get more of the slider.
  const slider = h('input', { type: 'range', min: '0', max: '1', step: 'any', value: String(Math.min(1, Math.sqrt(value / largest))), 'aria-label': 'Radius' });
  const typed = h('input', { type: 'number', step: 'any', min: '0', value: value ? String(Number(value.toPrecision(4))) : '', placeholder: 'sharp' });
  slider.addEventListener('input', () => {
    slider.dataset.dragging = 'yes';
    const next = Number((Number(slider.value) ** 2 * largest).toPrecision(4));
    typed.value = String(next);
    radius.drag(next);
  });
  slider.addEventListener('change', () => {
    delete slider.dataset.dragging;
    radius.end();
  });
  typed.addEventListener('change', () => void radius.put(typed.value === '' ? null : Number(typed.value)));
  const limit = store.largest;
  return h('section', { className: 'card', id: 'seam' },
    h('header', {}, symbol('blend'), h('div', {}, h('h2', {}, what), h('p', {}, picked.length === 0 ? 'along all curves of the step' : `length ${number(length)}${set.picked.length === 0 ? ', all of them' : ''}`))),
    h('div', { className: 'radius', 'data-key': 'seam-radius' }, h('span', { className: 'name' }, 'Radius'), slider, typed),
    h('p', { className: 'hint' }, limit ? `Largest that fits: ${number(limit.radius)}${limit.limit ? ` – ${limit.limit}` : ''}` : 'Pull the slider, or the ball on the model.',
      limit?.place && button('target', '', 'Fly to where the radius is limited', () => flyTo(limit.place!))),
    h('div', { className: 'buttons' },
      limit && button('blend', `Use ${number(limit.radius, 3)}`, 'Take the largest radius that fits', () => void radius.put(Number(limit.radius.toPrecision(3)))),
      radius.value !== undefined && button('blend', 'Vary', 'Click a place of the curve: it gets a radius of its own, as a ball to pull', vary),
      radius.value !== undefined && button('sharp', 'Sharp', 'Without a fillet', () => void radius.put(null)),
      set.picked.length > 0 && button('close', 'Deselect', 'No curve in particular (Escape)', () => {
        set.picked = [];
        store.changed('curves');
      })));
}

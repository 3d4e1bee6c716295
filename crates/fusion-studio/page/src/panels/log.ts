// The bottom: what was done and said, progress, cancel.

import type { Actions } from '../actions';
import { button, fill, h, symbol } from '../dom';
import type { Store } from '../store';

export function log(host: HTMLElement, store: Store, actions: Actions, flyTo: (place: [number, number, number]) => void) {
  const lines = h('ol', { className: 'lines', tabIndex: 0, 'aria-label': 'Log' });
  const bar = h('progress', { max: 1 });
  const stage = h('span', { className: 'stage' });
  const cancel = button('close', 'Cancel', 'Stop the evaluation under way (Escape)', () => void actions.ask('cancel'));
  const work = h('div', { className: 'work' }, stage, bar, cancel);
  const state = h('span', { className: 'state' });
  host.append(h('header', {}, h('h3', {}, 'Log'), state, work), lines);

  const drawLines = () => {
    fill(lines, ...store.log.map((line) => {
      const icon = line.kind === 'note' ? 'note' : line.kind === 'warning' ? 'warning' : 'error';
      const entry = h('li', { className: line.kind }, symbol(icon), h('span', {}, line.text));
      const place = line.failure?.place;
      if (place) entry.append(button('target', '', 'Fly to the place', () => flyTo(place)));
      return entry;
    }));
    lines.scrollTop = lines.scrollHeight;
  };

  const drawWork = () => {
    work.classList.toggle('on', store.work !== undefined);
    stage.textContent = store.work ? store.work.stage : '';
    if (store.work?.fraction === null || store.work?.fraction === undefined) bar.removeAttribute('value');
    else bar.value = store.work.fraction;
    const last = store.evaluated;
    state.textContent = !store.connected ? 'Not connected; trying again' : store.work ? '' : last ? `evaluated in ${duration(last.milliseconds)}` : '';
    state.classList.toggle('bad', !store.connected);
  };

  store.on(['log'], drawLines);
  store.on(['work', 'evaluated', 'connection'], drawWork);
  drawLines();
  drawWork();
}

function duration(milliseconds: number): string {
  return milliseconds < 1000 ? `${Math.round(milliseconds)} ms` : `${(milliseconds / 1000).toFixed(1)} s`;
}

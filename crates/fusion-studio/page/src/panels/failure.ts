// A card over the view: the sentence of an error, a way to its place and its remedy.

import type { Actions } from '../actions';
import { button, fill, h, symbol } from '../dom';
import type { Store } from '../store';

export function failureCard(host: HTMLElement, store: Store, actions: Actions, flyTo: (place: [number, number, number]) => void) {
  const draw = () => {
    const { failure } = store;
    host.hidden = failure === undefined;
    if (!failure) return fill(host);
    const { place, remedy } = failure;
    fill(host, symbol('error'),
      h('p', {}, failure.sentence),
      h('div', { className: 'buttons' },
        remedy?.edit && primary(button('apply', remedy.label, 'Apply this remedy', () => void actions.remedy(remedy))),
        place && button('target', 'Show the place', 'Fly to where it is', () => flyTo(place)),
        button('close', '', 'Close this message', () => actions.dismiss())));
  };
  store.on(['failure'], draw);
  draw();
}

function primary(element: HTMLButtonElement): HTMLButtonElement {
  element.classList.add('primary');
  return element;
}

// The document as TOML beside the model: what a form changes is seen here, and what is typed here changes the model.

import type { Actions } from '../actions';
import { button, h } from '../dom';
import type { Store } from '../store';

export function text(host: HTMLElement, store: Store, actions: Actions) {
  const area = h('textarea', { spellcheck: false, wrap: 'off', 'aria-label': 'The document as TOML' });
  const apply = button('apply', 'Apply', 'Evaluate what is typed (Ctrl+Enter)', () => void send());
  const revert = button('undo', 'Revert', 'Back to the document as it is', () => show(true));
  const state = h('span', { className: 'hint' });
  host.append(h('div', { className: 'buttons' }, apply, revert, state), area);

  const dirty = () => area.value !== store.document.text;
  const mark = () => {
    apply.disabled = revert.disabled = !dirty();
    state.textContent = dirty() ? 'not applied yet' : (store.document.path ?? 'not saved yet');
  };
  let seen = '';
  const show = (force = false) => {
    // What is being typed is not taken away.
    if (force || area.value === seen) area.value = store.document.text;
    seen = store.document.text;
    mark();
  };
  const send = async () => {
    if (await actions.ask('text', { text: area.value })) actions.dismiss();
  };
  area.addEventListener('input', mark);
  area.addEventListener('keydown', (event) => {
    if (event.key === 'Enter' && (event.ctrlKey || event.metaKey)) void send();
    event.stopPropagation();
  });
  store.on(['document'], () => show());
  show();
}

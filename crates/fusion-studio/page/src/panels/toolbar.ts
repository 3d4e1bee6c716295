// The top: the document, undo and redo, and the verbs, which act on the selected shapes.

import type { Actions } from '../actions';
import { button, fill, h } from '../dom';
import type { Vocabulary } from '../forms/schema';
import { verbIcon } from '../icons';
import type { Store } from '../store';

/** The order in which verbs stand; those that the schema has besides follow. */
const ORDER = ['union', 'difference', 'intersection', 'blend', 'sharpen', 'cut', 'compose', 'remesh', 'repair', 'detail', 'cluster', 'pose'];
/** Verbs that need more than one shape. */
const SEVERAL = ['union', 'difference', 'intersection'];

export interface Dialogs {
  addParts(): void;
  newDocument(): void;
  open(): void;
  save(): void;
  exportShape(): void;
  help(): void;
  verb(verb: string): void;
}

export function toolbar(host: HTMLElement, store: Store, actions: Actions, words: Vocabulary, dialogs: Dialogs) {
  const verbs = [...words.operations.keys()].sort((a, b) => rank(a) - rank(b));
  const undo = button('undo', '', 'Undo (Ctrl+Z)', () => void actions.undo());
  const redo = button('redo', '', 'Redo (Ctrl+Shift+Z)', () => void actions.redo());
  const title = h('span', { className: 'document' });
  const verbButtons = verbs.map((verb) => {
    const element = button(verbIcon(verb), capital(verb), words.operations.get(verb)?.description ?? verb, () => dialogs.verb(verb));
    element.dataset.verb = verb;
    return element;
  });
  host.append(
    h('div', { className: 'group' },
      button('add', 'Add', 'Add mesh files as parts; or drop them on the view', dialogs.addParts),
      button('new', '', 'New document', dialogs.newDocument),
      button('open', 'Open', 'Open a document (Ctrl+O)', dialogs.open),
      button('save', 'Save', 'Save the document (Ctrl+S)', dialogs.save),
      button('export', 'Export', 'Write a shape to a file (Ctrl+E)', dialogs.exportShape)),
    h('div', { className: 'group' }, undo, redo),
    h('div', { className: 'group verbs' }, ...verbButtons),
    h('div', { className: 'group end' }, title,
      button('theme', '', 'Dark or light', theme),
      button('help', '', 'Keys and mouse (?)', dialogs.help)));

  const draw = () => {
    undo.disabled = !store.document.can_undo;
    redo.disabled = !store.document.can_redo;
    const count = store.shapes.length;
    for (const element of verbButtons) {
      const verb = element.dataset.verb ?? '';
      const least = SEVERAL.includes(verb) ? 2 : 1;
      element.disabled = count < least;
      const about = words.operations.get(verb)?.description ?? '';
      element.title = element.disabled ? `${about}\nSelect ${least === 2 ? 'two shapes or more' : 'a shape'} first.` : about;
    }
    const { path } = store.document;
    fill(title, path ?? 'not saved yet');
    document.title = `${path ?? 'Untitled'} – fusion studio`;
  };
  store.on(['document', 'selection'], draw);
  draw();
}

function rank(verb: string): number {
  return ORDER.includes(verb) ? ORDER.indexOf(verb) : ORDER.length;
}

export function capital(word: string): string {
  return word.charAt(0).toUpperCase() + word.slice(1);
}

/** Goes from the look of the system to the other one, and back. */
function theme() {
  const root = document.documentElement;
  const dark = matchMedia('(prefers-color-scheme: dark)').matches;
  const now = root.dataset.theme ?? (dark ? 'dark' : 'light');
  root.dataset.theme = now === 'dark' ? 'light' : 'dark';
  try {
    localStorage.setItem('theme', root.dataset.theme);
  } catch {
    // A browser may forbid it; the choice then lasts as long as the page.
  }
  dispatchEvent(new Event('theme'));
}

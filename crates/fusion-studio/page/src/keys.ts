// The keyboard.

import type { Actions } from './actions';
import { setTool } from './panels/viewbar';
import type { Look, Store } from './store';
import type { Preset } from './view/stage';

export interface KeyActions {
  save(): void;
  open(): void;
  exportShape(): void;
  help(): void;
  fit(): void;
  focus(): void;
  look(from: Preset): void;
  escape(): void;
}

export function keys(store: Store, actions: Actions, act: KeyActions) {
  const toggle = (key: 'wire' | 'edges' | 'section' | 'parallel') => {
    store.look = { ...store.look, [key]: !store.look[key] } as Look;
    store.changed('look');
  };
  const plain: { [key: string]: () => void } = {
    q: () => setTool(store, 'select'), g: () => setTool(store, 'move'), r: () => setTool(store, 'rotate'), m: () => setTool(store, 'measure'),
    e: () => toggle('edges'), w: () => toggle('wire'), c: () => toggle('section'),
    f: act.focus, home: act.fit, '1': () => act.look('front'), '3': () => act.look('right'), '7': () => act.look('top'), '5': () => toggle('parallel'), '?': act.help,
    delete: () => void actions.removeSelected(), backspace: () => void actions.removeSelected(), escape: act.escape,
  };
  const control: { [key: string]: () => void } = {
    z: () => void actions.undo(), y: () => void actions.redo(), s: act.save, o: act.open, e: act.exportShape,
  };
  addEventListener('keydown', (event) => {
    const typing = event.target instanceof HTMLElement && event.target.matches('input:not([type=checkbox]):not([type=range]), textarea, select');
    const key = event.key.toLowerCase();
    if (event.ctrlKey || event.metaKey) {
      // In a text, undo belongs to the text.
      if (typing && (key === 'z' || key === 'y')) return;
      const action = key === 'z' && event.shiftKey ? () => void actions.redo() : control[key];
      if (!action) return;
      event.preventDefault();
      action();
      return;
    }
    if (key === 'escape' && typing) (event.target as HTMLElement).blur();
    if (typing || event.altKey) return;
    const action = plain[key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}

// The right side: what the selected row of the document says, as a form made from the schema.

import type { Actions } from '../actions';
import { button, fill, h, symbol } from '../dom';
import { form, label } from '../forms/form';
import type { Context } from '../forms/controls';
import type { Vocabulary } from '../forms/schema';
import { verbIcon } from '../icons';
import type { Json } from '../protocol';
import { resultOf, type Row, type Store } from '../store';

/** Draws a card above the form, such as that of the picked curves. */
export type Card = () => HTMLElement | false;

export function properties(host: HTMLElement, store: Store, actions: Actions, words: Vocabulary, context: Context, card: Card) {
  let pending = false;
  const draw = () => {
    // A slider that is being dragged must stay what it is.
    if (host.querySelector('[data-dragging]')) return;
    // Nor is what is being typed taken away.
    pending = isTyping(host);
    if (pending) return;
    const kept = focusPath(host);
    const scroll = host.scrollTop;
    const row = store.focus;
    fill(host, card(), row ? body(row) : empty());
    host.scrollTop = scroll;
    restore(host, kept);
  };

  function body(row: Row): HTMLElement | undefined {
    if (store.selection.length > 1) return several();
    if (row.table === 'part') return part(row);
    if (row.table === 'step') return step(row);
    if (row.table === 'primitive') return primitive(row);
    return output(row);
  }

  function several(): HTMLElement {
    const names = store.shapes;
    return h('section', {}, h('h2', {}, `${names.length} shapes selected`),
      h('ol', { className: 'names' }, ...names.map((n) => h('li', {}, n))),
      h('p', { className: 'hint' }, 'Press a verb in the toolbar. The first shape is the one that others are taken from or joined to.'));
  }

  function part(row: Row): HTMLElement | undefined {
    const part = store.part(row);
    if (!part) return undefined;
    const keys = ['translate', 'rotate', 'scale', 'on', 'snap', 'drop'];
    const fields = [...words.pose].sort((a, b) => keys.indexOf(a.key) - keys.indexOf(b.key));
    return h('section', {}, head('part', part.name, `Part, of the file ${part.mesh}`, (name) => void actions.rename(row, name)),
      h('h3', {}, 'Pose'), form(fields, part.pose, (key, value) => void actions.set(row, key, value), context),
      remove());
  }

  function primitive(row: Row): HTMLElement | undefined {
    const name = store.primitive(row);
    const options = name === undefined ? undefined : store.document.primitives[name];
    if (name === undefined || !options) return undefined;
    return h('section', {}, h('header', {}, symbol('primitive'), h('div', {}, h('h2', {}, name), h('p', {}, 'A body for parts to ride on; it is not in the model itself. Give a part a place “on” it.'))),
      form(words.primitive, options, (key, value) => void actions.set(row, key, value), context), remove());
  }

  function step(row: Row): HTMLElement | undefined {
    const step = store.step(row);
    if (!step) return undefined;
    const operation = words.operations.get(step.do);
    const rename = (name: string) => void (name && actions.rename(row, name));
    return h('section', {}, head(step.do, resultOf(step), operation?.description ?? '', rename),
      h('h3', {}, 'Of'), inputs(row, [step.written_of ?? step.of].flat()),
      h('h3', {}, `Options of ${label(step.do)}`),
      form(operation?.fields ?? [], step.options, (key, value) => void actions.set(row, key, value), context),
      remove());
  }

  function inputs(row: Row, of: string[]): HTMLElement {
    const set = (names: string[]) => void actions.set(row, 'of', names.length === 1 ? names[0] : names);
    const chips = of.map((name, i) =>
      h('span', { className: 'chip input' }, name,
        i > 0 && button('left', '', 'Before the one on its left', () => set(of.toSpliced(i - 1, 2, name, of[i - 1]))),
        of.length > 1 && button('close', '', `Without ${name}`, () => set(of.toSpliced(i, 1)))));
    // Only what is made before the step can be taken up by it.
    const before = [...store.document.parts.map((p) => p.name), ...store.document.steps.slice(0, row.index).map(resultOf)];
    const others = [...new Set(before)].filter((name) => !of.includes(name));
    const add = h('select', { title: 'Take up another shape', onchange: () => set([...of, add.value]) }, h('option', { value: '' }, '+ shape'), ...others.map((n) => h('option', {}, n)));
    return h('div', { className: 'chips' }, ...chips, others.length > 0 && add);
  }

  function output(row: Row): HTMLElement | undefined {
    const output = store.document.outputs[row.index];
    if (!output) return undefined;
    const shapes = store.document.shapes;
    const of = h('select', { onchange: () => void actions.set(row, 'of', of.value) }, ...shapes.map((n) => h('option', { selected: n === output.of }, n)));
    return h('section', {}, head('export', output.file, 'A file that the document writes', (name) => void actions.set(row, 'file', name)),
      h('div', { className: 'row' }, h('span', { className: 'name' }, 'shape'), of), remove());
  }

  function head(verb: string, name: string, about: string, rename: (name: string) => void): HTMLElement {
    const input = h('input', { className: 'rename', value: name, title: 'Click to rename', spellcheck: false, onchange: () => rename(input.value.trim()), 'data-key': 'name' });
    return h('header', {}, symbol(verbIcon(verb)), h('div', {}, input, h('p', {}, about)));
  }

  function remove(): HTMLElement {
    const element = button('remove', 'Remove', 'Remove from the document (Delete)', () => void actions.removeSelected());
    element.classList.add('remove');
    return element;
  }

  function empty(): HTMLElement {
    const steps: [string, Json][] = [['1', 'Drop mesh files on the view.'], ['2', 'Select two shapes: click one, Shift-click the other.'], ['3', 'Press Union, then click the seam and pull its radius.']];
    return h('section', { className: 'empty' }, h('h2', {}, 'Nothing selected'), h('ol', {}, ...steps.map(([, t]) => h('li', {}, String(t)))));
  }

  const remember = ({ target }: Event) => {
    if (target instanceof HTMLInputElement) target.dataset.before = target.value;
  };
  host.addEventListener('focusin', remember);
  host.addEventListener('change', remember, { capture: true });
  host.addEventListener('focusout', () => pending && setTimeout(draw));
  store.on(['document', 'selection', 'curves'], draw);
  draw();
}

/** Whether the cursor is in a text that differs from what it was. */
function isTyping(host: HTMLElement): boolean {
  const active = document.activeElement;
  if (!(active instanceof HTMLInputElement) || !host.contains(active) || ['checkbox', 'range'].includes(active.type)) return false;
  return active.dataset.before !== undefined && active.value !== active.dataset.before;
}

/** Where the cursor is in the form, so that a redraw does not lose it. */
function focusPath(host: HTMLElement): { path: string; index: number } | undefined {
  const active = document.activeElement;
  if (!active || !host.contains(active)) return undefined;
  const row = active.closest('[data-key]');
  if (!row) return undefined;
  const path = row.getAttribute('data-key') ?? '';
  const index = [...row.querySelectorAll('input, select, button')].indexOf(active);
  return { path, index };
}

function restore(host: HTMLElement, kept: { path: string; index: number } | undefined) {
  if (!kept) return;
  const row = host.querySelector(`[data-key="${CSS.escape(kept.path)}"]`);
  const element = kept.index < 0 ? row : row?.querySelectorAll('input, select, button')[kept.index];
  (element as HTMLElement | null | undefined)?.focus();
}

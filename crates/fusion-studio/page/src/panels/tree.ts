// The left side: parts, steps in their order, and outputs.

import type { Actions } from '../actions';
import { button, fill, h, symbol } from '../dom';
import type { Row } from '../store';
import { resultOf, type Store } from '../store';
import { shapeColour } from '../view/shapes';
import { verbIcon } from '../icons';

export function tree(host: HTMLElement, store: Store, actions: Actions, dialogs: { addParts(): void; addOutput(): void; focus(): void }) {
  const draw = () => {
    const { parts, steps, outputs, primitives } = store.document;
    const ridden = Object.entries(primitives);
    fill(host,
      heading('Parts', 'add', 'Add mesh files as parts', dialogs.addParts),
      list(parts.map((part, index) => item({ table: 'part', index }, part.name, file(part.mesh), dot(index)))),
      parts.length === 0 && h('p', { className: 'hint' }, 'Drop mesh files on the view, or press +.'),
      heading('Primitives', 'add', 'Add a cylinder, cone, box or sphere for parts to ride on', () => void actions.addPrimitive()),
      list(ridden.map(([name, options], index) => item({ table: 'primitive', index }, name, String(options.shape ?? ''), symbol('primitive')))),
      h('h3', {}, 'Steps'),
      list(steps.map((step, index) => item({ table: 'step', index }, resultOf(step), `${step.do} · ${step.of.join(', ')}`, symbol(verbIcon(step.do)), step.off))),
      steps.length === 0 && parts.length > 0 && h('p', { className: 'hint' }, 'Select shapes, then press a verb above, such as Union.'),
      heading('Outputs', 'add', 'Add a file that the document writes', dialogs.addOutput),
      list(outputs.map((output, index) => item({ table: 'output', index }, output.file, output.of ?? 'what is left', symbol('export')))),
    );
  };

  function item(row: Row, name: string, about: string, mark: Node, off = false): HTMLElement {
    const failed = row.table === 'step' && store.failure && failedStep(store) === row.index;
    const classes = [store.isSelected(row) && 'selected', off && 'off', failed && 'failed'].filter(Boolean).join(' ');
    const entry = h('li', { className: classes, draggable: row.table === 'step', tabIndex: 0, title: `${name}: ${about}`, 'data-row': `${row.table}-${row.index}` },
      mark, h('span', { className: 'title' }, name), h('small', {}, about));
    if (row.table === 'step') {
      const eye = button(off ? 'hidden' : 'shown', '', off ? 'Take this step again' : 'Pass this step over', () => void actions.set(row, 'off', off ? null : true));
      eye.addEventListener('click', (event) => event.stopPropagation());
      entry.append(eye);
    }
    entry.addEventListener('click', (event) => select(row, event));
    entry.addEventListener('dblclick', () => dialogs.focus());
    entry.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') select(row, event);
      if (row.table === 'step' && event.altKey && ['ArrowUp', 'ArrowDown'].includes(event.key)) {
        event.preventDefault();
        void move(row, row.index + (event.key === 'ArrowUp' ? -1 : 1));
      }
    });
    if (row.table === 'step') reorder(entry, row);
    return entry;
  }

  function select(row: Row, event: { shiftKey: boolean; ctrlKey: boolean; metaKey: boolean }) {
    if (!event.shiftKey && !event.ctrlKey && !event.metaKey) return store.select([row]);
    if (store.isSelected(row)) store.select(store.selection.filter((s) => s.table !== row.table || s.index !== row.index));
    else store.select([...store.selection, row]);
  }

  async function move(row: Row, to: number) {
    if (to < 0 || to >= store.document.steps.length || to === row.index) return;
    if (await actions.ask('move', { table: 'step', index: row.index, to })) store.select([{ table: 'step', index: to }]);
  }

  function reorder(entry: HTMLElement, row: Row) {
    entry.addEventListener('dragstart', (event) => event.dataTransfer?.setData('text/step', String(row.index)));
    entry.addEventListener('dragover', (event) => {
      if (event.dataTransfer?.types.includes('text/step')) event.preventDefault();
    });
    entry.addEventListener('drop', (event) => {
      const from = event.dataTransfer?.getData('text/step');
      if (from) void move({ table: 'step', index: Number(from) }, row.index);
    });
  }

  function dot(index: number): HTMLElement {
    return h('i', { className: 'dot', style: `background:#${shapeColour(index).getHexString()}` });
  }

  store.on(['document', 'selection', 'failure'], draw);
  draw();
}

function heading(text: string, icon: string, title: string, action: () => void): HTMLElement {
  return h('h3', {}, text, button(icon, '', title, action));
}

function list(items: HTMLElement[]): HTMLElement {
  return h('ul', {}, ...items);
}

function file(path: string): string {
  return path.split(/[/\\]/).pop() ?? path;
}

function failedStep(store: Store): number | undefined {
  return (store.failure as { step?: number } | undefined)?.step ?? undefined;
}

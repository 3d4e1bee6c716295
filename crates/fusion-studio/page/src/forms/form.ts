// A form of fields: a row for each, with its name, its help and a way back to its default.

import { button, h } from '../dom';
import type { Json, Options } from '../protocol';
import type { Field } from './schema';
import { control, type Context } from './controls';

/** How many fields are shown before the rest is folded away. */
const SHOWN = 4;

/** Makes a form. `change` is told a key and its new value; null stands for the default. */
export function form(fields: Field[], values: Options, change: (key: string, value: Json) => void, context: Context): HTMLElement {
  const isSet = (field: Field) => values[field.key] !== undefined;
  const first = fields.filter((field, i) => i < SHOWN || isSet(field));
  const rest = fields.filter((field) => !first.includes(field));
  const line = (field: Field) => row(field, values[field.key], (value) => change(field.key, value), context);
  const box = h('div', { className: 'form' }, ...first.map(line));
  if (rest.length > 0) {
    const more = h('details', { className: 'more' }, h('summary', {}, `${rest.length} more options`), ...rest.map(line));
    more.open = context.unfolded.has('more');
    more.addEventListener('toggle', () => context.unfolded[more.open ? 'add' : 'delete']('more'));
    box.append(more);
  }
  return box;
}

/** The visible name of a key. */
export function label(key: string): string {
  return key.replaceAll('_', ' ');
}

function row(field: Field, value: Json | undefined, change: (value: Json) => void, context: Context): HTMLElement {
  const set = value !== undefined;
  const help = field.description || label(field.key);
  const reset = set && button('reset', '', `Back to the default: ${shown(field.default)}`, () => change(null));
  if (reset) reset.classList.add('reset');
  const body = control(field, value ?? field.default, change, context);
  const wide = ['list', 'group', 'json', 'variant'].includes(field.kind.is);
  const name = h('span', { className: 'name' }, label(field.key));
  return h('div', { className: `row${set ? ' set' : ''}${wide ? ' wide' : ''}`, title: help, 'data-key': field.key }, name, body, reset);
}

function shown(value: Json): string {
  if (value === null) return 'not given';
  return typeof value === 'string' ? value : JSON.stringify(value);
}

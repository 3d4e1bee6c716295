// The control of one field: a box to tick, a number, a choice, a vector, a list.

import { button, h } from '../dom';
import type { Json, Options, Vector } from '../protocol';
import type { Field } from './schema';

/** What controls need from the page. */
export interface Context {
  /** Lets the person click points on the model; each is given to `take` until that says stop. */
  pickPoints(take: (point: Vector) => 'more' | 'stop', hint: string): void;
  /** Lets the person click vertices. */
  pickVertices(take: (vertices: number[]) => void): void;
  /** Lets the person paint faces. */
  paintFaces(take: (faces: number[]) => void): void;
  /** Lets the person draw a stroke on the view. */
  drawStroke(drawn: (stroke: Vector[], view: Vector) => void): void;
  /** The section plane as a point and a normal, if it is on. */
  sectionPlane(): { point: Vector; normal: Vector } | undefined;
  /** Names that a text may be, such as those of primitives. */
  names(key: string): string[];
  /** What was folded out before the form was drawn again. */
  unfolded: Set<string>;
}

type Change = (value: Json) => void;

/** Makes the control of a field. */
export function control(field: Field, value: Json, change: Change, context: Context): HTMLElement {
  const { kind } = field;
  // A parameter of the document stands for a value of any kind.
  if (typeof value === 'string' && value.startsWith('$')) return text(value, change);
  switch (kind.is) {
    case 'toggle': return toggle(value, change);
    case 'number': return numeric(field, value, change);
    case 'length': return length(field, value, change);
    case 'choice': return choice(field, value, change);
    case 'vector': return vector(kind.size, value, change, context);
    case 'list': return list(field, kind.item, value, change, context);
    case 'group': return group(field, kind.fields, value, change, context);
    case 'text': return suggesting([...kind.suggestions, ...context.names(field.key)], value, change);
    case 'variant': return variant(kind, value, change, context);
    case 'json': return json(value, change);
  }
}

function toggle(value: Json, change: Change): HTMLElement {
  return h('input', { type: 'checkbox', checked: value === true, onchange: (e: Event) => change((e.target as HTMLInputElement).checked) });
}

function numeric(field: Field, value: Json, change: Change): HTMLElement {
  const { least, most, whole } = field.kind as { least: number; most: number; whole: boolean };
  const input = h('input', {
    type: 'number', step: whole ? '1' : 'any', placeholder: 'auto', value: value === null ? '' : String(value),
    min: Number.isFinite(least) ? String(least) : undefined, max: Number.isFinite(most) ? String(most) : undefined,
    onchange: () => change(input.value === '' ? null : Number(input.value)),
  });
  return input;
}

/** `0.2`, `2%` or, for both sides, `0.2, 0.3`. */
function length(field: Field, value: Json, change: Change): HTMLElement {
  const two = field.title.includes('two');
  const input = h('input', {
    type: 'text', spellcheck: false, value: Array.isArray(value) ? value.join(', ') : value === null ? '' : String(value),
    placeholder: field.default === null ? 'none' : String(field.default),
    onchange: () => {
      const read = (word: string): Json => (/^[-+\d.eE]+$/.test(word.trim()) ? Number(word) : word.trim());
      const words = input.value.split(',').filter((w) => w.trim() !== '');
      change(words.length === 0 ? null : words.length === 1 || !two ? read(words[0]) : words.map(read));
    },
  });
  return h('span', { className: 'with-unit' }, input, h('small', {}, 'units or %'));
}

function choice(field: Field, value: Json, change: Change): HTMLElement {
  const { choices } = field.kind as { choices: { value: Json; description: string }[] };
  const select = h('select', { onchange: () => change(select.value === '' ? null : choices[Number(select.value)].value) });
  if (field.default === null) select.append(h('option', { value: '' }, 'auto'));
  choices.forEach((c, i) => select.append(h('option', { value: String(i), title: c.description, selected: c.value === value }, String(c.value))));
  const about = choices.find((c) => c.value === value)?.description;
  return about ? h('span', { className: 'stack' }, select, h('small', {}, about)) : select;
}

function vector(size: number, value: Json, change: Change, context: Context): HTMLElement {
  const values = Array.isArray(value) ? (value as number[]) : [];
  const inputs = Array.from({ length: size }, (_, i) =>
    h('input', { type: 'number', step: 'any', value: values[i] === undefined ? '' : String(rounded(values[i])), placeholder: '–', onchange: read }));
  function read() {
    if (inputs.every((input) => input.value === '')) change(null);
    // What was not typed keeps the digits it has.
    else change(inputs.map((input, i) => (values[i] !== undefined && input.value === String(rounded(values[i])) ? values[i] : Number(input.value))));
  }
  const pick = size === 3 && button('target', '', 'Click a point on the model', () => context.pickPoints((point) => (change(point), 'stop'), 'Click a point on the model.'));
  return h('span', { className: 'vector' }, ...inputs, pick);
}

function rounded(value: number): number {
  return Number(value.toPrecision(4));
}

function list(field: Field, item: Field, value: Json, change: Change, context: Context): HTMLElement {
  const values = Array.isArray(value) ? value : [];
  const simple = item.kind.is === 'number' || item.kind.is === 'text';
  if (simple) return picked(field, words(item, values, change), change, context);
  const replaced = (i: number, v: Json) => change(v === null ? without(values, i) : values.map((old, k) => (k === i ? v : old)));
  const rows = values.map((v, i) =>
    h('div', { className: 'item' }, control(item, v, (next) => replaced(i, next), context), button('close', '', 'Remove', () => change(without(values, i)))));
  // Strokes have many points; they are folded away.
  const many = rows.length > 6;
  const box = h('div', { className: 'list' }, ...(many ? [h('details', { className: 'many' }, h('summary', {}, `${rows.length} entries`), ...rows)] : rows));
  const add = (v: Json) => change([...values, v]);
  if (item.kind.is === 'vector' && item.kind.size === 3) {
    let all = [...values];
    const take = (point: Vector) => {
      all = [...all, point];
      change(all);
      return 'more' as const;
    };
    box.append(button('target', 'Click points', 'Click points on the model, one after the other; Escape ends', () => context.pickPoints(take, `Click points for ${field.key}; Escape ends.`)));
  } else if (item.kind.is === 'group') {
    const { fields } = item.kind;
    const point = fields.find((f) => f.required && f.kind.is === 'vector' && f.kind.size === 3);
    if (['stroke', 'view'].every((key) => fields.some((f) => f.key === key))) {
      box.append(button('detail', 'Draw a stroke', 'Draw a silhouette on the view', () => context.drawStroke((stroke, view) => add({ view, stroke }))));
    } else if (point) {
      const others = Object.fromEntries(fields.filter((f) => f.required && f !== point).map((f) => [f.key, blank(f)]));
      const take = (at: Vector) => (add({ ...others, [point.key]: at }), 'stop' as const);
      box.append(button('target', 'Click a place', 'Click a place on the model', () => context.pickPoints(take, `Click a place for ${field.key}.`)));
    } else box.append(button('add', 'Add', 'Add an entry', () => add(blank(item))));
  } else box.append(button('add', 'Add', 'Add an entry', () => add(blank(item))));
  return box;
}

/** A value that a new entry begins with. */
function blank(field: Field): Json {
  const { kind } = field;
  if (field.default !== null) return field.default;
  if (kind.is === 'group') return Object.fromEntries(kind.fields.filter((f) => f.required).map((f) => [f.key, blank(f)]));
  if (kind.is === 'vector') return Array.from({ length: kind.size }, () => 0);
  if (kind.is === 'length') return '2%';
  if (kind.is === 'choice') return kind.choices[0].value;
  if (kind.is === 'list') return [];
  if (kind.is === 'number') return Math.max(0, Number.isFinite(kind.least) ? kind.least : 0);
  return kind.is === 'toggle' ? false : '';
}

function without(values: Json[], index: number): Json {
  const rest = values.filter((_, i) => i !== index);
  return rest.length === 0 ? null : rest;
}

/** Numbers or names with commas between. */
function words(item: Field, values: Json[], change: Change): HTMLElement {
  const input = h('input', {
    type: 'text', spellcheck: false, value: values.join(', '), placeholder: 'none',
    onchange: () => {
      const all = input.value.split(/[,\s]+/).filter((w) => w !== '');
      change(all.length === 0 ? null : all.map((w) => (item.kind.is === 'number' ? Number(w) : w)));
    },
  });
  return input;
}

/** Numbers of faces and vertices are painted and clicked as well. */
function picked(field: Field, typed: HTMLElement, change: Change, context: Context): HTMLElement {
  const pick = field.key === 'vertices'
    ? button('target', 'Click vertices', 'Click vertices on the model', () => context.pickVertices(change))
    : field.key === 'faces' && button('detail', 'Paint', 'Paint faces on the model with a brush', () => context.paintFaces(change));
  return pick ? h('span', { className: 'with-unit' }, typed, pick) : typed;
}

/** One of several groups; which one is told by the keys that it needs. */
function variant(kind: { variants: { name: string; fields: Field[] }[]; file: boolean }, value: Json, change: Change, context: Context): HTMLElement {
  const values = typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Options) : undefined;
  const now = kind.variants.find((v) => values && v.fields.every((f) => !f.required || values[f.key] !== undefined));
  const select = h('select', { onchange: () => {
    const chosen = kind.variants[Number(select.value)];
    change(select.value === '' ? null : chosen ? required(chosen.fields) : '');
  } }, h('option', { value: '' }, 'not given'), ...kind.variants.map((v, i) => h('option', { value: String(i), selected: v === now }, v.name)));
  if (kind.file) select.append(h('option', { value: '-1', selected: typeof value === 'string' }, 'file'));
  const set = (key: string, v: Json) => change({ ...values, [key]: v });
  const lines = (now?.fields ?? []).map((f) =>
    h('div', { className: 'row', title: f.description, 'data-key': f.key }, h('span', { className: 'name' }, f.key.replaceAll('_', ' ')), control(f, values?.[f.key] ?? f.default, (v) => set(f.key, v), context)));
  return h('div', { className: 'stack' }, select, ...lines, typeof value === 'string' && text(value, change));
}

/** A group that may be absent: it is made complete before it is sent. */
function group(field: Field, fields: Field[], value: Json, change: Change, context: Context): HTMLElement {
  const values = (value ?? {}) as Options;
  const draft: Options = { ...values };
  const set = (key: string, v: Json) => {
    if (v === null) delete draft[key];
    else draft[key] = v;
    const complete = fields.every((f) => !f.required || draft[f.key] !== undefined);
    change(Object.keys(draft).length === 0 ? null : complete ? draft : { ...required(fields), ...draft });
  };
  const lines = fields.map((f) =>
    h('div', { className: 'row', title: f.description, 'data-key': f.key }, h('span', { className: 'name' }, f.key.replaceAll('_', ' ')), control(f, values[f.key] ?? f.default, (v) => set(f.key, v), context)));
  const box = h('details', { className: 'group' }, h('summary', {}, value === null ? 'not given' : summary(values)), ...lines);
  box.open = context.unfolded.has(field.key) || value !== null;
  box.addEventListener('toggle', () => context.unfolded[box.open ? 'add' : 'delete'](field.key));
  if (['point', 'normal'].every((key) => fields.some((f) => f.key === key))) {
    const plane = () => {
      const section = context.sectionPlane();
      if (section) change({ point: section.point, normal: section.normal });
    };
    box.append(button('section', 'Take the section plane', 'Switch the section plane on in the view, move it, then take it here', plane));
  }
  return box;
}

function required(fields: Field[]): Options {
  return Object.fromEntries(fields.filter((f) => f.required).map((f) => [f.key, blank(f)]));
}

/** A group in one line. */
function summary(values: Options): string {
  const short = (v: Json): string => {
    if (typeof v === 'number') return String(Number(v.toPrecision(3)));
    if (!Array.isArray(v)) return typeof v === 'object' ? '…' : String(v);
    return v.some(Array.isArray) ? `of ${v.length} points` : v.length > 4 ? `${v.length} entries` : v.map(short).join(' ');
  };
  return Object.entries(values).filter(([, v]) => v !== null).map(([key, v]) => `${key} ${short(v)}`).join(', ');
}

function text(value: Json, change: Change): HTMLInputElement {
  const input = h('input', {
    type: 'text', spellcheck: false, value: value === null ? '' : String(value), placeholder: 'auto',
    onchange: () => change(input.value === '' ? null : input.value),
  });
  return input;
}

/** A text with the values that are known, as a row of buttons. */
function suggesting(suggestions: string[], value: Json, change: Change): HTMLElement {
  if (typeof value === 'object' && value !== null) return json(value, change);
  if (suggestions.length === 0) return text(value, change);
  const chips = suggestions.map((s) => h('button', { className: s === value ? 'chip on' : 'chip', onclick: () => change(s) }, s));
  return h('span', { className: 'stack' }, h('span', { className: 'chips' }, ...chips), text(value, change));
}

/** Anything else as it stands in JSON. */
function json(value: Json, change: Change): HTMLElement {
  const input = h('input', {
    type: 'text', spellcheck: false, value: value === null ? '' : JSON.stringify(value), placeholder: 'none',
    onchange: () => {
      if (input.value.trim() === '') return change(null);
      try {
        change(JSON.parse(input.value));
      } catch {
        // A word without quotes is a text.
        change(input.value.trim());
      }
    },
  });
  return input;
}

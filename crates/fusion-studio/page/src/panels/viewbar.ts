// Over the view: tools on its left, how shapes are drawn on its right.

import { button, fill, h } from '../dom';
import type { Look, Store } from '../store';
import type { Preset } from '../view/stage';

const TOOLS: [Store['tool'], string, string][] = [
  ['select', 'select', 'Select shapes, curves and places (Q)'],
  ['move', 'move', 'Move the selected part (G)'],
  ['rotate', 'rotate', 'Turn the selected part (R)'],
  ['measure', 'measure', 'Measure between two places (M)'],
];

const COLOURS: [Look['colour'], string][] = [
  ['plain', 'Plain'], ['origin', 'Origin'], ['curvature', 'Mean curvature'], ['zebra', 'Zebra'], ['quality', 'Quality'],
];

export interface ViewActions {
  fit(): void;
  look(from: Preset): void;
  picture(): void;
}

export function viewbar(tools: HTMLElement, looks: HTMLElement, store: Store, view: ViewActions) {
  const draw = () => {
    fill(tools, ...TOOLS.map(([tool, icon, title]) => pressed(button(icon, '', title, () => setTool(store, tool)), store.tool === tool)));
    const { look } = store;
    const toggle = (key: 'wire' | 'edges' | 'grid' | 'section' | 'occlusion' | 'parallel', title: string) =>
      pressed(button(key, '', title, () => change({ [key]: !look[key] })), look[key]);
    const colour = h('select', { title: 'Colour of faces', 'aria-label': 'Colour of faces', onchange: () => change({ colour: colour.value as Look['colour'] }) },
      ...COLOURS.map(([value, name]) => h('option', { value, selected: look.colour === value }, name)));
    const preset = h('select', { title: 'Look from a side (1, 3, 7; Home shows all)', 'aria-label': 'Look from a side', onchange: () => (view.look(preset.value as Preset), (preset.value = '')) },
      h('option', { value: '' }, 'View'), ...['corner', 'front', 'back', 'left', 'right', 'top', 'bottom'].map((p) => h('option', { value: p }, p)));
    fill(looks, colour,
      toggle('edges', 'Feature curves and seams (E)'), toggle('wire', 'Edges of all triangles (W)'),
      toggle('occlusion', 'Ambient occlusion: hollows are darker (slow without a graphics card)'), toggle('parallel', 'Parallel projection (5)'), toggle('section', 'Section plane (C)'), toggle('grid', 'Grid'),
      pressed(button('up', look.up.toUpperCase(), 'Which axis points up', () => change({ up: look.up === 'z' ? 'y' : 'z' })), false),
      preset,
      button('fit', '', 'Show everything (Home); F shows the selection', view.fit),
      button('picture', '', 'Save the view as a picture', view.picture));
  };
  const change = (part: Partial<Look>) => {
    Object.assign(store.look, part);
    store.changed('look');
  };
  store.on(['look', 'tool'], draw);
  draw();
}

export function setTool(store: Store, tool: Store['tool']) {
  store.tool = tool;
  store.changed('tool');
}

function pressed(element: HTMLButtonElement, on: boolean): HTMLButtonElement {
  element.setAttribute('aria-pressed', String(on));
  return element;
}

// Makes elements in one line each.

export type Child = Node | string | null | undefined | false;
type Attributes = { [key: string]: unknown };

/** An element with attributes, `on…` listeners and children; `title` is its tooltip. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value as EventListener);
    else if (key in element && key !== 'list') (element as unknown as Attributes)[key] = value;
    else element.setAttribute(key, value === true ? '' : String(value));
  }
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
  return element;
}

/** A button with an icon and, beside it, its name. */
export function button(icon: string, name: string, title: string, action: () => void): HTMLButtonElement {
  const element = h('button', { title, onclick: action, 'aria-label': name || title });
  element.append(symbol(icon));
  if (name) element.append(h('span', {}, name));
  return element;
}

/** An icon drawn from the page's own set. */
export function symbol(name: string): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  const use = document.createElementNS(space, 'use');
  use.setAttribute('href', `#icon-${name}`);
  svg.setAttribute('class', 'icon');
  svg.setAttribute('aria-hidden', 'true');
  svg.append(use);
  return svg;
}

/** A number as people write it: few digits, no noise. */
export function number(value: number, digits = 4): string {
  return Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : '–';
}

/** Replaces what is in an element. */
export function fill(host: HTMLElement, ...children: Child[]) {
  host.replaceChildren(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
}

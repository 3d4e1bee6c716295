// Dialogs: open, save, export, new, help.

import type { Actions } from '../actions';
import { MESH_ENDINGS } from '../actions';
import { button, h } from '../dom';
import { fileAddress } from '../connection';
import type { Store } from '../store';

/** Formats that can be written. */
const FORMATS = ['glb', '3mf', 'stl', 'ply', 'obj', 'off'];

export class Dialogs {
  constructor(private store: Store, private actions: Actions) {}

  addParts = () => {
    const input = h('input', { type: 'file', multiple: true, accept: [...MESH_ENDINGS, 'toml'].map((e) => `.${e}`).join(',') });
    input.addEventListener('change', () => void this.actions.addFiles([...(input.files ?? [])]));
    input.click();
  };

  newDocument = () => {
    if (this.store.document.parts.length === 0) return void this.actions.ask('new');
    this.show('New document', h('p', {}, 'The document that is open is closed. It is kept in .fusion-studio/autosave.toml until the next edit.'), 'New', async () => {
      await this.actions.ask('new');
      this.store.select([]);
      return true;
    });
  };

  open = async () => {
    const found = await this.actions.quietly<{ files: { path: string }[] }>('files');
    const files = (found?.files ?? []).map((f) => f.path).filter((f) => f.endsWith('.toml'));
    const name = h('input', { type: 'text', placeholder: 'model.toml', spellcheck: false, name: 'path', value: files[0] ?? '' });
    const list = h('ul', { className: 'files' }, ...files.map((f) => h('li', { tabIndex: 0, onclick: () => (name.value = f) }, f)));
    const browse = button('open', 'From this computer…', 'Choose a document; its meshes must be below the studio’s folder', () => this.addParts());
    this.show('Open a document', h('div', { className: 'stack' }, list, name, browse), 'Open', async () => {
      const opened = await this.actions.ask('open', { path: name.value.trim() });
      if (opened) this.store.select([]);
      return opened !== undefined;
    });
  };

  save = () => {
    const path = this.store.document.path ?? 'model.toml';
    const name = h('input', { type: 'text', value: path, spellcheck: false, name: 'path' });
    this.show('Save the document', h('div', { className: 'stack' }, name, h('p', { className: 'hint' }, 'Below the folder that the studio serves. fusion-cli run writes the same files from it.')), 'Save', async () => {
      const file = name.value.trim().endsWith('.toml') ? name.value.trim() : `${name.value.trim()}.toml`;
      await this.actions.save(file);
      return this.store.document.path === file || this.store.failure === undefined;
    });
  };

  addOutput = () => this.exportShape();

  exportShape = () => {
    const shapes = this.store.evaluated?.shapes.map((s) => s.name) ?? this.store.document.shapes;
    const chosen = this.store.shapes.at(-1) ?? shapes.at(-1) ?? '';
    const of = h('select', { name: 'of', onchange: () => rename() }, ...shapes.map((s) => h('option', { selected: s === chosen }, s)));
    const format = h('select', { name: 'format', onchange: () => rename() }, ...FORMATS.map((f) => h('option', {}, f)));
    const file = h('input', { type: 'text', name: 'file', spellcheck: false, value: `${chosen}.glb` });
    const rename = () => (file.value = `${of.value}.${format.value}`);
    const row = (label: string, control: HTMLElement) => h('label', { className: 'row' }, h('span', { className: 'name' }, label), control);
    this.show('Export a shape', h('div', { className: 'stack' }, row('shape', of), row('format', format), row('file', file), h('p', { className: 'hint' }, 'It becomes an output of the document, so that fusion-cli run writes the same file.')), 'Export', async () => {
      const request = { of: of.value, file: file.value.trim() };
      const written = await this.actions.ask<{ path?: string }>('export', request);
      if (!written) return false;
      const path = written.path ?? request.file;
      this.store.say(`Exported ${request.of} to ${path}.`);
      h('a', { href: fileAddress(path), download: path.split('/').pop() ?? path }).click();
      return true;
    });
  };

  help = () => {
    const keys: [string, string][] = [
      ['Drag', 'orbit'], ['Right drag, Shift drag', 'pan'], ['Wheel', 'zoom to the pointer'], ['Click, Shift+click', 'select; add to the selection'],
      ['Q  G  R  M', 'select, move, turn, measure'], ['E  W  C', 'curves, triangles, section plane'], ['F, Home', 'show the selection, show all'], ['1  3  7  5', 'front, right, top; parallel projection'],
      ['Ctrl+Z, Ctrl+Shift+Z', 'undo, redo'], ['Delete', 'remove what is selected'], ['Ctrl+S, Ctrl+O, Ctrl+E', 'save, open, export'], ['Escape', 'stop, deselect'], ['Alt+Up, Alt+Down', 'move a step in the list'],
    ];
    this.show('Keys and mouse', h('table', {}, ...keys.map(([k, what]) => h('tr', {}, h('td', {}, h('kbd', {}, k)), h('td', {}, what)))), 'Close', async () => true);
  };

  private show(title: string, body: HTMLElement, verb: string, act: () => Promise<boolean>) {
    const dialog = h('dialog', { 'aria-label': title });
    const go = h('button', { className: 'primary', type: 'submit' }, verb);
    const cancel = h('button', { type: 'button', onclick: () => dialog.close() }, 'Cancel');
    const form = h('form', { method: 'dialog' }, h('h2', {}, title), body, h('div', { className: 'buttons' }, verb !== 'Close' && cancel, go));
    form.addEventListener('submit', async (event) => {
      event.preventDefault();
      go.disabled = true;
      if (await act()) dialog.close();
      go.disabled = false;
    });
    dialog.addEventListener('close', () => dialog.remove());
    dialog.addEventListener('keydown', (event) => event.stopPropagation());
    dialog.append(form);
    document.body.append(dialog);
    dialog.showModal();
    dialog.querySelector<HTMLInputElement>('input[type=text]')?.select();
  }
}

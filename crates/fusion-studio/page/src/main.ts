// Puts the page together: the connection, what it knows, the view and the panels around it.

import './style.css';
import { Actions } from './actions';
import { Connection } from './connection';
import { h } from './dom';
import type { Context } from './forms/controls';
import { Vocabulary, type Schema } from './forms/schema';
import type { Frame } from './frames';
import { addIcons } from './icons';
import { keys } from './keys';
import { badge } from './panels/badge';
import { Dialogs } from './panels/dialogs';
import { drop } from './panels/drop';
import { failureCard } from './panels/failure';
import { log } from './panels/log';
import { properties } from './panels/properties';
import { seamCard } from './panels/seam';
import { text } from './panels/text';
import { toolbar } from './panels/toolbar';
import { tree } from './panels/tree';
import { setTool, viewbar } from './panels/viewbar';
import { Points } from './points';
import type { ServerEvent } from './protocol';
import { Radius } from './radius';
import { Seams } from './seams';
import { Store } from './store';
import { Verbs } from './verbs';
import { Section } from './view/section';
import { View } from './view/view';
import { receive } from './receive';

const find = (id: string) => document.getElementById(id) as HTMLElement;

async function start() {
  const schema = (await (await fetch('schema')).json()) as Schema;
  const words = new Vocabulary(schema);
  const store = new Store();
  const waiting: (ServerEvent | Frame)[] = [];
  let deliver: (message: ServerEvent | Frame) => void = (message) => waiting.push(message);
  const server = new Connection({
    event: (event) => deliver(event),
    frame: (frame) => deliver(frame),
    connected: (open) => {
      store.connected = open;
      store.changed('connection');
      if (open) void server.ask('state').catch(() => undefined);
    },
  });
  const actions = new Actions(store, server);
  const radius = new Radius(store, actions);
  const seams = new Seams(store, actions, radius);
  const view = new View(find('view'), store, actions, radius, seams);
  const points = new Points(store, actions, view, find('hint'));
  const dialogs = new Dialogs(store, actions);
  const verbs = new Verbs(store, actions, points);
  const section: Section = new Section(view.stage, find('section'), store, () => {
    const { plane } = section;
    if (plane) void actions.addStep('cut', store.shapes, { plane }).then(() => {
      store.look.section = false;
      store.changed('look');
    });
  }, verbs.cutAlongPath);
  const context: Context = {
    pickPoints: (take, hint) => points.take(take, hint),
    names: (key) => (key === 'primitive' ? Object.keys(store.document.primitives) : key === 'to' || key === 'part' ? store.document.parts.map((p) => p.name) : []),
    pickVertices: (take) => points.vertices(take),
    paintFaces: (take) => points.faces(take),
    drawStroke: (drawn) => points.draw(drawn),
    sectionPlane: () => section.plane,
    unfolded: new Set(),
  };
  toolbar(find('toolbar'), store, actions, words, { ...dialogs, verb: verbs.run });
  tree(find('tree'), store, actions, { ...dialogs, focus: () => view.focus() });
  properties(find('properties'), store, actions, words, context, () => seamCard(store, radius, view.flyTo, () => points.take((at) => {
    void radius.vary(at);
    return 'stop';
  }, 'Click a place of the curve.')));
  text(find('document'), store, actions);
  log(find('log'), store, actions, view.flyTo);
  failureCard(find('failure'), store, actions, view.flyTo);
  badge(find('badge'), store, actions, view.flyTo);
  viewbar(find('tools'), find('looks'), store, { fit: () => view.fit(), look: (from) => view.stage.look(from), picture: () => picture(view) });
  drop(find('app'), find('drop'), actions);
  tabs();
  keys(store, actions, {
    ...dialogs,
    fit: () => view.fit(),
    focus: () => view.focus(),
    look: (from) => view.stage.look(from),
    escape: () => {
      if (points.stop()) return;
      if (store.work) void actions.ask('cancel');
      else if (store.failure) actions.dismiss();
      else if (store.curves?.picked.length) seams.pick(undefined, false);
      else if (store.tool !== 'select') setTool(store, 'select');
      else store.select([]);
    },
  });
  let up = store.look.up;
  store.on(['look'], () => {
    if (store.look.up !== up) view.stage.setUp((up = store.look.up));
  });
  deliver = (message) => receive(message, store, view);
  for (const message of waiting.splice(0)) deliver(message);
  // For tests: what is drawn and known can be asked.
  Object.assign(window, { studio: { store, view, server, actions } });
}

/** Saves what the view shows as a picture. */
function picture(view: View) {
  view.stage.render();
  view.stage.renderer.domElement.toBlob((blob) => {
    if (blob) h('a', { href: URL.createObjectURL(blob), download: 'view.png' }).click();
  });
}

/** The tabs on the right: properties, and the document beside them. */
function tabs() {
  const buttons = [...document.querySelectorAll<HTMLButtonElement>('#tabs button')];
  for (const button of buttons) {
    button.addEventListener('click', () => {
      for (const other of buttons) {
        other.setAttribute('aria-selected', String(other === button));
        find(other.dataset.panel ?? '').hidden = other !== button;
      }
    });
  }
}

addIcons();
try {
  const theme = localStorage.getItem('theme');
  if (theme) document.documentElement.dataset.theme = theme;
} catch {
  // The look of the system then holds.
}
void start();

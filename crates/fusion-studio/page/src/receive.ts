// Takes in what the server sends.

import type { Frame } from './frames';
import type { ServerEvent } from './protocol';
import type { Row, Store } from './store';
import type { View } from './view/view';

export function receive(message: ServerEvent | Frame, store: Store, view: View) {
  if ('event' in message) event(message, store);
  else if ('mesh' in message) {
    const { mesh } = message;
    store.meshes.set(mesh.shape, mesh);
    const fresh = view.shapes.take(mesh);
    store.changed('mesh');
    if (fresh) view.welcome(mesh.shape);
  } else {
    view.shapes.fields.set(message.field.shape, message.field);
    store.changed('mesh');
  }
}

function event(event: ServerEvent, store: Store) {
  switch (event.event) {
    case 'document':
      store.document = event;
      store.selection = store.selection.filter((row) => exists(row, store));
      store.changed('document', 'selection');
      // Work that does not tell how far it is can be seen and stopped, too.
      setTimeout(() => isAwaited(event.version, store) && !store.work && working(store, 'working', null), 300);
      break;
    case 'progress':
      working(store, event.stage, event.fraction);
      break;
    case 'evaluated':
      store.evaluated = event;
      ended(store);
      if (store.failure && 'event' in store.failure) store.failure = undefined;
      for (const step of event.steps) if (!step.known) warnings(step.report, step.name, store);
      store.changed('evaluated', 'work', 'failure');
      break;
    case 'failed':
      ended(store);
      store.failure = event;
      store.failedVersion = event.version;
      store.say(event.sentence, 'error', event);
      store.changed('failure', 'work', 'evaluated');
      break;
    case 'cancelled':
      ended(store);
      store.failedVersion = event.version;
      store.say('Cancelled.');
      store.changed('work');
      break;
    case 'autosave':
      store.say(`A document that was not saved was found in ${event.path}; open it to go on.`);
      break;
  }
}

/** Whether a document is the newest one, and nothing has come of it yet. */
function isAwaited(version: number, store: Store): boolean {
  const latest = Math.max(store.evaluated?.version ?? -1, store.failedVersion ?? -1);
  return store.document?.version === version && latest < version;
}

function working(store: Store, stage: string, fraction: number | null) {
  if (store.workSince === undefined) {
    store.workSince = performance.now();
    // What is seen is marked as old once that takes long.
    setTimeout(() => store.work && store.changed('work'), 700);
  }
  store.work = { stage, fraction };
  store.changed('work');
}

function ended(store: Store) {
  store.work = undefined;
  store.workSince = undefined;
}

/** A report's warnings are said in the log. */
function warnings(report: unknown, name: string, store: Store) {
  const list = (report as { warnings?: unknown[] } | null)?.warnings;
  for (const warning of Array.isArray(list) ? list : []) {
    const text = typeof warning === 'string' ? warning : (warning as { sentence?: string; message?: string }).sentence ?? (warning as { message?: string }).message;
    if (text && store.log.at(-1)?.text !== `${name}: ${text}`) store.say(`${name}: ${text}`, 'warning');
  }
}

function exists(row: Row, store: Store): boolean {
  const { parts, steps, outputs, primitives } = store.document;
  const length = row.table === 'primitive' ? Object.keys(primitives).length : row.table === 'part' ? parts.length : row.table === 'step' ? steps.length : outputs.length;
  return row.index < length;
}

// Long work is seen, and is stopped by a button; two pages share one document; a page that loses its server says so.

import assert from 'node:assert/strict';
import { scenario } from './harness.mjs';
import { scan } from './models.mjs';

scenario('an evaluation is cancelled, and the last valid result stays', {}, async (session, page) => {
  await session.drop({ 'body.obj': scan(48, [0, 0, 0], 1) });
  await session.choose('part-0');
  await session.press('Remesh');
  await session.settled();
  // So fine that it takes long.
  await page.fill('[data-key=edge_length] input', '0.006');
  await page.keyboard.press('Enter');
  await page.waitForSelector('#log .work.on');
  await page.waitForTimeout(1200);
  await session.picture('working');
  await page.click('#log .work button');
  await page.waitForFunction(() => !(/** @type {any} */ (window).studio.store.work));
  assert.match((await page.textContent('#log .lines')) ?? '', /Cancelled/);
  assert.ok((await session.covered()) > 0.02, 'what was valid is still seen');
  await page.keyboard.press('Control+z');
  await session.settled();
  assert.equal((await session.document()).steps[0].options.edge_length, '1%');
});

scenario('two pages show the same document', {}, async (session, page) => {
  const other = await page.context().newPage();
  await other.goto(`${session.address}?plain`);
  await other.waitForFunction(() => /** @type {any} */ (window).studio?.store.connected);
  await page.bringToFront();
  await session.drop({ 'one.obj': scan(10, [0, 0, 0], 1) });
  await other.waitForFunction(() => /** @type {any} */ (window).studio.view.shapes.names.includes('one'));
  await other.close();
});

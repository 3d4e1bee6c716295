// A body is cut by the section plane and by a path of clicks; the openings are joined again.

import assert from 'node:assert/strict';
import { scenario } from './harness.mjs';
import { scan, tube } from './models.mjs';

scenario('a cut at the section plane, and one along clicked places', {}, async (session, page) => {
  await session.drop({ 'body.obj': scan(24, [0, 0, 0], 1) });
  await session.choose('part-0');
  await session.press('Cut');
  await page.locator('#section').getByRole('button', { name: 'z', exact: true }).click();
  await session.picture('section');
  await session.press('Cut here');
  await session.settled();
  let [result] = (await session.evaluated()).shapes.filter((/** @type {any} */ s) => s.result);
  assert.equal(result.closed, false, 'the cut leaves an opening');
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.curves?.kind === 'loops');
  await session.picture('opening');
  await page.keyboard.press('Control+z');
  await session.settled();

  await session.choose('part-0');
  await session.press('Cut');
  await session.press('Click a path');
  for (const place of /** @type {[number, number, number][]} */ ([[0.25, -0.75, 0.6], [0.75, -0.25, 0.6], [-0.3, -0.7, 0.65]])) await session.clickAt(place);
  await session.picture('path');
  await session.press('Done');
  await session.settled();
  assert.equal((await session.document()).steps[0].options.path.length, 3);
  [result] = (await session.evaluated()).shapes.filter((/** @type {any} */ s) => s.result);
  assert.equal(result.closed, false);
  await session.picture('scissors');
});

scenario('loops lit up with numbers, joined, and shaped by a silhouette', {}, async (session, page) => {
  await session.drop({ 'low.obj': tube(1, 0, 2), 'high.obj': tube(1, 5, 7) });
  await session.choose('part-0');
  await session.choose('part-1', { shift: true });
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.curves?.curves.length === 4);
  assert.equal(await page.locator('.label').count(), 4, 'each loop has its number');
  // The upper loop of the lower tube, and the lower one of the upper.
  const chosen = await page.evaluate(() => /** @type {any} */ (window).studio.store.curves.curves.flatMap((/** @type {any} */ c, /** @type {number} */ i) => (c.at[2] > 1 && c.at[2] < 6 ? [i] : [])));
  assert.equal(chosen.length, 2);
  await page.locator('.label').nth(chosen[0]).click();
  await page.locator('.label').nth(chosen[1]).click({ modifiers: ['Shift'] });
  await session.picture('loops');
  await session.press('Compose');
  await session.settled();
  const [step] = (await session.document()).steps;
  const of = step.written_of ?? step.of;
  assert.deepEqual(of.map((/** @type {string} */ name) => name.split(':')[0]), ['low', 'high']);
  assert.ok(of.every((/** @type {string} */ name) => /:\d$/.test(name)), `chosen loops: ${of}`);
  assert.equal(await session.failure(), undefined);
  await session.picture('composed');

  // A bulge drawn on the view, from one opening to the other.
  await page.keyboard.press('1');
  await page.waitForTimeout(300);
  await session.press('Draw a stroke');
  const stroke = [];
  for (let i = 0; i <= 12; i++) stroke.push(await session.onScreen([1 + 0.8 * Math.sin((Math.PI * i) / 12), 0, 2 + (3 * i) / 12]));
  await page.mouse.move(stroke[0].x, stroke[0].y);
  await page.mouse.down();
  for (const { x, y } of stroke) {
    await page.mouse.move(x, y, { steps: 3 });
    await page.waitForTimeout(20);
  }
  await page.mouse.up();
  await session.settled();
  const { silhouette } = (await session.document()).steps[0].options;
  assert.equal(silhouette.length, 1);
  assert.ok(silhouette[0].view[1] > 0.99, 'seen from the front');
  assert.equal(await session.failure(), undefined);
  await session.picture('studio-compose');
});

// The document: renamed, suppressed, reordered, typed as TOML, saved and opened; parts on primitives.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { scenario } from './harness.mjs';
import { box, scan, tube } from './models.mjs';

const DOCUMENT = `version = 2

[[part]]
name = "block"
mesh = "block.obj"

[[part]]
name = "ball"
mesh = "ball.obj"
translate = [0.8, 0, 0.4]

[[step]]
do = "union"
of = ["block", "ball"]
as = "both"
`;

scenario('a document opened, edited as a form and as text, and saved', { files: { 'block.obj': box([2, 2, 1], 6), 'ball.obj': scan(20, [0, 0, 0], 0.7), 'model.toml': DOCUMENT } }, async (session, page) => {
  await page.keyboard.press('Control+o');
  await page.click('dialog .files li:has-text("model.toml")');
  await session.picture('open');
  await page.click('dialog button[type=submit]');
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.document.steps.length === 1);
  await session.settled();

  // A form from the schema: every option of the operation has a row.
  await session.choose('step-0');
  await page.click('#properties details.more summary');
  const rows = await page.locator('#properties section .row').evaluateAll((all) => all.map((row) => row.getAttribute('data-key')));
  for (const key of ['radius', 'profile', 'near', 'overlap', 'alpha', 'tolerance']) assert.ok(rows.includes(key), `${key} in ${rows}`);
  await page.fill('[data-key=radius] input', '3%');
  await page.keyboard.press('Enter');
  await session.settled();
  await page.click('[data-key=profile] .chip:has-text("g2")');
  await session.settled();
  await session.picture('form');
  assert.deepEqual((await session.document()).steps[0].options, { radius: '3%', profile: 'g2' });

  // Renamed in the form, suppressed in the list.
  await page.fill('#properties .rename', 'joined');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.document.steps[0].as === 'joined');
  await session.settled();
  await page.click('#tree li[data-row=step-0] button');
  await session.settled();
  assert.equal((await session.document()).steps[0].off, true);
  await page.keyboard.press('Control+z');
  await session.settled();
  assert.equal((await session.document()).steps[0].off, false);

  // A second step, moved before the first and back by the keyboard.
  await session.choose('part-1');
  await session.press('Remesh');
  await session.settled();
  await session.choose('step-1');
  await page.focus('#tree li[data-row=step-1]');
  await page.keyboard.press('Alt+ArrowUp');
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.document.steps[0].do === 'remesh');
  await session.settled();
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await session.settled();

  // The same document as text: what is typed is evaluated.
  await page.click('#tabs button:has-text("Document")');
  const text = await page.inputValue('#document textarea');
  assert.match(text, /profile = "g2"/);
  await page.fill('#document textarea', text.replace('"3%"', '0.05'));
  await session.press('Apply');
  await session.settled();
  assert.equal((await session.document()).steps[0].options.radius, 0.05);
  await session.picture('text');
  await page.fill('#document textarea', 'version = 2\n[[step]]\ndo = "uniom"\n');
  await session.press('Apply');
  await page.waitForSelector('#failure:not([hidden])');
  assert.match((await session.failure()).sentence, /uniom/);
  await session.press('Revert');

  await session.save('renamed.toml');
  assert.match(readFileSync(join(session.root, 'renamed.toml'), 'utf8'), /as = "joined"/);
});

scenario('a part rides on a primitive', {}, async (session, page) => {
  await session.drop({ 'horn.obj': tube(0.2, 0, 0.6, 24, 6) });
  await page.click('#tree h3:has-text("Primitives") button');
  await page.waitForFunction(() => Object.keys(/** @type {any} */ (window).studio.store.document.primitives).length === 1);
  await page.fill('[data-key=radius] input', '1');
  await page.keyboard.press('Enter');
  await page.fill('[data-key=height] input', '3');
  await page.keyboard.press('Enter');
  await session.settled();
  await session.choose('part-0');
  await page.click('[data-key=on] summary');
  await page.click('[data-key=on] .chip');
  await session.settled();
  await page.locator('[data-key=on] [data-key=at] input').nth(1).fill('0.5');
  await page.keyboard.press('Enter');
  await session.settled();
  const { on } = (await session.document()).parts[0].pose;
  assert.deepEqual([on.primitive, on.at[1]], ['cylinder', 0.5]);
  assert.equal(await session.failure(), undefined);
  // Out of the form, so that keys are the view's.
  await page.keyboard.press('Escape');
  await page.keyboard.press('Home');
  await page.waitForTimeout(400);
  await session.picture('rider');

  // Pulled along it: sideways round the axis, upwards along it.
  await page.keyboard.press('g');
  const middle = await page.evaluate(() => {
    const { view } = /** @type {any} */ (window).studio;
    return view.sphereOf(['horn']).center.toArray();
  });
  const from = await session.onScreen(middle);
  await session.pull(from, { x: from.x + 60, y: from.y - 120 });
  await session.settled();
  const { at } = (await session.document()).parts[0].pose.on;
  assert.ok(Math.abs(at[0] - on.at[0] - 0.1) < 0.02 && Math.abs(at[1] - 0.7) < 0.02, `pulled to ${at} from ${on.at}`);
});

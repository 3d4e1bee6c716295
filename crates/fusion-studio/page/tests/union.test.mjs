// Two scans are dropped, one is dragged over, they are united, the radius is dragged; what is saved replays to the same bytes.

import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { cli, scenario } from './harness.mjs';
import { scan } from './models.mjs';

scenario('two scans, united by mouse, with a radius dragged, undone, exported and replayed', {}, async (session) => {
  await session.drop({ 'left.obj': scan(12, [0, 0, 0], 1), 'right.obj': scan(12, [4, 0, 0], 0.8) });
  assert.ok((await session.covered()) > 0.02, 'the parts must be seen');

  // Dragged over by an arrow of the gizmo.
  await session.choose('part-1');
  await session.press('Move the selected part (G)');
  await session.pullArrow([4, 0, 0], 0, -2.8);
  await session.settled();
  const moved = (await session.document()).parts[1].pose.translate;
  assert.ok(moved[0] < -2 && moved[0] > -3.5 && moved[1] === 0, `moved along x alone: ${moved}`);
  await session.picture('parts');

  await session.page.keyboard.press('q');
  await session.choose('part-0');
  await session.choose('part-1', { shift: true });
  await session.press('Union');
  await session.settled();
  const united = await session.evaluated();
  assert.deepEqual(united.shapes.filter((/** @type {any} */ s) => s.result).map((/** @type {any} */ s) => [s.name, s.closed]), [['union', true]]);

  // The seam is picked in the view; the radius is dragged ten times.
  await session.page.waitForFunction(() => /** @type {any} */ (window).studio.store.curves?.curves.length === 1);
  const near = await session.page.evaluate(() => {
    const { store, view } = /** @type {any} */ (window).studio;
    const [seam] = store.curves.curves;
    // The point that is nearest to the eye is not hidden.
    const eye = view.stage.camera.position;
    const far = (/** @type {number[]} */ p) => Math.hypot(p[0] + store.curves.origin[0] - eye.x, p[1] + store.curves.origin[1] - eye.y, p[2] + store.curves.origin[2] - eye.z);
    const best = seam.points.reduce((/** @type {number[]} */ a, /** @type {number[]} */ b) => (far(b) < far(a) ? b : a));
    return best.map((/** @type {number} */ x, /** @type {number} */ k) => x + store.curves.origin[k]);
  });
  await session.clickAt(near);
  assert.equal(await session.page.evaluate(() => /** @type {any} */ (window).studio.store.curves.picked.length), 1, 'a click picks the seam');
  await session.picture('seam');
  /** @type {number[]} */
  const radii = [];
  for (let i = 1; i <= 10; i++) {
    const slider = session.page.locator('#seam input[type=range]');
    const { x, y, width, height } = /** @type {{x: number, y: number, width: number, height: number}} */ (await slider.boundingBox());
    const at = Number(await slider.inputValue());
    const knob = (/** @type {number} */ share) => ({ x: x + 8 + share * (width - 16), y: y + height / 2 });
    await session.pull(knob(at), knob(0.2 + 0.04 * i), 4);
    await session.settled();
    radii.push((await session.document()).steps[0].options.radius);
  }
  assert.equal(new Set(radii).size, 10, `ten radii: ${radii}`);
  assert.ok(radii[9] > radii[0]);
  await session.page.selectOption('#looks select[aria-label="Colour of faces"]', 'origin');
  await session.picture('studio');
  const filleted = (await session.evaluated()).shapes[0];
  assert.equal(filleted.closed, true);

  for (let i = 0; i < 5; i++) await session.page.keyboard.press('Control+z');
  await session.settled();
  assert.equal((await session.document()).steps[0].options.radius, radii[4], 'five drags are undone by five undos');
  for (let i = 0; i < 2; i++) await session.page.keyboard.press('Control+Shift+z');
  await session.settled();
  assert.equal((await session.document()).steps[0].options.radius, radii[6]);

  await session.export('union', 'both.glb');
  await session.save('model.toml');
  const replay = join(session.root, 'replay');
  mkdirSync(replay);
  for (const file of ['left.obj', 'right.obj', 'model.toml']) copyFileSync(join(session.root, file), join(replay, file));
  cli(['run', 'model.toml'], replay);
  assert.ok(readFileSync(join(replay, 'both.glb')).equals(readFileSync(join(session.root, 'both.glb'))), 'the same bytes');
  await session.picture('saved');
});

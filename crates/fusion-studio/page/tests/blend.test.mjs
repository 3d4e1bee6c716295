// Edges of a box are picked in the view and rounded; a radius that is too large is refused with a place and a remedy.

import assert from 'node:assert/strict';
import { scenario } from './harness.mjs';
import { box } from './models.mjs';

scenario('edges picked by mouse, the ball pulled, and the remedy of an error applied', {}, async (session, page) => {
  await session.drop({ 'block.obj': box([2, 2, 1], 6) });
  await session.choose('part-0');
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.curves?.curves.length === 12);
  // The two edges in front, at the top: each a straight line to a corner.
  await session.clickAt([0.33, -1, 0.5]);
  await session.clickAt([1, -0.33, 0.5], { shift: true });
  assert.equal(await page.evaluate(() => /** @type {any} */ (window).studio.store.curves.picked.length), 2);
  await session.picture('edges');

  // The ball on the model is pulled: the first value makes the step.
  const ball = await page.evaluate(() => {
    const { view } = /** @type {any} */ (window).studio;
    const box = view.stage.host.getBoundingClientRect();
    const at = view.ball.onScreen();
    return { x: box.left + at.x, y: box.top + at.y, radius: at.radius };
  });
  await session.pull({ x: ball.x + ball.radius * 0.6, y: ball.y }, { x: ball.x + ball.radius * 1.6, y: ball.y });
  await session.settled();
  const [step] = (await session.document()).steps;
  assert.equal(step.do, 'blend');
  assert.equal(step.options.near.length, 2);
  assert.ok(step.options.radius > 0.05 && step.options.radius < 0.5, `radius ${step.options.radius}`);
  const [result] = (await session.evaluated()).shapes.filter((/** @type {any} */ s) => s.result);
  assert.equal(result.closed, true);
  assert.ok(result.faces > 432, 'the fillet has faces of its own');
  await page.selectOption('#looks select[aria-label="Colour of faces"]', 'origin');
  await session.picture('studio-blend');

  // A ball that does not fit: the sentence, the place, the remedy.
  await page.click('#properties details.more > summary');
  await page.selectOption('[data-key=overlap] select', { label: 'error' });
  await session.settled();
  await page.fill('[data-key=radius] input', '0.9');
  await page.keyboard.press('Enter');
  await session.settled();
  const failure = await session.failure();
  assert.match(failure.sentence, /radius/);
  assert.ok(failure.place, 'an error has a place');
  await session.picture('studio-error');
  await session.press('Show the place');
  await session.picture('place');
  await page.click('#failure button.primary');
  await session.settled();
  assert.equal(await session.failure(), undefined, 'the remedy works');
  const radius = (await session.document()).steps[0].options.radius;
  assert.ok(Number(radius) < 0.9, `the remedy is a smaller radius: ${radius}`);
});

// How shapes are drawn: by origin, curvature, quality, stripes, triangles; light and dark; and what is measured.

import assert from 'node:assert/strict';
import { scenario } from './harness.mjs';
import { box, scan } from './models.mjs';

const DOCUMENT = `version = 2

[[part]]
name = "block"
mesh = "block.obj"

[[part]]
name = "ball"
mesh = "ball.obj"
translate = [0, 0, 0.5]

[[step]]
do = "union"
of = ["block", "ball"]
as = "both"
radius = 0.1
`;

scenario('colours, stripes, triangles, themes and measures', { files: { 'block.obj': box([3, 3, 1], 8), 'ball.obj': scan(24, [0, 0, 0], 0.9), 'model.toml': DOCUMENT }, arguments: ['model.toml'] }, async (session, page) => {
  await page.waitForFunction(() => /** @type {any} */ (window).studio.store.evaluated?.shapes.length > 0);
  await session.settled();
  const colours = page.locator('#looks select[aria-label="Colour of faces"]');
  for (const colour of ['origin', 'curvature', 'quality', 'zebra']) {
    await colours.selectOption(colour);
    await page.waitForTimeout(700);
    const coloured = await page.evaluate(() => {
      const { view } = /** @type {any} */ (window).studio;
      return [view.shapes.mesh('both').geometry.attributes.color !== undefined, view.shapes.mesh('both').material.type];
    });
    assert.deepEqual(coloured[1], colour === 'zebra' ? 'ShaderMaterial' : 'MeshPhongMaterial');
    assert.equal(coloured[0], true);
    await session.picture(`studio-${colour}`);
  }
  await colours.selectOption('origin');
  await page.keyboard.press('w');
  await page.click('button[title="Dark or light"]');
  await session.picture('light');
  await page.keyboard.press('w');

  // From one corner of the block's top to another: two places that are known.
  await page.keyboard.press('m');
  await page.keyboard.press('7');
  await page.waitForTimeout(400);
  await session.clickAt([-1.2, -1.2, 0.5]);
  await session.clickAt([1.2, -1.2, 0.5]);
  await page.waitForFunction(() => /^2\.\d+ /.test(document.querySelector('.measure-label')?.textContent ?? ''));
  const measured = await page.textContent('.measure-label');
  const distance = Number(measured?.split(' ')[0]);
  assert.ok(Math.abs(distance - 2.4) < 0.03, `2.4, to a pixel: ${measured}`);
  assert.match(measured ?? '', /· 0° between/);
  await session.picture('measure');
});

// Starts the studio on an empty folder and a browser on its page, and has the hands of a person: mouse and keys.

import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { test } from 'node:test';
import { chromium } from 'playwright-core';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {[number, number, number]} Point */

const STUDIO = process.env.FUSION_STUDIO ?? 'fusion-studio';
export const CLI = process.env.FUSION_CLI ?? 'fusion-cli';
const BROWSER = process.env.FUSION_STUDIO_BROWSER ?? '/usr/bin/chromium';
const PICTURES = process.env.FUSION_STUDIO_PICTURES ?? join(tmpdir(), 'studio-pictures');
/** Software WebGL, and nothing from the network. */
const FLAGS = [
  '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
];
/** Longest wait for anything; debug builds on few cores are slow. */
const PATIENCE = Number(process.env.FUSION_STUDIO_PATIENCE ?? 60_000);

/** A studio with a page; `files` are put below its root first. */
export class Session {
  /**
   * @param {string} root @param {string} address @param {import('node:child_process').ChildProcess} server
   * @param {import('playwright-core').Browser} browser @param {Page} page
   */
  constructor(root, address, server, browser, page) {
    this.root = root;
    this.address = address;
    this.server = server;
    this.browser = browser;
    this.page = page;
    /** @type {string[]} */
    this.complaints = [];
    page.setDefaultTimeout(PATIENCE);
    page.on('pageerror', (error) => this.complaints.push(String(error.stack)));
    page.on('console', (message) => message.type() === 'error' && this.complaints.push(message.text()));
  }

  /** @param {{ files?: { [name: string]: string }, arguments?: string[], size?: { width: number, height: number } }} options */
  static async start(options = {}) {
    const root = mkdtempSync(join(tmpdir(), 'studio-'));
    for (const [name, text] of Object.entries(options.files ?? {})) writeFileSync(join(root, name), text);
    const server = spawn(STUDIO, [...(options.arguments ?? []), '--root', root, '--no-open'], { stdio: ['ignore', 'pipe', 'inherit'], cwd: root });
    const lines = createInterface({ input: server.stdout });
    const address = await new Promise((resolve, reject) => {
      lines.once('line', (line) => resolve((/http:\S+/.exec(line) ?? [line])[0]));
      server.once('error', reject);
      server.once('exit', (code) => reject(new Error(`the studio ended with ${code}`)));
    });
    const browser = await chromium.launch({ executablePath: BROWSER, args: FLAGS });
    const context = await browser.newContext({ viewport: options.size ?? { width: 1280, height: 800 }, colorScheme: 'dark', reducedMotion: 'reduce', acceptDownloads: true });
    const session = new Session(root, address, server, browser, await context.newPage());
    await session.page.goto(`${address}?plain`);
    await session.page.waitForFunction(() => /** @type {any} */ (window).studio?.store.connected);
    return session;
  }

  async end() {
    await this.browser?.close();
    this.server.removeAllListeners('exit');
    this.server.kill();
    rmSync(this.root, { recursive: true, force: true });
    assert.deepEqual(this.complaints, [], 'the page must not complain');
  }

  /** Drops files on the page, as from a file manager. @param {{ [name: string]: string }} files */
  async drop(files) {
    const data = await this.page.evaluateHandle((all) => {
      const transfer = new DataTransfer();
      for (const [name, text] of Object.entries(all)) transfer.items.add(new File([text], name));
      return transfer;
    }, files);
    await this.page.dispatchEvent('#app', 'dragover', { dataTransfer: data });
    await this.page.dispatchEvent('#app', 'drop', { dataTransfer: data });
    const names = Object.keys(files).map((f) => f.replace(/\.[^.]+$/, ''));
    await this.page.waitForFunction((all) => all.every((n) => /** @type {any} */ (window).studio.store.document.parts.some((/** @type {any} */ p) => p.name === n)), names);
    await this.settled();
  }

  /** Waits until the newest document is evaluated, or has failed. */
  async settled() {
    await this.page.waitForFunction(() => {
      const { store } = /** @type {any} */ (window).studio;
      return store.asking === 0 && !store.work && Math.max(store.evaluated?.version ?? -1, store.failedVersion ?? -1) >= store.document.version;
    });
  }

  /** What the page knows of the document. @returns {Promise<any>} */
  document() {
    return this.page.evaluate(() => /** @type {any} */ (window).studio.store.document);
  }

  /** What was evaluated last. @returns {Promise<any>} */
  evaluated() {
    return this.page.evaluate(() => /** @type {any} */ (window).studio.store.evaluated);
  }

  /** @returns {Promise<any>} */
  failure() {
    return this.page.evaluate(() => /** @type {any} */ (window).studio.store.failure);
  }

  /** Where a place of the model is on the screen. @param {Point} place */
  async onScreen(place) {
    return this.page.evaluate((p) => {
      const { view } = /** @type {any} */ (window).studio;
      const { camera, host } = view.stage;
      camera.updateMatrixWorld();
      const v = camera.position.clone().set(...p).project(camera);
      const box = host.getBoundingClientRect();
      return { x: box.left + ((v.x + 1) / 2) * box.width, y: box.top + ((1 - v.y) / 2) * box.height };
    }, place);
  }

  /** Clicks a place of the model. @param {Point} place @param {{ shift?: boolean }} keys */
  async clickAt(place, keys = {}) {
    const { x, y } = await this.onScreen(place);
    await this.page.mouse.move(x, y);
    await this.page.waitForTimeout(60);
    if (keys.shift) await this.page.keyboard.down('Shift');
    await this.page.mouse.click(x, y);
    if (keys.shift) await this.page.keyboard.up('Shift');
    await this.page.waitForTimeout(60);
  }

  /** Pulls with the mouse. @param {{x: number, y: number}} from @param {{x: number, y: number}} to */
  async pull(from, to, steps = 8) {
    const { mouse } = this.page;
    await mouse.move(from.x, from.y);
    await this.page.waitForTimeout(120);
    await mouse.down();
    for (let i = 1; i <= steps; i++) {
      await mouse.move(from.x + ((to.x - from.x) * i) / steps, from.y + ((to.y - from.y) * i) / steps);
      await this.page.waitForTimeout(30);
    }
    await mouse.up();
  }

  /** Pulls an arrow of the gizmo by a length along an axis. @param {Point} centre @param {0|1|2} axis @param {number} length */
  async pullArrow(centre, axis, length) {
    const reach = await this.page.evaluate((c) => {
      const { camera } = /** @type {any} */ (window).studio.view.stage;
      const distance = camera.position.distanceTo({ x: c[0], y: c[1], z: c[2] });
      return (distance * Math.min(1.9 * Math.tan((Math.PI * camera.fov) / 360), 7) * 0.8) / 4;
    }, centre);
    const along = (/** @type {number} */ by) => /** @type {Point} */ (centre.map((c, k) => (k === axis ? c + by : c)));
    const grip = 0.45 * reach * Math.sign(length);
    await this.pull(await this.onScreen(along(grip)), await this.onScreen(along(grip + length)));
  }

  /** Presses a button by its name. @param {string} name */
  async press(name) {
    await this.page.getByRole('button', { name, exact: true }).first().click();
  }

  /** Clicks a row of the list on the left. @param {string} row @param {{ shift?: boolean }} keys */
  async choose(row, keys = {}) {
    await this.page.click(`#tree li[data-row=${row}]`, { modifiers: keys.shift ? ['Shift'] : [] });
  }

  /** Saves the document by its dialog. @param {string} path */
  async save(path) {
    await this.page.keyboard.press('Control+s');
    await this.page.fill('dialog input[name=path]', path);
    await this.page.click('dialog button[type=submit]');
    await this.page.waitForSelector('dialog', { state: 'detached' });
    assert.ok(existsSync(join(this.root, path)), `${path} must be there`);
  }

  /** Exports a shape by its dialog. @param {string} of @param {string} file */
  async export(of, file) {
    await this.page.keyboard.press('Control+e');
    await this.page.selectOption('dialog select[name=of]', of);
    await this.page.fill('dialog input[name=file]', file);
    await this.page.click('dialog button[type=submit]');
    await this.page.waitForSelector('dialog', { state: 'detached' });
    assert.ok(existsSync(join(this.root, file)), `${file} must be there`);
  }

  /** Keeps a picture of the page. @param {string} name */
  async picture(name) {
    mkdirSync(PICTURES, { recursive: true });
    await this.page.mouse.move(640, 795);
    await this.page.waitForTimeout(500);
    await this.page.screenshot({ path: join(PICTURES, `${name}.png`) });
  }

  /** The share of the canvas that is not background. */
  covered() {
    return this.page.evaluate(() => {
      const { view } = /** @type {any} */ (window).studio;
      const { renderer, scene } = view.stage;
      view.stage.render();
      const gl = renderer.getContext();
      const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
      const pixels = new Uint8Array(4 * w * h);
      gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const back = scene.background.clone().convertLinearToSRGB();
      const [r, g, b] = [back.r, back.g, back.b].map((c) => Math.round(255 * c));
      let other = 0;
      for (let i = 0; i < pixels.length; i += 4) if (Math.abs(pixels[i] - r) + Math.abs(pixels[i + 1] - g) + Math.abs(pixels[i + 2] - b) > 12) other++;
      return other / (w * h);
    });
  }
}

/**
 * A scenario on a studio of its own; a picture shows where it failed.
 * @param {string} name
 * @param {{ files?: { [name: string]: string }, arguments?: string[] }} options
 * @param {(session: Session, page: Page) => Promise<void>} body
 */
export function scenario(name, options, body) {
  test(name, { timeout: 5 * PATIENCE }, async () => {
    const session = await Session.start(options);
    try {
      await body(session, session.page);
    } catch (error) {
      await session.picture(`failed: ${name}`).catch(() => undefined);
      await session.end().catch((complaints) => console.error(String(complaints)));
      throw error;
    }
    await session.end();
  });
}

/** Runs the command line in a folder. @param {string[]} words @param {string} folder */
export function cli(words, folder) {
  return execFileSync(CLI, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

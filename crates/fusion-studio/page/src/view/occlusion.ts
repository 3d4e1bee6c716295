// Ambient occlusion: hollows are darker. Takes several passes for each frame, so it is off until asked for.

import type { PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { EffectComposer } from 'three/examples/jsm/postprocessing/EffectComposer.js';
import { GTAOPass } from 'three/examples/jsm/postprocessing/GTAOPass.js';
import { OutputPass } from 'three/examples/jsm/postprocessing/OutputPass.js';
import { RenderPass } from 'three/examples/jsm/postprocessing/RenderPass.js';

export class Occlusion {
  private composer: EffectComposer;
  private pass: GTAOPass;

  constructor(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera) {
    this.composer = new EffectComposer(renderer);
    this.composer.renderTarget1.samples = this.composer.renderTarget2.samples = 4;
    this.pass = new GTAOPass(scene, camera, 1, 1);
    this.composer.addPass(new RenderPass(scene, camera));
    this.composer.addPass(this.pass);
    this.composer.addPass(new OutputPass());
  }

  /** Draws a frame; hollows as wide as a share of the model's size are darkened. */
  render(width: number, height: number, pixelRatio: number, size: number) {
    this.composer.setPixelRatio(pixelRatio);
    this.composer.setSize(width, height);
    this.pass.updateGtaoMaterial({ radius: 0.12 * size, distanceExponent: 1.5, thickness: 0.2 * size, scale: 1.2, samples: 16, distanceFallOff: 1, screenSpaceRadius: false });
    this.composer.render();
  }
}

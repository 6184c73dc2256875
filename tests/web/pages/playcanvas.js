// PlayCanvas: the file is a binary asset, two views of it go to setAreaLightLuts.
import * as pc from 'playcanvas';
import { background, camera, frame, lights, size, spheres, strips } from './scene.js';

function loadTable(app, tableUrl) {
  return new Promise((resolve, reject) => {
    const asset = new pc.Asset('area-light-luts', 'binary', { url: tableUrl });
    asset.once('error', reject);
    asset.ready(() => {
      const [major, minor] = new Int16Array(asset.resource, 0, 2);
      if (major !== 0 || minor !== 1) reject(new Error(`version ${major}.${minor} of the table's file, not 0.1`));
      const [t1, t2] = [4, 4 + 65536].map((offset) => new Float32Array(asset.resource, offset, 16384));
      app.setAreaLightLuts(t1, t2);
      resolve();
    });
    app.assets.add(asset);
    app.assets.load(asset);
  });
}

function surface({ color, metalness, roughness }) {
  const material = new pc.StandardMaterial();
  material.diffuse.set(...color).gamma();   // the engine takes colours as sRGB
  material.useMetalness = true;
  material.metalness = metalness;
  // The engine fetches the table at (1 - gloss)^2, not at 1 - gloss: undone here, for the same lobes in all engines.
  material.gloss = 1 - Math.sqrt(roughness);
  material.update();
  return material;
}

function place(entity, app, position, scale, rotation) {
  entity.setLocalPosition(...position);
  entity.setLocalScale(...scale);
  if (rotation) entity.setLocalRotation(rotation);
  app.root.addChild(entity);
}

function add(app, type, material, position, scale, rotation) {
  const entity = new pc.Entity();
  entity.addComponent('render', { type, material });
  place(entity, app, position, scale, rotation);
}

// A light shines along its own -y; x and z of its scale are width and height. Disks read the form factor in t2.w.
function addLight(app, light, shape, off) {
  const { x, y, z } = frame(light);
  const turned = new pc.Mat4().set([...x, 0, ...z, 0, ...y.map((c) => -c), 0, 0, 0, 0, 1]);
  const rotation = new pc.Quat().setFromMat4(turned);
  const panel = new pc.Entity();
  panel.addComponent('light', { type: 'omni', shape, intensity: off ? 0 : light.intensity, range: 1000 });
  place(panel, app, light.center, [light.width, 1, light.height], rotation);
  const glow = new pc.StandardMaterial();
  glow.useLighting = false;
  glow.diffuse.set(0, 0, 0);
  glow.emissive.set(1, 1, 1);
  glow.cull = pc.CULLFACE_NONE;
  glow.update();
  const isDisk = shape === pc.LIGHTSHAPE_DISK;
  const scale = [light.width, isDisk ? 0.001 : 1, light.height];
  add(app, isDisk ? 'cylinder' : 'plane', glow, light.center, scale, rotation);
}

function buildScene(app, disk, off) {
  app.scene.ambientLight.set(0, 0, 0);
  app.scene.lighting.areaLightsEnabled = true;
  for (const s of strips) add(app, 'plane', surface(s), [s.x, 0, s.z], [s.width, 1, s.depth]);
  for (const s of spheres) add(app, 'sphere', surface(s), [s.x, s.y, s.z], Array(3).fill(2 * s.radius));
  for (const light of lights) addLight(app, light, disk ? pc.LIGHTSHAPE_DISK : pc.LIGHTSHAPE_RECT, off);
}

export async function render(canvas, tableUrl, { disk, off }) {
  const app = new pc.Application(canvas, { graphicsDeviceOptions: { antialias: false } });
  app.start();
  await loadTable(app, tableUrl);
  buildScene(app, disk, off);
  const texture = new pc.Texture(app.graphicsDevice, { ...size, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false,
    minFilter: pc.FILTER_NEAREST, magFilter: pc.FILTER_NEAREST });
  const renderTarget = new pc.RenderTarget({ colorBuffer: texture, depth: true });
  const eye = new pc.Entity();
  eye.addComponent('camera', { clearColor: new pc.Color(...background), fov: camera.verticalFovDegrees, nearClip: 0.1,
    farClip: 50, renderTarget, toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_NONE });
  eye.setLocalPosition(...camera.position);
  eye.lookAt(...camera.target);
  app.root.addChild(eye);
  await new Promise((resolve) => { app.once('frameend', resolve); });
  // no further frames: they would pile up faster than a processor can draw them
  app.autoRender = false;
  const pixels = await texture.read(0, 0, size.width, size.height, { renderTarget, immediate: true });
  app.destroy();
  return new Float32Array(pixels);
}

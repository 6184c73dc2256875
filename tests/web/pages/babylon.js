// Babylon.js: the engine fetches areaLightsLTC.bin itself; Tools.AssetBaseUrl says from where.
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { Scene } from '@babylonjs/core/scene.js';
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { RectAreaLight } from '@babylonjs/core/Lights/rectAreaLight.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { RenderTargetTexture } from '@babylonjs/core/Materials/Textures/renderTargetTexture.js';
import { Color3, Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Quaternion, Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { TransformNode } from '@babylonjs/core/Meshes/transformNode.js';
import { CreateGround } from '@babylonjs/core/Meshes/Builders/groundBuilder.js';
import { CreatePlane } from '@babylonjs/core/Meshes/Builders/planeBuilder.js';
import { CreateSphere } from '@babylonjs/core/Meshes/Builders/sphereBuilder.js';
import { Tools } from '@babylonjs/core/Misc/tools.js';
import { background, camera, frame, lights, size, spheres, strips } from './scene.js';

function surface(scene, { color, metalness, roughness }) {
  const material = new PBRMaterial('surface', scene);
  material.albedoColor = new Color3(...color);
  material.metallic = metalness;
  material.roughness = roughness;
  return material;
}

function buildScene(engine, off) {
  const scene = new Scene(engine);
  scene.useRightHandedSystem = true;
  scene.clearColor = new Color4(...background, 1);
  // leaves the materials' output linear and unclamped up to 30
  scene.imageProcessingConfiguration.applyByPostProcess = true;
  for (const s of strips) {
    const mesh = CreateGround('strip', { width: s.width, height: s.depth }, scene);
    mesh.position.set(s.x, 0, s.z);
    mesh.material = surface(scene, s);
  }
  for (const s of spheres) {
    const mesh = CreateSphere('sphere', { diameter: 2 * s.radius, segments: 48 }, scene);
    mesh.position.set(s.x, s.y, s.z);
    mesh.material = surface(scene, s);
  }
  // A rectangle shines along its own -z.
  for (const light of lights) {
    const stand = new TransformNode('stand', scene);
    stand.position.set(...light.center);
    const { x, y, z } = frame(light);
    stand.rotationQuaternion = Quaternion.RotationQuaternionFromAxis(...[x, y, z].map((axis) => new Vector3(...axis)));
    const panel = new RectAreaLight('panel', Vector3.Zero(), light.width, light.height, scene);
    panel.parent = stand;
    panel.intensity = off ? 0 : light.intensity;
    // PBRMaterial weighs the Fresnel term by 1 - specular colour of the light: with white, nobody would read it.
    panel.specular = new Color3(0.75, 0.75, 0.75);
    const glow = CreatePlane('glow', { width: light.width, height: light.height, sideOrientation: 2 }, scene);
    glow.parent = stand;
    glow.material = new PBRMaterial('glow', scene);
    glow.material.disableLighting = true;
    glow.material.emissiveColor = new Color3(1, 1, 1);
  }
  return scene;
}

export async function render(canvas, tableUrl, { off }) {
  // …/areaLights/areaLightsLTC.bin is what Babylon adds to the base address
  Tools.AssetBaseUrl = tableUrl.replace('/areaLights/areaLightsLTC.bin', '');
  const engine = new Engine(canvas, false);
  const scene = buildScene(engine, off);
  const eye = new FreeCamera('eye', new Vector3(...camera.position), scene);
  eye.setTarget(new Vector3(...camera.target));
  eye.fov = camera.verticalFovDegrees * Math.PI / 180;
  eye.minZ = 0.1;
  eye.maxZ = 50;
  const target = new RenderTargetTexture('picture', size, scene,
    { generateMipMaps: false, type: Engine.TEXTURETYPE_FLOAT });
  eye.outputRenderTarget = target;
  await scene.whenReadyAsync();
  scene.render();
  const pixels = await target.readPixels();
  engine.dispose();
  return pixels;
}

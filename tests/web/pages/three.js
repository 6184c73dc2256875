// three.js: the table as its users change it, in the textures that RectAreaLightUniformsLib.init() has made.
import * as THREE from 'three';
import { RectAreaLightUniformsLib } from 'three/addons/lights/RectAreaLightUniformsLib.js';
import { background, camera, lights, size, spheres, strips } from './scene.js';

async function loadTable(tableUrl, half) {
  RectAreaLightUniformsLib.init();
  const lib = THREE.UniformsLib;
  if (tableUrl) {
    const { LTC_MAT_1, LTC_MAT_2 } = await import(tableUrl);
    lib.LTC_FLOAT_1.image.data.set(LTC_MAT_1);
    lib.LTC_FLOAT_2.image.data.set(LTC_MAT_2);
    lib.LTC_HALF_1.image.data.set(LTC_MAT_1.map(THREE.DataUtils.toHalfFloat));
    lib.LTC_HALF_2.image.data.set(LTC_MAT_2.map(THREE.DataUtils.toHalfFloat));
  }
  // three takes the half textures where the device cannot filter floats, as on most phones; here both kinds are wanted.
  if (half) {
    lib.LTC_FLOAT_1 = lib.LTC_HALF_1;
    lib.LTC_FLOAT_2 = lib.LTC_HALF_2;
  }
}

function surface({ color, metalness, roughness }) {
  return new THREE.MeshStandardMaterial({ color: new THREE.Color(...color), metalness, roughness });
}

function buildScene(off) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(...background);
  for (const s of strips) {
    const mesh = new THREE.Mesh(new THREE.PlaneGeometry(s.width, s.depth), surface(s));
    mesh.rotation.x = -Math.PI / 2;
    mesh.position.set(s.x, 0, s.z);
    scene.add(mesh);
  }
  for (const s of spheres) {
    const mesh = new THREE.Mesh(new THREE.SphereGeometry(s.radius, 96, 64), surface(s));
    mesh.position.set(s.x, s.y, s.z);
    scene.add(mesh);
  }
  for (const light of lights) {
    const panel = new THREE.RectAreaLight(0xffffff, off ? 0 : light.intensity, light.width, light.height);
    panel.position.set(...light.center);
    panel.lookAt(...light.center.map((c, i) => c + light.direction[i]));
    panel.add(new THREE.Mesh(new THREE.PlaneGeometry(light.width, light.height),
      new THREE.MeshBasicMaterial({ color: new THREE.Color(1, 1, 1), side: THREE.DoubleSide })));
    scene.add(panel);
  }
  return scene;
}

export async function render(canvas, tableUrl, { half, off }) {
  await loadTable(tableUrl, half);
  const renderer = new THREE.WebGLRenderer({ canvas });
  const target = new THREE.WebGLRenderTarget(size.width, size.height, { type: THREE.FloatType });
  const eye = new THREE.PerspectiveCamera(camera.verticalFovDegrees, size.width / size.height, 0.1, 50);
  eye.position.set(...camera.position);
  eye.lookAt(...camera.target);
  renderer.setRenderTarget(target);
  renderer.render(buildScene(off), eye);
  const pixels = new Float32Array(4 * size.width * size.height);
  renderer.readRenderTargetPixels(target, 0, 0, size.width, size.height, pixels);
  renderer.dispose();
  return pixels;
}

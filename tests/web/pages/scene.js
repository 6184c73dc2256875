// The scene that every engine builds: right-handed, y up. Metals, so that the picture is what the table makes of the
// light; floor strips and spheres of several roughnesses, a low camera for grazing views, where tables differ most; one
// dielectric.
// An engine's render(canvas, tableUrl, { half, disk, off }) gives the linear picture, RGBA floats, lowest row first.
export const size = { width: 960, height: 480 };
export const camera = { position: [0, 1.05, 5.4], target: [0, 0.62, 0], verticalFovDegrees: 33 };

// Two panels: one stands behind the spheres, facing them; one hangs before them, above and left of the camera.
// Each shines along its direction; its width is level.
const unit = (v) => v.map((c) => c / Math.hypot(...v));
export const lights = [
  { center: [0, 1.75, -2.6], width: 5.2, height: 1.1, direction: unit([0, -0.4, 1]), intensity: 2.5 },
  { center: [-2.2, 3.1, 4], width: 1.6, height: 1.6, direction: unit([0.5, -0.75, -1]), intensity: 9 },
];

// Axes of a frame whose z is against the light's direction and whose x is level: an orthonormal, right-handed triple.
export function frame({ direction }) {
  const [zx, zy, zz] = direction.map((c) => -c);
  const [xx, , xz] = unit([zz, 0, -zx]);
  return { x: [xx, 0, xz], y: [zy * xz, zz * xx - zx * xz, -zy * xx], z: [zx, zy, zz] };
}

export const background = [0.012, 0.014, 0.02];
const steel = [0.56, 0.57, 0.58];

export const strips = [0.1, 0.22, 0.36, 0.52, 0.75].map((roughness, i) => (
  { x: (i - 2) * 2, z: 0, width: 1.98, depth: 8, color: steel, metalness: 1, roughness }));

export const spheres = [
  { color: [0.95, 0.93, 0.88], metalness: 1, roughness: 0.15 },
  { color: [0.95, 0.64, 0.54], metalness: 1, roughness: 0.3 },
  { color: [1.0, 0.77, 0.34], metalness: 1, roughness: 0.45 },
  { color: [0.56, 0.57, 0.58], metalness: 1, roughness: 0.65 },
  { color: [0.1, 0.22, 0.5], metalness: 0, roughness: 0.35 },
].map((material, i) => ({ x: (i - 2) * 1.16, y: 0.5, z: 0.55 - 0.12 * (i - 2) ** 2, radius: 0.5, ...material }));

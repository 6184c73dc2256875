// Shading with LTC tables: GLSL 3.30 and later, ES 3.00 and later. Include it after your #version line; what
// is not called costs nothing, nor does including it again. Under ES it sets the default precision of floats
// and samplers to highp, also for what follows it. ltc.hlsl is the same for HLSL.
//
// Isotropic table, two textures, from the header that `ltcfit export T.json --format h` writes (or any table
// of that layout); x = roughness, the square root of GGX's alpha, y = sqrt(1 - N.V):
//   matrix     RGBA32F or RGBA16F: (Minv00, Minv20, Minv02, Minv22) / Minv11
//   amplitude  RG32F or RG16F: (norm, fresnel)
// Anisotropic table, one 3D texture, RGBA32F or RGBA16F, nPhi x nTheta x 3 nAlpha nLambda, all axes linear
// over alpha = max(alphaX, alphaY), lambda = min / max, theta and phi of the view, 0 to 90 degrees:
//   texel (phi, theta, (row * nAlpha + alpha) * nLambda + lambda) = (M[row][0], M[row][1], M[row][2], e),
//   e = norm in row 0, fresnel in row 1, 0 in row 2; det M > 0
// All with linear filtering, clamped to the edge, without mipmaps.

#ifndef LTC_GLSL
#define LTC_GLSL

#ifdef GL_ES
precision highp float;
precision highp sampler2D;
precision highp sampler3D;
#endif

struct LtcEntry {
  mat3 inverse;   // takes directions of the shading frame to the clamped cosine; its scale has no meaning
  float norm;     // directional albedo for F = 1
  float fresnel;  // Schlick-weighted albedo
};

// World to shading frame: z = n, x = v as far as it is perpendicular to n, y = cross(z, x). For ltcFetch v is
// the view vector; for ltcFetchAnisotropic the tangent that alphaX is measured along. No bitangent is asked
// for: y and -y are the same to the lobe, and a frame that is always right-handed keeps the winding of lights
// where texture coordinates are mirrored. n and v unit.
mat3 ltcFrame(vec3 n, vec3 v) {
  vec3 t = v - n * dot(n, v);
  t -= n * dot(n, t);  // again: where v is close to n, the rounding left along n is not small against t
  float length2 = dot(t, t);
  // straight from above every frame about the normal will do
  vec3 up = abs(n.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  t = length2 > 1e-12 ? t * inversesqrt(length2) : normalize(cross(up, n));
  return transpose(mat3(t, cross(n, t), n));
}

LtcEntry ltcFetch(sampler2D matrixTable, sampler2D amplitudeTable, float roughness, float nDotV) {
  vec2 size = vec2(textureSize(matrixTable, 0));
  vec2 uv = vec2(clamp(roughness, 0.0, 1.0), sqrt(clamp(1.0 - nDotV, 0.0, 1.0)));
  uv = uv * (size - 1.0) / size + 0.5 / size;
  vec4 t = textureLod(matrixTable, uv, 0.0);
  vec4 a = textureLod(amplitudeTable, uv, 0.0);
  LtcEntry entry;
  // columns of the matrix
  entry.inverse = mat3(vec3(t.x, 0.0, t.y), vec3(0.0, 1.0, 0.0), vec3(t.z, 0.0, t.w));
  entry.norm = a.x;
  entry.fresnel = a.y;
  return entry;
}

// A row of M between two alphas, at w and w + next.
vec4 ltcRow(sampler3D table, vec2 uv, float w, float next, float f) {
  return mix(textureLod(table, vec3(uv, w), 0.0), textureLod(table, vec3(uv, w + next), 0.0), f);
}

// The entry of M's interpolated rows, whose last components are norm and fresnel. The table knows views in the
// first quadrant and alphaX >= alphaY. With F the mirrors, `flip`, and P the swap of x and y, if `swapped`, that
// lead there, the matrix asked for is F P M P F: the factors on the right change no lobe, but keep det M > 0, so
// that the winding of lights stays (KT et al. 2022, eq. 13 and 15: on the left only).
LtcEntry ltcEntryOfRows(vec4 row0, vec4 row1, vec4 row2, bool swapped, vec3 flip) {
  vec3 m0 = swapped ? vec3(row1.y, row1.x, row1.z) : vec3(row0);
  vec3 m1 = swapped ? vec3(row0.y, row0.x, row0.z) : vec3(row1);
  vec3 m2 = swapped ? vec3(row2.y, row2.x, row2.z) : vec3(row2);
  m0 *= flip * flip.x;
  m1 *= flip * flip.y;
  m2 *= flip;

  // The columns of det(M) times the inverse, brought to a largest entry of 1: no determinant to divide by,
  // which for alpha = 1e-4 is 1e-8, and no entry that overflows when it meets a vertex. Between nodes there
  // are matrices with det M < 0 (lambda below 0.01): there the sign belongs to the inverse, and y is flipped,
  // which is the same lobe with the winding of all others.
  vec3 c0 = cross(m1, m2);
  vec3 c1 = cross(m2, m0);
  vec3 c2 = cross(m0, m1);
  vec3 largest = max(max(abs(c0), abs(c1)), abs(c2));
  vec3 scale = vec3(1.0) / max(max(max(largest.x, largest.y), largest.z), 1e-30);
  if (dot(m0, c0) < 0.0) scale *= vec3(-1.0, 1.0, -1.0);
  LtcEntry entry;
  entry.inverse = mat3(c0 * scale, c1 * scale, c2 * scale);
  entry.norm = row0.w;
  entry.fresnel = row1.w;
  return entry;
}

// `nodes` = (nAlpha, nLambda), which the size of the texture does not tell: ivec2(8) for the default table.
// alphaX, alphaY: GGX's alpha along x and y, not its root, either may be the larger. `view` in the frame
// ltcFrame(normal, tangent), of any length; below the horizon it counts as at it.
LtcEntry ltcFetchAnisotropic(sampler3D table, ivec2 nodes, float alphaX, float alphaY, vec3 view) {
  vec3 flip = vec3(view.x < 0.0 ? -1.0 : 1.0, view.y < 0.0 ? -1.0 : 1.0, 1.0);
  bool swapped = alphaY > alphaX;
  vec2 across = swapped ? abs(vec2(view.y, view.x)) : abs(vec2(view.x, view.y));

  // Angles by atan, since acos loses the small ones. The floors only keep 0 / 0 away: at alpha = 0 every
  // lambda is the same lobe, at theta = 0 every phi.
  float sine = length(across);
  float theta = atan(sine, max(view.z, 1e-20));
  float phi = sine > 0.0 ? atan(across.y, across.x) : 0.0;
  float alpha = clamp(max(alphaX, alphaY), 0.0, 1.0);
  float lambda = clamp(min(alphaX, alphaY) / max(max(alphaX, alphaY), 1e-20), 0.0, 1.0);

  vec3 size = vec3(textureSize(table, 0));
  vec2 face = vec2(size);
  vec2 uv = (vec2(phi, theta) * 0.63661977237 * (face - 1.0) + 0.5) / face;  // 2 / pi
  float rows = float(nodes.x);
  float columns = float(nodes.y);
  float a = alpha * (rows - 1.0);
  float a0 = min(floor(a), rows - 2.0);
  // The neighbours of a block of lambdas belong to another alpha or row. Float32 coordinates are good to
  // some 3e-7 of the depth: so far the look-up stays inside the outer texels' centres, and never bleeds.
  float inset = 3e-7 * size.z;
  float w = (a0 * columns + clamp(lambda * (columns - 1.0), inset, columns - 1.0 - inset) + 0.5) / size.z;
  float next = columns / size.z;
  vec4 row0 = ltcRow(table, uv, w, next, a - a0);
  vec4 row1 = ltcRow(table, uv, w + rows * next, next, a - a0);
  vec4 row2 = ltcRow(table, uv, w + 2.0 * rows * next, next, a - a0);
  return ltcEntryOfRows(row0, row1, row2, swapped, flip);
}

// The vertex as the clamped cosine sees it: a unit vector, or (0, 0, 0) for one at the shaded point. Lengths
// may be from 1e-14 to 1e14.
vec3 ltcTransform(mat3 inverse, vec3 v) {
  vec3 t = inverse * v;
  return t * inversesqrt(max(dot(t, t), 1e-37));
}

// Half the angle between unit vectors a and b over the length of a x b, from m2 = |a + b|^2. With h half the
// angle, |a + b| = 2 cos h and |a x b| = 2 sin h cos h, so that it is (h / sin h) / |a + b|: no cases, and no
// atan. h / sin h is a polynomial in u = 1 - cos h, exact at 0 and off by at most 7.4e-8 of it elsewhere, the
// least that its degree can be (scripts/arc_polynomial.py).
float ltcArc(float m2) {
  float r = inversesqrt(max(m2, 1e-37));
  float u = 1.0 - 0.5 * (m2 * r);
  float p = 0.0171435025 * u - 0.0411506031;
  p = p * u + 0.0581835484;
  p = p * u - 0.022929858;
  p = p * u + 0.0380058068;
  p = p * u + 0.0546499364;
  p = p * u + 0.133568009;
  p = p * u + 0.333325868;
  return (p * u + 1.0) * r;
}

// Edge of the polygon: half its angle times the z of its unit normal (Heitz et al. 2016, eq. 11). The edges
// of a distant light nearly cancel: there a x b is taken as a x (b - a), which is exact for near vertices;
// beyond 90 degrees as a x (b + a), which vanishes with the divisor.
float ltcEdge(vec3 a, vec3 b) {
  vec3 m = a + b;
  float m2 = dot(m, m);
  vec2 e = vec2(b) + (m2 > 2.0 ? -1.0 : 1.0) * vec2(a);
  return (a.x * e.y - a.y * e.x) * ltcArc(m2);
}

// Direction of the horizon where the edge crosses it: of the two ends one is above, the other is not.
vec3 ltcHorizonPoint(vec3 a, vec3 b) {
  float t = abs(a.z) / max(abs(a.z) + abs(b.z), 1e-37);
  vec2 p = vec2(a) + (vec2(b) - vec2(a)) * t;
  return vec3(p * inversesqrt(max(dot(p, p), 1e-37)), 0.0);
}

// An outline on its way around a polygon, clipped at the horizon.
struct LtcOutline {
  float sum;
  vec3 leave;  // crossings down and up between which horizon is still to be added; edges to 0 are none
  vec3 enter;
  int crossings;  // how many of the two
};

LtcOutline ltcBegin() {
  LtcOutline outline;
  outline.sum = 0.0;
  outline.leave = vec3(0.0);
  outline.enter = vec3(0.0);
  outline.crossings = 0;
  return outline;
}

// Pieces of horizon close what is left above it, each from where the outline went down to where it next came
// up. Convex outlines have one, which waits for ltcEnd, so that all take the same way wherever they begin.
LtcOutline ltcAddEdge(LtcOutline outline, vec3 a, vec3 b) {
  bool aUp = a.z > 0.0;
  bool bUp = b.z > 0.0;
  if (aUp != bUp) {
    vec3 p = ltcHorizonPoint(a, b);
    bool full = outline.crossings == 2;
    if (full) outline.sum += ltcEdge(outline.leave, aUp ? outline.enter : p);
    outline.crossings = full ? 1 : outline.crossings + 1;
    if (aUp) {
      outline.leave = p;
      b = p;
    } else {
      if (!full) outline.enter = p;
      a = p;
    }
  }
  if (aUp || bUp) outline.sum += ltcEdge(a, b);
  return outline;
}

float ltcEnd(LtcOutline outline) {
  return (outline.sum + ltcEdge(outline.leave, outline.enter)) * 0.31830988618;  // 1 / pi
}

// Integral of the lobe over a quadrilateral light, exactly clipped at the horizon; vertices in the shading
// frame, relative to the shaded point. Positive where they run counterclockwise seen from above, that is
// clockwise as the shaded point sees them: max(0, .) for a light that emits from one side, abs() for both.
// Multiply by ltcFresnel and by the light's radiance. With inverse = mat3(1) it is the diffuse form factor.
// Never NaN for finite vertices; an edge through the shaded point itself has no plane, and what it adds (at
// most 1/2) has no meaning.
float ltcQuad(mat3 inverse, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
  vec3 a = ltcTransform(inverse, v0);
  vec3 b = ltcTransform(inverse, v1);
  vec3 c = ltcTransform(inverse, v2);
  vec3 d = ltcTransform(inverse, v3);
  if (max(max(a.z, b.z), max(c.z, d.z)) <= 0.0) return 0.0;
  if (min(min(a.z, b.z), min(c.z, d.z)) > 0.0)
    return (ltcEdge(a, b) + ltcEdge(b, c) + ltcEdge(c, d) + ltcEdge(d, a)) * 0.31830988618;  // 1 / pi
  LtcOutline outline = ltcAddEdge(ltcBegin(), a, b);
  outline = ltcAddEdge(outline, b, c);
  outline = ltcAddEdge(outline, c, d);
  return ltcEnd(ltcAddEdge(outline, d, a));
}

#ifndef LTC_MAX_VERTICES
#define LTC_MAX_VERTICES 8
#endif

// The same for a plane polygon of the first `count` vertices, convex or not, up to LTC_MAX_VERTICES.
float ltcPolygon(mat3 inverse, vec3 v[LTC_MAX_VERTICES], int count) {
  LtcOutline outline = ltcBegin();
  vec3 first = ltcTransform(inverse, v[0]);
  vec3 a = first;
  for (int i = 1; i < count; ++i) {
    vec3 b = ltcTransform(inverse, v[i]);
    outline = ltcAddEdge(outline, a, b);
    a = b;
  }
  return ltcEnd(ltcAddEdge(outline, a, first));
}

// Tests before anything is fetched, with vertices as above.

// Whether the shaded point lies on the side that a one-sided light emits to: where not, ltcQuad and
// ltcPolygon are not positive. v1 a corner where the outline is convex.
bool ltcFacing(vec3 v0, vec3 v1, vec3 v2) { return dot(v0, cross(v1 - v0, v2 - v0)) > 0.0; }

// Whether any part of a light is above the surface. A light below adds nothing in truth, but gets a little
// from the lobe, some of whose mass lies below the surface. Skipping it changes the value, for the better;
// but where a large light sets, its last light goes in one step: of 0.036 of its radiance at most for views
// at 85 degrees, 0.08 at 89, 0.21 at 90 (F = 1; roughness 0.2: 0.03 at 85, 0.07 at 89).
bool ltcAboveSurface(vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
  return max(max(v0.z, v1.z), max(v2.z, v3.z)) > 0.0;
}

// Reflectance by Schlick's Fresnel; f90 = vec3(1) where not known better.
vec3 ltcFresnel(LtcEntry entry, vec3 f0, vec3 f90) { return f0 * entry.norm + (f90 - f0) * entry.fresnel; }

#endif  // LTC_GLSL

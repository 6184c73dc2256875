// Shading with LTC tables: HLSL, shader model 4 and later. What is not called costs nothing, nor does
// including it again. ltc.glsl is the same for GLSL, function for function; why they are written so is said
// there.
//
// Vectors are columns: mul(M, v). Matrices are built of rows, float3x3(row0, row1, row2); how a compiler
// packs those of constant buffers plays no part.
//
// Isotropic table, two textures, from the header that `ltcfit export T.json --format h` writes (or any table
// of that layout); x = roughness, the square root of GGX's alpha, y = sqrt(1 - N.V):
//   matrix     R32G32B32A32_FLOAT or R16G16B16A16_FLOAT: (Minv00, Minv20, Minv02, Minv22) / Minv11
//   amplitude  R32G32_FLOAT or R16G16_FLOAT: (norm, fresnel)
// Anisotropic table, one 3D texture, R32G32B32A32_FLOAT or R16G16B16A16_FLOAT, nPhi x nTheta x 3 nAlpha
// nLambda, all axes linear over alpha = max(alphaX, alphaY), lambda = min / max, theta and phi of the view,
// 0 to 90 degrees:
//   texel (phi, theta, (row * nAlpha + alpha) * nLambda + lambda) = (M[row][0], M[row][1], M[row][2], e),
//   e = norm in row 0, fresnel in row 1, 0 in row 2; det M > 0
// `bilinear`: MIN_MAG_MIP_LINEAR with CLAMP in all directions. No mipmaps.

#ifndef LTC_HLSL
#define LTC_HLSL

struct LtcEntry {
  float3x3 inverse;  // takes directions of the shading frame to the clamped cosine; its scale has no meaning
  float norm;        // directional albedo for F = 1
  float fresnel;     // Schlick-weighted albedo
};

// World to shading frame, mul(frame, direction): z = n, x = v as far as it is perpendicular to n,
// y = cross(z, x). For ltcFetch v is the view vector; for ltcFetchAnisotropic the tangent that alphaX is
// measured along; no bitangent is needed. n and v unit.
float3x3 ltcFrame(float3 n, float3 v) {
  float3 t = v - n * dot(n, v);
  t -= n * dot(n, t);
  float length2 = dot(t, t);
  float3 up = abs(n.z) < 0.9 ? float3(0.0, 0.0, 1.0) : float3(1.0, 0.0, 0.0);
  t = length2 > 1e-12 ? t * rsqrt(length2) : normalize(cross(up, n));
  return float3x3(t, cross(n, t), n);
}

LtcEntry ltcFetch(Texture2D matrixTable, Texture2D amplitudeTable, SamplerState bilinear, float roughness,
                  float nDotV) {
  float2 size;
  matrixTable.GetDimensions(size.x, size.y);
  float2 uv = float2(saturate(roughness), sqrt(saturate(1.0 - nDotV)));
  uv = uv * (size - 1.0) / size + 0.5 / size;
  float4 t = matrixTable.SampleLevel(bilinear, uv, 0.0);
  float4 a = amplitudeTable.SampleLevel(bilinear, uv, 0.0);
  LtcEntry entry;
  entry.inverse = float3x3(float3(t.x, 0.0, t.z), float3(0.0, 1.0, 0.0), float3(t.y, 0.0, t.w));
  entry.norm = a.x;
  entry.fresnel = a.y;
  return entry;
}

// A row of M between two alphas, at w and w + next.
float4 ltcRow(Texture3D table, SamplerState bilinear, float2 uv, float w, float next, float f) {
  return lerp(table.SampleLevel(bilinear, float3(uv, w), 0.0),
              table.SampleLevel(bilinear, float3(uv, w + next), 0.0), f);
}

// The entry of M's interpolated rows, whose last components are norm and fresnel, for a view that `flip` mirrors
// into the first quadrant, and x and y swapped if `swapped`.
LtcEntry ltcEntryOfRows(float4 row0, float4 row1, float4 row2, bool swapped, float3 flip) {
  float3 m0 = swapped ? float3(row1.y, row1.x, row1.z) : float3(row0.x, row0.y, row0.z);
  float3 m1 = swapped ? float3(row0.y, row0.x, row0.z) : float3(row1.x, row1.y, row1.z);
  float3 m2 = swapped ? float3(row2.y, row2.x, row2.z) : float3(row2.x, row2.y, row2.z);
  m0 *= flip * flip.x;
  m1 *= flip * flip.y;
  m2 *= flip;

  // columns of det(M) times the inverse; where det(M) < 0 of the inverse with y flipped
  float3 c0 = cross(m1, m2);
  float3 c1 = cross(m2, m0);
  float3 c2 = cross(m0, m1);
  float3 largest = max(max(abs(c0), abs(c1)), abs(c2));
  float3 scale = float3(1.0, 1.0, 1.0) / max(max(max(largest.x, largest.y), largest.z), 1e-30);
  if (dot(m0, c0) < 0.0) scale *= float3(-1.0, 1.0, -1.0);
  LtcEntry entry;
  entry.inverse = transpose(float3x3(c0 * scale, c1 * scale, c2 * scale));
  entry.norm = row0.w;
  entry.fresnel = row1.w;
  return entry;
}

// `nodes` = (nAlpha, nLambda), which the size of the texture does not tell: int2(8, 8) for the default table.
// alphaX, alphaY: GGX's alpha along x and y, not its root, either may be the larger. `view` in the frame
// ltcFrame(normal, tangent), of any length; below the horizon it counts as at it.
LtcEntry ltcFetchAnisotropic(Texture3D table, SamplerState bilinear, int2 nodes, float alphaX, float alphaY,
                             float3 view) {
  float3 flip = float3(view.x < 0.0 ? -1.0 : 1.0, view.y < 0.0 ? -1.0 : 1.0, 1.0);
  bool swapped = alphaY > alphaX;
  float2 across = swapped ? abs(float2(view.y, view.x)) : abs(float2(view.x, view.y));

  float sine = length(across);
  float theta = atan2(sine, max(view.z, 1e-20));
  float phi = sine > 0.0 ? atan2(across.y, across.x) : 0.0;
  float alpha = saturate(max(alphaX, alphaY));
  float lambda = saturate(min(alphaX, alphaY) / max(max(alphaX, alphaY), 1e-20));

  float3 size;
  table.GetDimensions(size.x, size.y, size.z);
  float2 face = float2(size.x, size.y);
  float2 uv = (float2(phi, theta) * 0.63661977237 * (face - 1.0) + 0.5) / face;  // 2 / pi
  float rows = float(nodes.x);
  float columns = float(nodes.y);
  float a = alpha * (rows - 1.0);
  float a0 = min(floor(a), rows - 2.0);
  // stays inside the block of lambdas by what float32 coordinates may be off
  float inset = 3e-7 * size.z;
  float w = (a0 * columns + clamp(lambda * (columns - 1.0), inset, columns - 1.0 - inset) + 0.5) / size.z;
  float next = columns / size.z;
  float4 row0 = ltcRow(table, bilinear, uv, w, next, a - a0);
  float4 row1 = ltcRow(table, bilinear, uv, w + rows * next, next, a - a0);
  float4 row2 = ltcRow(table, bilinear, uv, w + 2.0 * rows * next, next, a - a0);
  return ltcEntryOfRows(row0, row1, row2, swapped, flip);
}

// A unit vector; lengths may be from 1e-14 to 1e14.
float3 ltcTransform(float3x3 inverse, float3 v) {
  float3 t = mul(inverse, v);
  return t * rsqrt(max(dot(t, t), 1e-37));
}

// half the angle between unit vectors over the length of their cross product, from |a + b|^2
float ltcArc(float m2) {
  float r = rsqrt(max(m2, 1e-37));
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

float ltcEdge(float3 a, float3 b) {
  float3 m = a + b;
  float m2 = dot(m, m);
  float2 e = float2(b.x, b.y) + (m2 > 2.0 ? -1.0 : 1.0) * float2(a.x, a.y);
  return (a.x * e.y - a.y * e.x) * ltcArc(m2);
}

float3 ltcHorizonPoint(float3 a, float3 b) {
  float t = abs(a.z) / max(abs(a.z) + abs(b.z), 1e-37);
  float2 p = float2(a.x, a.y) + (float2(b.x, b.y) - float2(a.x, a.y)) * t;
  return float3(p * rsqrt(max(dot(p, p), 1e-37)), 0.0);
}

struct LtcOutline {
  float sum;
  float3 leave;  // crossings down and up between which horizon is still to be added; edges to 0 are none
  float3 enter;
  int crossings;  // how many of the two
};

LtcOutline ltcBegin() {
  LtcOutline outline;
  outline.sum = 0.0;
  outline.leave = float3(0.0, 0.0, 0.0);
  outline.enter = float3(0.0, 0.0, 0.0);
  outline.crossings = 0;
  return outline;
}

LtcOutline ltcAddEdge(LtcOutline outline, float3 a, float3 b) {
  bool aUp = a.z > 0.0;
  bool bUp = b.z > 0.0;
  if (aUp != bUp) {
    float3 p = ltcHorizonPoint(a, b);
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
// With the unit matrix it is the diffuse form factor.
float ltcQuad(float3x3 inverse, float3 v0, float3 v1, float3 v2, float3 v3) {
  float3 a = ltcTransform(inverse, v0);
  float3 b = ltcTransform(inverse, v1);
  float3 c = ltcTransform(inverse, v2);
  float3 d = ltcTransform(inverse, v3);
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
float ltcPolygon(float3x3 inverse, float3 v[LTC_MAX_VERTICES], int count) {
  LtcOutline outline = ltcBegin();
  float3 first = ltcTransform(inverse, v[0]);
  float3 a = first;
  for (int i = 1; i < count; ++i) {
    float3 b = ltcTransform(inverse, v[i]);
    outline = ltcAddEdge(outline, a, b);
    a = b;
  }
  return ltcEnd(ltcAddEdge(outline, a, first));
}

// Tests before anything is fetched, with vertices as above: whether the shaded point lies on the side that a
// one-sided light emits to (v1 a corner where the outline is convex), and whether any part of a light is
// above the surface (what the lobe gives it otherwise is better left out, in a step of 0.08 of its
// radiance where a large light sets and the view is at 89 degrees).
bool ltcFacing(float3 v0, float3 v1, float3 v2) { return dot(v0, cross(v1 - v0, v2 - v0)) > 0.0; }
bool ltcAboveSurface(float3 v0, float3 v1, float3 v2, float3 v3) {
  return max(max(v0.z, v1.z), max(v2.z, v3.z)) > 0.0;
}

// Reflectance by Schlick's Fresnel; f90 = float3(1, 1, 1) where not known better.
float3 ltcFresnel(LtcEntry entry, float3 f0, float3 f90) {
  return f0 * entry.norm + (f90 - f0) * entry.fresnel;
}

#endif  // LTC_HLSL

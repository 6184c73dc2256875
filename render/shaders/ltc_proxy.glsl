// The shortcuts for horizon clipping that engines take: a polygon is replaced by the sphere of the same
// vector form factor (Hill and Heitz 2016). Include it after ltc.glsl, whose ltcQuad clips exactly, and which
// this is there to be compared with: for lights through the horizon a sphere is off by up to 0.14 of full
// irradiance.
//
// The vector form factor points to the light where the vertices run clockwise as the shaded point sees them
// (ltcFacing). Seen from behind it points away, and what the sphere makes of it means nothing: there a
// light that emits from one side counts 0, and one that emits from both takes -F. In that the sphere differs
// from ltcQuad, whose sign tells.

#ifndef LTC_PROXY_GLSL
#define LTC_PROXY_GLSL

// The edge's angle times its unit normal, halved as in ltcEdge.
vec3 ltcEdgeVector(vec3 a, vec3 b) {
  vec3 m = a + b;
  float m2 = dot(m, m);
  return cross(a, b + (m2 > 2.0 ? -1.0 : 1.0) * a) * ltcArc(m2);
}

// Vector form factor of a quadrilateral light in the cosine's configuration, without clipping; arguments as
// ltcQuad's. Its z is ltcQuad's value where all of the light is above the lobe's horizon.
vec3 ltcVectorFormFactor(mat3 inverse, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
  vec3 a = ltcTransform(inverse, v0);
  vec3 b = ltcTransform(inverse, v1);
  vec3 c = ltcTransform(inverse, v2);
  vec3 d = ltcTransform(inverse, v3);
  return (ltcEdgeVector(a, b) + ltcEdgeVector(b, c) + ltcEdgeVector(c, d) + ltcEdgeVector(d, a)) *
         0.31830988618;  // 1 / pi
}

// Form factor of the sphere with vector form factor f, clipped at the horizon, by a closed fit.
float ltcProxySphere(vec3 f) {
  float length2 = dot(f, f);
  return max(0.0, (length2 + f.z) / (sqrt(length2) + 1.0));
}

// The same by a table: w of the second texture of engines' layout, (norm, fresnel, 0, sphere), RGBA32F or
// RGBA16F with linear filtering and clamped to the edge, x = (cosine of f with the normal + 1) / 2,
// y = length of f, of the form factor over that length.
float ltcProxySphereTable(sampler2D sphereTable, vec3 f) {
  float size = float(textureSize(sphereTable, 0).x);
  float l = sqrt(dot(f, f));
  vec2 uv = vec2(f.z / max(l, 1e-30) * 0.5 + 0.5, l);
  return textureLod(sphereTable, uv * ((size - 1.0) / size) + 0.5 / size, 0.0).w * l;
}

#endif  // LTC_PROXY_GLSL

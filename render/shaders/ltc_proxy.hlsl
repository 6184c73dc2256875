// Horizon clipping by a sphere of the same vector form factor: ltc_proxy.glsl for HLSL, function for
// function; what it is good for, and how lights seen from behind are treated, is said there. Include it after
// ltc.hlsl.

#ifndef LTC_PROXY_HLSL
#define LTC_PROXY_HLSL

float3 ltcEdgeVector(float3 a, float3 b) {
  float3 m = a + b;
  float m2 = dot(m, m);
  return cross(a, b + (m2 > 2.0 ? -1.0 : 1.0) * a) * ltcArc(m2);
}

// Vector form factor of a quadrilateral light in the cosine's configuration, without clipping; arguments as
// ltcQuad's.
float3 ltcVectorFormFactor(float3x3 inverse, float3 v0, float3 v1, float3 v2, float3 v3) {
  float3 a = ltcTransform(inverse, v0);
  float3 b = ltcTransform(inverse, v1);
  float3 c = ltcTransform(inverse, v2);
  float3 d = ltcTransform(inverse, v3);
  return (ltcEdgeVector(a, b) + ltcEdgeVector(b, c) + ltcEdgeVector(c, d) + ltcEdgeVector(d, a)) *
         0.31830988618;  // 1 / pi
}

// Form factor of the sphere with vector form factor f, clipped at the horizon, by a closed fit.
float ltcProxySphere(float3 f) {
  float length2 = dot(f, f);
  return max(0.0, (length2 + f.z) / (sqrt(length2) + 1.0));
}

// The same by w of the second texture of engines' layout, (norm, fresnel, 0, sphere).
float ltcProxySphereTable(Texture2D sphereTable, SamplerState bilinear, float3 f) {
  float2 size;
  sphereTable.GetDimensions(size.x, size.y);
  float l = sqrt(dot(f, f));
  float2 uv = float2(f.z / max(l, 1e-30) * 0.5 + 0.5, l);
  uv = uv * ((size - 1.0) / size) + 0.5 / size;
  return sphereTable.SampleLevel(bilinear, uv, 0.0).w * l;
}

#endif  // LTC_PROXY_HLSL

// Textured rectangular lights: include it after ltc.hlsl. ltc_textured.glsl is the same for GLSL; why it is
// written so is said there.
//
// The texture is what `ltcfit prefilter PICTURE -o T.dds` writes: mip maps, R16G16B16A16_FLOAT or
// R32G32B32A32_FLOAT. `trilinear`: MIN_MAG_MIP_LINEAR with CLAMP in both directions. `margin` and `lodScale`
// are told by the file beside it (and printed by the command).
//
//   float3 colour = ltcLightColour(entry.inverse, v0, v1, v2, v3, picture, trilinear, margin, lodScale);
//   light = max(0.0, ltcQuad(entry.inverse, v0, v1, v2, v3)) * ltcFresnel(..) * colour;

#ifndef LTC_TEXTURED_HLSL
#define LTC_TEXTURED_HLSL

// The mean colour of the light under the lobe; texture coordinates (0, 0), (1, 0), (1, 1), (0, 1) at v0 to
// v3, v = 0 is the picture's top row. Never NaN for finite vertices.
float3 ltcLightColour(float3x3 inverse, float3 v0, float3 v1, float3 v2, float3 v3, Texture2D picture,
                      SamplerState trilinear, float margin, float lodScale) {
  float3 largest = max(max(abs(v0), abs(v1)), max(abs(v2), abs(v3)));
  float unit = 1.0 / max(max(max(largest.x, largest.y), largest.z), 1e-37);
  largest = max(max(abs(inverse[0]), abs(inverse[1])), abs(inverse[2]));
  float3x3 m = inverse * (1.0 / max(max(max(largest.x, largest.y), largest.z), 1e-37));
  float3 diagonal1 = mul(m, (v2 - v0) * unit);
  float3 diagonal2 = mul(m, (v3 - v1) * unit);
  float3 side1 = 0.5 * (diagonal1 - diagonal2);
  float3 side2 = 0.5 * (diagonal1 + diagonal2);
  largest = max(abs(side1), abs(side2));
  float scale = 1.0 / max(max(max(largest.x, largest.y), largest.z), 1e-30);
  side1 *= scale;
  side2 *= scale;
  float3 centre = mul(m, (v0 * unit + v1 * unit + v2 * unit + v3 * unit) * 0.25);
  float3 q = clamp(centre * -scale, -1e9, 1e9);

  float3 normal = cross(side1, side2);
  float area2 = max(dot(normal, normal), 1e-20);
  float2 uv = float2(dot(cross(q, side2), normal), dot(cross(side1, q), normal)) / area2 + 0.5;
  float away = min(abs(dot(q, normal)) / area2, 1e9);
  float variance = max(0.5 * away * away * sqrt(area2), 1e-12);
  float lod = 0.5 * log2(variance) + log2(lodScale);
  return picture.SampleLevel(trilinear, (uv + margin) / (1.0 + 2.0 * margin), lod).rgb;
}

#endif  // LTC_TEXTURED_HLSL

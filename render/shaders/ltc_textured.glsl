// Textured rectangular lights: include it after ltc.glsl. ltc_textured.hlsl is the same for HLSL.
//
// The texture is what `ltcfit prefilter PICTURE -o T.ktx2` writes: mip maps, RGBA16F or RGBA32F, to be read
// with trilinear filtering, clamped to the edge. `margin` and `lodScale` are told by the file (and printed by
// the command): the picture covers the middle 1 / (1 + 2 margin) of the texture's sides.
//
//   vec3 colour = ltcLightColour(entry.inverse, v0, v1, v2, v3, picture, margin, lodScale);
//   light = max(0.0, ltcQuad(entry.inverse, v0, v1, v2, v3)) * ltcFresnel(..) * colour;

#ifndef LTC_TEXTURED_GLSL
#define LTC_TEXTURED_GLSL

// The mean colour of the light under the lobe (Heitz et al. 2016, section 5.4). `inverse` and the vertices as
// for ltcQuad; texture coordinates (0, 0), (1, 0), (1, 1), (0, 1) at v0 to v3, v = 0 is the picture's top row.
// A parallelogram; of another plane quadrilateral the parallelogram nearest to it. For inverse = mat3(1) the
// colour of the diffuse part. Never NaN for finite vertices.
vec3 ltcLightColour(mat3 inverse, vec3 v0, vec3 v1, vec3 v2, vec3 v3, sampler2D picture, float margin,
                    float lodScale) {
  // only ratios of lengths have a meaning: scaled first, nothing overflows
  vec3 largest = max(max(abs(v0), abs(v1)), max(abs(v2), abs(v3)));
  float unit = 1.0 / max(max(max(largest.x, largest.y), largest.z), 1e-37);
  largest = max(max(abs(inverse[0]), abs(inverse[1])), abs(inverse[2]));
  mat3 m = inverse / max(max(max(largest.x, largest.y), largest.z), 1e-37);
  vec3 diagonal1 = m * ((v2 - v0) * unit);
  vec3 diagonal2 = m * ((v3 - v1) * unit);
  vec3 side1 = 0.5 * (diagonal1 - diagonal2);
  vec3 side2 = 0.5 * (diagonal1 + diagonal2);
  largest = max(abs(side1), abs(side2));
  float scale = 1.0 / max(max(max(largest.x, largest.y), largest.z), 1e-30);
  side1 *= scale;
  side2 *= scale;
  vec3 centre = m * ((v0 * unit + v1 * unit + v2 * unit + v3 * unit) * 0.25);
  vec3 q = clamp(centre * -scale, -1e9, 1e9);

  // the origin projected onto the light's plane, in the basis of its sides, which are not perpendicular here
  vec3 normal = cross(side1, side2);
  float area2 = max(dot(normal, normal), 1e-20);
  vec2 uv = vec2(dot(cross(q, side2), normal), dot(cross(side1, q), normal)) / area2 + 0.5;
  // sigma = sqrt(r^2 / (2 A)), r the distance of the plane, A the area
  float away = min(abs(dot(q, normal)) / area2, 1e9);
  float variance = max(0.5 * away * away * sqrt(area2), 1e-12);
  float lod = 0.5 * log2(variance) + log2(lodScale);
  return textureLod(picture, (uv + margin) / (1.0 + 2.0 * margin), lod).rgb;
}

#endif  // LTC_TEXTURED_GLSL

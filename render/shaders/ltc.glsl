// Shading with the isotropic LTC table: GLSL 3.30 and later, ES 3.00 and later. Include it after your #version line.
//
// Textures, from the header that `ltcfit export T.json --format h` writes (or any table of that layout):
//   matrix     RGBA32F or RGBA16F: (Minv00, Minv20, Minv02, Minv22) / Minv11     x = roughness, y = sqrt(1 - N.V)
//   amplitude  RG32F or RG16F: (norm, fresnel)
// both with linear filtering, clamped to the edge. Roughness is the square root of GGX's alpha.

#ifdef GL_ES
precision highp float;
precision highp sampler2D;
#endif

struct LtcEntry {
  mat3 inverse;   // takes directions of the frame below to the clamped cosine
  float norm;     // directional albedo for F = 1
  float fresnel;  // Schlick-weighted albedo
};

// World to shading frame: z = normal, view in the x-z plane with x >= 0. N and V unit.
mat3 ltcFrame(vec3 n, vec3 v) {
  vec3 t = v - n * dot(n, v);
  float length2 = dot(t, t);
  // straight from above every frame about the normal will do
  vec3 up = abs(n.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  t = length2 > 1e-8 ? t * inversesqrt(length2) : normalize(cross(up, n));
  return transpose(mat3(t, cross(n, t), n));
}

LtcEntry ltcFetch(sampler2D matrixTable, sampler2D amplitudeTable, float roughness, float nDotV) {
  vec2 size = vec2(textureSize(matrixTable, 0));
  vec2 uv = vec2(clamp(roughness, 0.0, 1.0), sqrt(clamp(1.0 - nDotV, 0.0, 1.0)));
  uv = uv * (size - 1.0) / size + 0.5 / size;
  vec4 t = texture(matrixTable, uv);
  vec2 a = texture(amplitudeTable, uv).xy;
  // columns of the matrix
  return LtcEntry(mat3(vec3(t.x, 0.0, t.y), vec3(0.0, 1.0, 0.0), vec3(t.z, 0.0, t.w)), a.x, a.y);
}

// Edge of the polygon: its angle times the z of its unit normal (Heitz et al. 2016, eq. 11). atan of two arguments
// keeps its digits for edges of every length, where acos does not.
float ltcEdge(vec3 a, vec3 b) {
  vec3 c = cross(a, b);
  float s = length(c);
  return s > 0.0 ? c.z * atan(s, dot(a, b)) / s : 0.0;
}

vec3 ltcHorizonPoint(vec3 a, vec3 b) { return vec3((a.xy * b.z - b.xy * a.z) / (b.z - a.z), 0.0); }

// Integral of the lobe over a quadrilateral light, exactly clipped at the horizon; vertices in the shading frame,
// relative to the shaded point. Positive where they run counterclockwise seen from above: max(0, .) for a light
// that emits from one side, abs() for both. Multiply by ltcFresnel and by the light's radiance. With
// inverse = mat3(1) it is the diffuse form factor.
float ltcQuad(mat3 inverse, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
  vec3 v[4] = vec3[4](normalize(inverse * v0), normalize(inverse * v1), normalize(inverse * v2),
                      normalize(inverse * v3));
  float sum = 0.0;
  vec3 leave = vec3(0.0);  // where the outline last went below the horizon
  vec3 enter = vec3(0.0);  // where it first came up, when it began below
  bool left = false;
  bool pending = false;
  for (int i = 0; i < 4; ++i) {
    vec3 a = v[i];
    vec3 b = v[(i + 1) & 3];
    if (a.z > 0.0 && b.z > 0.0) {
      sum += ltcEdge(a, b);
    } else if (a.z > 0.0) {
      leave = ltcHorizonPoint(a, b);
      left = true;
      sum += ltcEdge(a, leave);
    } else if (b.z > 0.0) {
      vec3 up = ltcHorizonPoint(a, b);
      if (left) {
        sum += ltcEdge(leave, up);
      } else {
        enter = up;
        pending = true;
      }
      sum += ltcEdge(up, b);
    }
  }
  if (pending) sum += ltcEdge(leave, enter);
  return sum * 0.15915494309;  // 1 / (2 pi)
}

// Reflectance by Schlick's Fresnel; f90 = vec3(1) where not known better.
vec3 ltcFresnel(LtcEntry entry, vec3 f0, vec3 f90) { return f0 * entry.norm + (f90 - f0) * entry.fresnel; }

// Fragment shader of the shading check: what render/scene.cpp sees in a pixel, shaded with the functions of
// ltc.glsl and ltc_textured.glsl, whose text stands before this one. What a scene does not need is not
// compiled; defined before:
//   SURFACES, LIGHTS  how many there are; LTC_MAX_VERTICES: of the light that has most
//   RECTANGLES, SPHERES, RAMPS  surfaces of that kind, materials with a ramp
//   FRESNEL, DIFFUSE  some f0 below 1, some base that is not black
//   QUADS, POLYGONS  lights of four vertices, lights of others
//   ONE_SIDED, TWO_SIDED  lights that emit so
//   TEXTURES  how many textures there are, 1 to 4, where a light has one
//   LTC_NODES  an anisotropic table, of (nAlpha, nLambda); without it an isotropic one
//   LTC_LOOKUP  the call of the table's own look-up, whose text stands behind ltc.glsl; without it, ltc.glsl's
//   DISPLAY  colours for a screen, sRGB, instead of radiance
#ifdef GL_ES
precision highp int;
#endif

struct Surface {
  vec3 centre;
  vec3 normal;     // of a rectangle
  vec3 tangent;    // of a rectangle; of a sphere the axis
  vec3 bitangent;  // of a rectangle
  vec2 halfSize;   // of a rectangle
  float radius;    // 0 for a rectangle
  vec2 roughness;  // roots of alpha along the tangent and across it
  vec2 roughnessEnd;
  vec2 turn;  // cosine and sine of the tangent's rotation
  float f0;
  float diffuse;
};
struct Light {
  vec3 normal;  // unit; vertices run counterclockwise seen from where it points to
  vec3 radiance;
  int vertices;
  ivec2 plane;  // the axes of the projection in which its outline is tested
  bool twoSided;
  int texture;  // -1: none
};

uniform Surface surfaces[SURFACES];
uniform Light lights[LIGHTS];
uniform vec3 lightVertices[LIGHTS * LTC_MAX_VERTICES];
uniform vec3 cameraPosition;
uniform vec3 cameraForward;
uniform vec3 cameraRight;  // to the right edge of the picture at distance 1
uniform vec3 cameraUp;
uniform vec2 pictureSize;
#ifdef LTC_NODES
uniform sampler3D lobes;
#else
uniform sampler2D matrixTable;
uniform sampler2D amplitudeTable;
#endif

#ifdef TEXTURES
uniform sampler2D pictures[TEXTURES];
uniform vec2 pictureFetch[TEXTURES];  // margin, lodScale
#endif

out vec4 picture;  // w: 0 background, 1 light, 2 surface

const float kFar = 1e30;

float hitRectangle(Surface s, vec3 direction) {
  float towards = dot(direction, s.normal);
  if (towards >= 0.0) return kFar;
  float t = dot(s.centre - cameraPosition, s.normal) / towards;
  vec3 from = cameraPosition + t * direction - s.centre;
  vec2 along = abs(vec2(dot(from, s.tangent), dot(from, s.bitangent)));
  return t > 0.0 && along.x <= s.halfSize.x && along.y <= s.halfSize.y ? t : kFar;
}

float hitSphere(Surface s, vec3 direction) {
  vec3 from = cameraPosition - s.centre;
  float b = dot(from, direction);
  vec3 apart = from - b * direction;
  float under = s.radius * s.radius - dot(apart, apart);
  if (under <= 0.0) return kFar;
  float t = -b - sqrt(under);
  return t > 0.0 ? t : kFar;
}

float hitLight(int light, vec3 direction) {
  Light l = lights[light];
  int first = light * LTC_MAX_VERTICES;
  float towards = dot(direction, l.normal);
  if (towards == 0.0) return kFar;
  float t = dot(lightVertices[first] - cameraPosition, l.normal) / towards;
  if (t <= 0.0) return kFar;
  vec3 p = cameraPosition + t * direction;
  vec2 at = vec2(p[l.plane.x], p[l.plane.y]);
  bool inside = false;
  vec3 v = lightVertices[first + l.vertices - 1];
  vec2 from = vec2(v[l.plane.x], v[l.plane.y]);
  for (int i = 0; i < l.vertices; ++i) {
    v = lightVertices[first + i];
    vec2 to = vec2(v[l.plane.x], v[l.plane.y]);
    if ((from.y > at.y) != (to.y > at.y)) {
      float crossing = from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x);
      if (at.x < crossing) inside = !inside;
    }
    from = to;
  }
  return inside ? t : kFar;
}

// The light as the lobe of `inverse` receives it: form factor, not negative. Vertices in the shading frame.
float received(int light, mat3 inverse, vec3 v[LTC_MAX_VERTICES]) {
  float sum;
#if defined(QUADS) && defined(POLYGONS)
  if (lights[light].vertices == 4)
    sum = ltcQuad(inverse, v[0], v[1], v[2], v[3]);
  else
    sum = ltcPolygon(inverse, v, lights[light].vertices);
#elif defined(QUADS)
  sum = ltcQuad(inverse, v[0], v[1], v[2], v[3]);
#else
  sum = ltcPolygon(inverse, v, lights[light].vertices);
#endif
#if defined(ONE_SIDED) && defined(TWO_SIDED)
  return lights[light].twoSided ? abs(sum) : max(0.0, sum);
#elif defined(TWO_SIDED)
  return abs(sum);
#else
  return max(0.0, sum);
#endif
}

// What multiplies the light's radiance under the lobe of `inverse`.
vec3 colourOf(int light, mat3 inverse, vec3 v[LTC_MAX_VERTICES]) {
#ifdef TEXTURES
  // an array of samplers takes constants only
#define COLOUR_OF(i)             \
  if (lights[light].texture == i) \
    return ltcLightColour(inverse, v[0], v[1], v[2], v[3], pictures[i], pictureFetch[i].x, pictureFetch[i].y);
  COLOUR_OF(0)
#if TEXTURES > 1
  COLOUR_OF(1)
#endif
#if TEXTURES > 2
  COLOUR_OF(2)
#endif
#if TEXTURES > 3
  COLOUR_OF(3)
#endif
#endif
  return vec3(1.0);
}

// What multiplies the light's radiance where it is seen directly.
vec3 colourAt(int light, vec3 position) {
#ifdef TEXTURES
  int first = light * LTC_MAX_VERTICES;
  vec3 from = position - lightVertices[first];
  vec3 right = lightVertices[first + 1] - lightVertices[first];
  vec3 down = lightVertices[first + 3] - lightVertices[first];
  vec2 uv = vec2(dot(from, right) / dot(right, right), dot(from, down) / dot(down, down));
#define COLOUR_AT(i)              \
  if (lights[light].texture == i) \
    return textureLod(pictures[i], (uv + pictureFetch[i].x) / (1.0 + 2.0 * pictureFetch[i].x), 0.0).rgb;
  COLOUR_AT(0)
#if TEXTURES > 1
  COLOUR_AT(1)
#endif
#if TEXTURES > 2
  COLOUR_AT(2)
#endif
#if TEXTURES > 3
  COLOUR_AT(3)
#endif
#endif
  return vec3(1.0);
}

// Whether a light emits towards the point.
bool isLit(int light, vec3 position) {
  bool lit = dot(position - lightVertices[light * LTC_MAX_VERTICES], lights[light].normal) < 0.0;
#ifdef TWO_SIDED
  lit = lit || lights[light].twoSided;
#endif
  return lit;
}

vec3 shade(Surface s, vec3 position, vec3 view) {
  vec3 n = s.normal;
#ifdef SPHERES
  if (s.radius > 0.0) n = normalize(position - s.centre);
#endif
  vec2 roughness = s.roughness;
#ifdef RAMPS
  if (s.roughnessEnd.x > 0.0) {
    float along = 0.5 + 0.5 * dot(position - s.centre, s.tangent) / s.halfSize.x;
    roughness = mix(roughness, s.roughnessEnd, along);
  }
#endif

#ifdef LTC_NODES
  vec3 tangent = s.tangent;
#ifdef SPHERES
  // at the poles, where this is 0, any frame will do: ltcFrame takes one
  if (s.radius > 0.0) tangent = cross(s.tangent, n);
#endif
  mat3 frame = ltcFrame(n, s.turn.x * tangent + s.turn.y * cross(n, tangent));
#else
  mat3 frame = ltcFrame(n, view);
#endif
#if defined(LTC_LOOKUP)
  LtcEntry entry = LTC_LOOKUP;
#elif defined(LTC_NODES)
  LtcEntry entry = ltcFetchAnisotropic(lobes, LTC_NODES, roughness.x * roughness.x, roughness.y * roughness.y,
                                       frame * view);
#else
  LtcEntry entry = ltcFetch(matrixTable, amplitudeTable, roughness.x, dot(n, view));
#endif

#ifdef FRESNEL
  float reflectance = ltcFresnel(entry, vec3(s.f0), vec3(1.0)).x;
#else
  float reflectance = entry.norm;
#endif
  vec3 sum = vec3(0.0);
  for (int light = 0; light < LIGHTS; ++light) {
    if (!isLit(light, position)) continue;
    vec3 v[LTC_MAX_VERTICES];
    float highest = 0.0;
    for (int i = 0; i < lights[light].vertices; ++i) {
      v[i] = frame * (lightVertices[light * LTC_MAX_VERTICES + i] - position);
      highest = max(highest, v[i].z);
    }
    if (highest <= 0.0) continue;  // as ltcAboveSurface, for any polygon
    vec3 value = reflectance * received(light, entry.inverse, v) * colourOf(light, entry.inverse, v);
#ifdef DIFFUSE
    value += s.diffuse * received(light, mat3(1.0), v) * colourOf(light, mat3(1.0), v);
#endif
    sum += value * lights[light].radiance;
  }
  return sum;
}

void main() {
  vec2 at = 2.0 * gl_FragCoord.xy / pictureSize - 1.0;
  vec3 direction = normalize(cameraForward + at.x * cameraRight + at.y * cameraUp);
  float nearest = kFar;
  int hit = -1;
  for (int i = 0; i < SURFACES; ++i) {
#if defined(RECTANGLES) && defined(SPHERES)
    bool isSphere = surfaces[i].radius > 0.0;
    float t = isSphere ? hitSphere(surfaces[i], direction) : hitRectangle(surfaces[i], direction);
#elif defined(SPHERES)
    float t = hitSphere(surfaces[i], direction);
#else
    float t = hitRectangle(surfaces[i], direction);
#endif
    if (t < nearest) {
      nearest = t;
      hit = i;
    }
  }
  picture = vec4(0.0);
  for (int i = 0; i < LIGHTS; ++i) {
    float t = hitLight(i, direction);
    if (t < nearest) {
      nearest = t;
      picture = vec4(lights[i].radiance * colourAt(i, cameraPosition + t * direction), 1.0);
    }
  }
  if (hit >= 0 && picture.w == 0.0)
    picture = vec4(shade(surfaces[hit], cameraPosition + nearest * direction, -direction), 2.0);
#ifdef DISPLAY
  vec3 colour = clamp(picture.rgb, 0.0, 1.0);
  vec3 above = 1.055 * pow(colour, vec3(1.0 / 2.4)) - 0.055;
  picture = vec4(mix(12.92 * colour, above, greaterThan(colour, vec3(0.0031308))), 1.0);
#endif
}

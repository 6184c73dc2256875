# The shader snippets compile: GLSL 3.30 and ES 3.00, HLSL to valid SPIR-V; isotropic, anisotropic, by
# proxy spheres, polynomials, and all together; and the generated look-ups of single tables.
validator=$1
spirv_val=$2  # empty: the SPIR-V is not checked
shaders=$3
lookups=$4  # NAME.glsl and NAME.hlsl, whole but for the files of $3
data=$5  # where ltc_iso.cheb.glsl and .hlsl lie
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

glsl_head='uniform sampler2D matrixTable;
uniform sampler2D amplitudeTable;
uniform sampler3D lobes;
uniform sampler2D spheres;
uniform sampler2D picture;
uniform vec3 corners[LTC_MAX_VERTICES];
uniform vec4 shape[ltc_iso_rows];
uniform vec2 amplitude[ltc_iso_rows];
in vec3 position;
in vec3 normal;
in vec3 tangent;
in vec3 view;
out vec4 colour;
float quad(mat3 inverse, mat3 frame) {
  return ltcQuad(inverse, frame * (corners[0] - position), frame * (corners[1] - position),
                 frame * (corners[2] - position), frame * (corners[3] - position));
}
'
glsl_isotropic='LtcEntry entry = ltcFetch(matrixTable, amplitudeTable, 0.4, dot(normal, view));
  mat3 frame = ltcFrame(normal, view);
  colour.rgb += abs(quad(entry.inverse, frame)) * ltcFresnel(entry, vec3(0.04), vec3(1.0));
  colour.rgb += abs(quad(mat3(1.0), frame));
'
glsl_anisotropic='mat3 along = ltcFrame(normal, tangent);
  LtcEntry brushed = ltcFetchAnisotropic(lobes, ivec2(8), 0.5, 0.1, along * view);
  colour.rgb += abs(quad(brushed.inverse, along)) * ltcFresnel(brushed, vec3(0.9), vec3(1.0));
  vec3 local[LTC_MAX_VERTICES];
  for (int i = 0; i < LTC_MAX_VERTICES; ++i) local[i] = along * (corners[i] - position);
  colour.a = ltcPolygon(brushed.inverse, local, 5);
'
glsl_proxy='LtcEntry fitted = ltcFetch(matrixTable, amplitudeTable, 0.2, dot(normal, view));
  mat3 facing = ltcFrame(normal, view);
  vec3 a = facing * (corners[0] - position);
  vec3 b = facing * (corners[1] - position);
  vec3 c = facing * (corners[2] - position);
  vec3 d = facing * (corners[3] - position);
  if (ltcFacing(a, b, c) && ltcAboveSurface(a, b, c, d)) {
    vec3 f = ltcVectorFormFactor(fitted.inverse, a, b, c, d);
    colour.rg += vec2(ltcProxySphere(f), ltcProxySphereTable(spheres, f));
  }
'
glsl_textured='LtcEntry lobe = ltcFetch(matrixTable, amplitudeTable, 0.4, dot(normal, view));
  mat3 around = ltcFrame(normal, view);
  colour.rgb += ltcLightColour(lobe.inverse, around * (corners[0] - position), around * (corners[1] - position),
                               around * (corners[2] - position), around * (corners[3] - position), picture, 0.5,
                               512.0);
'
glsl_polynomials='LtcEntry even = ltc_iso_fetch(0.3, dot(normal, view));
  LtcEntry rough = ltc_iso_fetchCollapsed(shape, amplitude, 0.8, dot(normal, view));
  colour.rgb += abs(quad(even.inverse, ltcFrame(normal, view))) * ltcFresnel(rough, vec3(0.04), vec3(1.0));
'
hlsl_head='Texture2D matrixTable;
Texture2D amplitudeTable;
Texture3D lobes;
Texture2D spheres;
Texture2D picture;
SamplerState bilinear;
cbuffer Light { float4 corners[LTC_MAX_VERTICES]; float4 shape[ltc_iso_rows]; float2 amplitude[ltc_iso_rows]; };
struct Surface { float3 position : P; float3 normal : N; float3 tangent : T; float3 view : V; };
float quad(float3x3 inverse, float3x3 frame, float3 position) {
  return ltcQuad(inverse, mul(frame, corners[0].xyz - position), mul(frame, corners[1].xyz - position),
                 mul(frame, corners[2].xyz - position), mul(frame, corners[3].xyz - position));
}
'
hlsl_isotropic='LtcEntry entry = ltcFetch(matrixTable, amplitudeTable, bilinear, 0.4, dot(s.normal, s.view));
  float3x3 frame = ltcFrame(s.normal, s.view);
  float3x3 cosine = float3x3(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  colour.rgb += abs(quad(entry.inverse, frame, s.position)) * ltcFresnel(entry, (float3)0.04, (float3)1.0);
  colour.rgb += abs(quad(cosine, frame, s.position));
'
hlsl_anisotropic='float3x3 along = ltcFrame(s.normal, s.tangent);
  LtcEntry brushed = ltcFetchAnisotropic(lobes, bilinear, int2(8, 8), 0.5, 0.1, mul(along, s.view));
  colour.rgb += abs(quad(brushed.inverse, along, s.position)) * ltcFresnel(brushed, (float3)0.9, (float3)1.0);
  float3 local[LTC_MAX_VERTICES];
  for (int i = 0; i < LTC_MAX_VERTICES; ++i) local[i] = mul(along, corners[i].xyz - s.position);
  colour.a = ltcPolygon(brushed.inverse, local, 5);
'
hlsl_proxy='LtcEntry fitted = ltcFetch(matrixTable, amplitudeTable, bilinear, 0.2, dot(s.normal, s.view));
  float3x3 facing = ltcFrame(s.normal, s.view);
  float3 a = mul(facing, corners[0].xyz - s.position);
  float3 b = mul(facing, corners[1].xyz - s.position);
  float3 c = mul(facing, corners[2].xyz - s.position);
  float3 d = mul(facing, corners[3].xyz - s.position);
  if (ltcFacing(a, b, c) && ltcAboveSurface(a, b, c, d)) {
    float3 f = ltcVectorFormFactor(fitted.inverse, a, b, c, d);
    colour.rg += float2(ltcProxySphere(f), ltcProxySphereTable(spheres, bilinear, f));
  }
'
hlsl_textured='LtcEntry lobe = ltcFetch(matrixTable, amplitudeTable, bilinear, 0.4, dot(s.normal, s.view));
  float3x3 around = ltcFrame(s.normal, s.view);
  colour.rgb += ltcLightColour(lobe.inverse, mul(around, corners[0].xyz - s.position),
                               mul(around, corners[1].xyz - s.position), mul(around, corners[2].xyz - s.position),
                               mul(around, corners[3].xyz - s.position), picture, bilinear, 0.5, 512.0);
'
hlsl_polynomials='LtcEntry even = ltc_iso_fetch(0.3, dot(s.normal, s.view));
  LtcEntry rough = ltc_iso_fetchCollapsed(shape, amplitude, 0.8, dot(s.normal, s.view));
  colour.rgb += abs(quad(even.inverse, ltcFrame(s.normal, s.view), s.position)) *
                ltcFresnel(rough, (float3)0.04, (float3)1.0);
'

# glsl VERSION BODY, hlsl BODY: whether a fragment shader with that body compiles; what is said goes to log.
# The files are included once, or `times`.
times=1
include() {
  local i file
  for ((i = 0; i < times; ++i)); do
    for file in "$shaders"/{ltc,ltc_proxy,ltc_textured} "$data/ltc_iso.cheb"; do cat "$file.$1" || exit 1; done
  done
}
glsl() {
  {
    echo "#version $1"
    include glsl
    echo "$glsl_head void main() { colour = vec4(0.0); $2 }"
  } > "$work/test.frag"
  "$validator" "$work/test.frag" > "$work/log" 2>&1
}
hlsl() {
  {
    include hlsl
    echo "$hlsl_head float4 main(Surface s) : SV_Target { float4 colour = (float4)0.0; $1 return colour; }"
  } > "$work/test.hlsl"
  "$validator" -D -V -S frag -e main -o "$work/test.spv" "$work/test.hlsl" > "$work/log" 2>&1 || return 1
  if [ -n "$spirv_val" ]; then "$spirv_val" "$work/test.spv" >> "$work/log" 2>&1; fi
}
fail() {
  echo "$1"
  cat "$work/log"
  exit 1
}

for version in "330 core" "300 es"; do
  for body in "$glsl_isotropic" "$glsl_anisotropic" "$glsl_proxy" "$glsl_textured" "$glsl_polynomials" \
    "$glsl_isotropic $glsl_anisotropic $glsl_proxy $glsl_polynomials"; do
    glsl "$version" "$body" || fail "GLSL $version does not compile"
  done
  # without these two the above would prove nothing
  glsl "$version" "LtcEntry e = ltcFetch(lobes, 0.4, 1.0);" && fail "GLSL $version: a wrong call compiles"
  glsl "$version" "colour.rgb = ltcLightColour(mat3(1.0), view, view, view, view, lobes, 0.5, 1.0);" && fail \
    "GLSL $version: a wrong texture compiles"
  glsl "$version" "colour = ltcFrame(normal, view);" && fail "GLSL $version: a wrong type compiles"
done
for body in "$hlsl_isotropic" "$hlsl_anisotropic" "$hlsl_proxy" "$hlsl_textured" "$hlsl_polynomials" \
  "$hlsl_isotropic $hlsl_anisotropic $hlsl_proxy $hlsl_polynomials"; do
  hlsl "$body" || fail "HLSL does not compile"
done
hlsl "LtcEntry e = ltcFetch(matrixTable, 0.4, 1.0);" && fail "HLSL: a wrong call compiles"
hlsl "colour = ltcFrame(s.normal, s.view);" && fail "HLSL: a wrong type compiles"
times=2
glsl "330 core" "$glsl_isotropic $glsl_proxy $glsl_textured $glsl_polynomials" || fail "GLSL 330 core, included twice, does not compile"
glsl "300 es" "$glsl_isotropic $glsl_proxy $glsl_textured $glsl_polynomials" || fail "GLSL 300 es, included twice, does not compile"
hlsl "$hlsl_isotropic $hlsl_proxy $hlsl_textured $hlsl_polynomials" || fail "HLSL, included twice, does not compile"
count=0
for file in "$lookups"/*.glsl; do
  name=${file%.glsl}
  for version in "330 core" "300 es"; do
    { echo "#version $version"; cat "$shaders/ltc.glsl" "$file"; } > "$work/test.frag"
    "$validator" "$work/test.frag" > "$work/log" 2>&1 || fail "$file does not compile as GLSL $version"
  done
  cat "$shaders/ltc.hlsl" "$name.hlsl" > "$work/test.hlsl"
  "$validator" -D -V -S frag -e main -o "$work/test.spv" "$work/test.hlsl" > "$work/log" 2>&1 || fail "$name.hlsl does not compile"
  if [ -n "$spirv_val" ]; then "$spirv_val" "$work/test.spv" > "$work/log" 2>&1 || fail "$name.hlsl: not valid SPIR-V"; fi
  # what is tested is called
  sed 's/LtcEntry entry = [A-Za-z]*(/&spheres, /' "$file" | { echo "#version 330 core"; cat "$shaders/ltc.glsl" -; } > "$work/test.frag"
  "$validator" "$work/test.frag" > "$work/log" 2>&1 && fail "$file: a wrong call compiles"
  count=$((count + 1))
done
[ "$count" -gt 5 ] || fail "only $count look-ups"
echo "all compiled"

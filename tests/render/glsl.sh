# The shader snippets compile as GLSL 3.30 and ES 3.00.
validator=$1
shaders=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for version in "330 core" "300 es"; do
  {
    echo "#version $version"
    cat "$shaders/ltc.glsl"
    cat <<'GLSL'
uniform sampler2D matrixTable;
uniform sampler2D amplitudeTable;
uniform vec3 corners[4];
in vec3 position;
in vec3 normal;
in vec3 view;
out vec4 colour;
void main() {
  LtcEntry entry = ltcFetch(matrixTable, amplitudeTable, 0.4, dot(normal, view));
  mat3 frame = ltcFrame(normal, view);
  vec3 l0 = frame * (corners[0] - position);
  vec3 l1 = frame * (corners[1] - position);
  vec3 l2 = frame * (corners[2] - position);
  vec3 l3 = frame * (corners[3] - position);
  float specular = abs(ltcQuad(entry.inverse, l0, l1, l2, l3));
  float diffuse = abs(ltcQuad(mat3(1.0), l0, l1, l2, l3));
  colour = vec4(specular * ltcFresnel(entry, vec3(0.04), vec3(1.0)) + diffuse, 1.0);
}
GLSL
  } > "$work/test.frag"
  "$validator" "$work/test.frag" || { echo "GLSL $version does not compile"; exit 1; }
done
echo "all compiled"

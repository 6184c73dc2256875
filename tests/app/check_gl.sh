# ltcfit check-gl: one scene with its files, bad input, and a machine without EGL.
. "$(dirname "$0")/common.sh" "$@"

if ! "$ltcfit" check-gl "$source_dir/data/ltc_iso.ktx2" --light quad --width 16 --height 16 >/dev/null 2>"$work/gl"; then
  cat "$work/gl"
  grep -q "^ltcfit: OpenGL" "$work/gl" && exit 77
  fail "check-gl"
fi

"$ltcfit" check-gl "$source_dir/data/ltc_aniso.ktx2" --light star --alpha-x 0.3 --alpha-y 0.06 --angle 30 --width 48 --height 36 \
  --threads 1 -o "$work/star" >"$work/text" || fail "one scene"
grep -q "GL agrees with its twin in all 1 scenes" "$work/text" || fail "$(cat "$work/text")"
for name in shading.json custom.png custom.exr contact.png; do
  [ -s "$work/star/$name" ] || fail "$name is missing"
done
[ "$(ls "$work/star" | wc -l)" = 4 ] || fail "more files: $(ls "$work/star")"

# the same for any number of threads, but for the times
"$ltcfit" check-gl "$source_dir/data/ltc_aniso.ktx2" --light star --alpha-x 0.3 --alpha-y 0.06 --angle 30 --width 48 --height 36 \
  --threads 2 --json -o "$work/again" >"$work/printed" || fail "again"
cmp "$work/printed" "$work/again/shading.json" || fail "printed and written JSON differ"
cmp "$work/star/custom.exr" "$work/again/custom.exr" || fail "pictures depend on threads"
python3 - "$work" <<'PY' || fail "shading.json"
import json, sys
def read(folder):
    check = json.load(open(f"{sys.argv[1]}/{folder}/shading.json"))
    frames = check.pop("frames")
    assert frames and all(f["seconds"] > 0 for f in frames), frames
    return check
a, b = read("star"), read("again")
assert a == b
assert a["format"] == "ltcfit-shading" and a["passed"] is True and a["against"] is None and a["random"] is None
(scene,) = a["scenes"]
assert scene["alpha"] == [0.3, 0.06] and scene["gl"]["psnr"] >= 40 and scene["gl"]["non_finite"] == 0, scene
assert 0 < scene["error"]["rmse"] < 0.1 and scene["reference"]["resolved"], scene
PY

expect_bad() {  # message, arguments
  local message=$1
  shift
  local code=0
  "$ltcfit" check-gl "$@" >"$work/out" 2>"$work/err" || code=$?
  [ "$code" = 2 ] || fail "$*: exit $code, not 2: $(cat "$work/err")"
  grep -qF -- "$message" "$work/err" || fail "$*: $(cat "$work/err")"
  [ ! -s "$work/out" ] || fail "$*: printed something"
}
expect_bad "nowhere.json" "$work/nowhere.json"
expect_bad "--light" "$source_dir/data/ltc_iso.json" --light tube
expect_bad "isotropic" "$source_dir/data/ltc_iso.json" --alpha-x 0.5 --alpha-y 0.1
expect_bad "anisotropic" "$source_dir/data/ltc_iso.json" --against "$source_dir/data/ltc_aniso.json"
expect_bad "--alpha-x" "$source_dir/data/ltc_iso.json" --alpha-x 0
expect_bad "--angle" "$source_dir/data/ltc_iso.json" --angle nan
expect_bad "--alpha-x" "$source_dir/data/ltc_iso.json" --alpha-x nan
"$ltcfit" check-gl "$source_dir/data/ltc_iso.json" --angle 0 --width 16 --height 16 --samples 129 >/dev/null || fail "--samples 129"
mkdir "$work/own" && cp "$source_dir/data/ltc_iso.json" "$work/own/shading.json"
expect_bad "would overwrite" "$work/own/shading.json" --light quad -o "$work/own"
expect_bad "would overwrite" "$source_dir/data/ltc_iso.json" --against "$work/own/shading.json" --light quad -o "$work/own"
cmp "$source_dir/data/ltc_iso.json" "$work/own/shading.json" || fail "the input was changed"
echo file >"$work/file"
expect_bad "file" "$source_dir/data/ltc_iso.json" -o "$work/file"
head -c 3000 "$source_dir/data/ltc_iso.ktx2" >"$work/cut.ktx2"
expect_bad "cut.ktx2" "$work/cut.ktx2"

# no driver of EGL, as on a machine without OpenGL
mkdir "$work/none"
code=0
__EGL_VENDOR_LIBRARY_DIRS="$work/none" "$ltcfit" check-gl "$source_dir/data/ltc_iso.ktx2" --light quad -o "$work/no-gl" \
  >"$work/out" 2>"$work/err" || code=$?
[ "$code" = 1 ] || fail "without EGL: exit $code"
grep -q "^ltcfit: OpenGL" "$work/err" || fail "without EGL: $(cat "$work/err")"
[ -z "$(ls -A "$work/no-gl" 2>/dev/null)" ] || fail "without EGL: files were written"
finish

# cmake --install puts program, shader and tables where a user expects them.
. "$(dirname "$0")/common.sh" "$@"
cmake --install "$(dirname "$ltcfit")" --prefix "$work/usr" >/dev/null || fail "cmake --install"
[ -x usr/bin/ltcfit ] || fail "bin/ltcfit"
for f in shaders/ltc.glsl shaders/ltc.hlsl shaders/ltc_textured.glsl shaders/ltc_textured.hlsl tables/ltc_iso.json tables/ltc_iso.h tables/ltc_aniso.json tables/ltc_aniso.h tables/ltc_iso.ktx2 tables/ltc_aniso.ktx2 tables/ltc_aniso_refined.json tables/ltc_aniso_refined.h tables/ltc_aniso_refined.ktx2 tables/ltc_iso.cheb.json tables/ltc_iso.cheb.glsl tables/ltc_iso.cheb.hlsl tables/ltc_iso.cheb.h tables/ltc_iso.cheb.js tables/SHA256SUMS; do [ -s usr/share/ltcfit/$f ] || fail "share/ltcfit/$f"; done
[ -s usr/share/doc/ltcfit/README.md ] || fail "share/doc/ltcfit/README.md"
usr/bin/ltcfit score -q usr/share/ltcfit/tables/ltc_iso.json --count 5 >/dev/null || fail "the installed table"
finish

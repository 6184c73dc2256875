# Every format read back by a reader that is not ours: bash readers.sh LTCFIT SOURCE_DIR REFERENCE_DIR BUILD_WEB
# NumPy for .npy and raw numbers, OpenImageIO for EXR, NVIDIA's nvddsinfo and Babylon.js' loader for DDS, ktx-parse and
# zstddec for KTX2, node for modules, compilers for source files.
build_web=$4
. "$(dirname "$0")/common.sh" "$@"
python=
for candidate in python3 /usr/bin/python3; do
  "$candidate" -c 'import numpy, OpenImageIO' 2>/dev/null && python=$candidate && break
done
for program in "$python" node nvddsinfo glslangValidator; do
  if [ -z "$program" ] || ! command -v "$program" >/dev/null; then
    echo "SKIPPED: need python3 with numpy and OpenImageIO, node, nvddsinfo and glslangValidator (scripts/packages-test.txt)"
    exit 77
  fi
done
bash "$source_dir/tests/web/install.sh" "$source_dir" "$build_web" check || exit $?
"$python" "$source_dir/tests/app/readers.py" "$ltcfit" "$source_dir" "$build_web" || fail "a reader disagrees"
finish

# The project as a part of another one, with everything left out that can be: a build that knows neither OpenGL, GLFW,
# glslang, SPIRV-Tools, tinygltf, libjpeg nor npm fits, refines, scores and exports all the same.
. "$(dirname "$0")/common.sh" "$@"
mkdir outer
cat > outer/CMakeLists.txt <<EOF
cmake_minimum_required(VERSION 3.25)
project(outer LANGUAGES CXX)
foreach(part SHADE SCENE REPORT STUDY)
  set(LTCFIT_\${part} OFF)
endforeach()
add_subdirectory("$source_dir" tables)
if(TARGET ltcfit_gl OR TARGET ltcfit_scene OR TARGET ltcfit_report OR TARGET ltcfit_study OR TARGET GTest::gtest)
  message(FATAL_ERROR "a part that was left out is there")
endif()
EOF
absent=()
for package in JPEG TinyGLTF glfw3 glslang SPIRV-Tools SPIRV-Tools-opt GTest benchmark; do
  absent+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
# compiled as the program that is tested, for the sake of a compiler cache
werror=$(sed -n 's/^LTCFIT_WERROR:[A-Z]*=//p' "$(dirname "$ltcfit")/CMakeCache.txt")
cmake -G Ninja -S outer -B inner -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DLTCFIT_WERROR="$werror" -DNPM=NPM-NOTFOUND "${absent[@]}" > out.txt 2>&1 ||
  fail "configuration: $(tail -n 20 out.txt)"
cmake --build inner > out.txt 2>&1 || { echo "FAILED: the build: $(tail -n 20 out.txt)"; exit 1; }
small=inner/tables/ltcfit
[ -x $small ] && [ ! -e inner/ltcfit ] || fail "the program is not in the folder of its project"
ldd $small | grep -E 'lib(GL|EGL|epoxy|glfw|jpeg|SPIRV|glslang)' && fail "the program still needs these"

$small fit iso -q --size 8x8 -o table.json || fail "fit"
$small refine table.json -q -o refined.json --points 64 --iterations 2 || fail "refine"
$small score refined.json --points off-grid --count 8 --against table.json > /dev/null || fail "score"
$small export -q table.json -o table.ktx2 --precision half || fail "export"
# the same bytes as the whole program's
"$ltcfit" fit iso -q --size 8x8 -o whole.json && cmp whole.json table.json || fail "another table"
for command in check-gl prefilter scene report pareto stability; do
  $small $command x.json > out.txt 2>&1
  [ $? -eq 2 ] && grep -q "$command: left out of this build.*LTCFIT_" out.txt || fail "$command: $(cat out.txt)"
done
$small fit --scene x.gltf -o y.json > out.txt 2>&1
[ $? -eq 2 ] || fail "fit --scene: $(cat out.txt)"
finish

// libFuzzer target of the readers of scenes: whatever the bytes are, they give lobes as scene_use.h says or
// an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "export/atomic_file.h"
#include "scene/gltf_scene.h"
#include "scene/json_scene.h"
#include "scene/texel_image.h"

namespace ltcfit {
namespace {

void check(const SceneUse& use) {
  for (const MaterialUse& material : use.materials) {
    if (!(material.area >= 0.0 && material.area < 1.000001)) std::abort();
    double sum = 0.0;
    for (const LobeUse& lobe : material.lobes) {
      if (!(lobe.alphaX >= lobe.alphaY && lobe.alphaX <= 1.0 && lobe.alphaY >= 0.0)) std::abort();
      if (!(lobe.f0 >= 0.0 && lobe.f0 <= 1.0 && lobe.f90 >= 0.0 && lobe.f90 <= 1.0)) std::abort();
      sum += lobe.weight;
    }
    if (!(std::abs(sum - material.area) <= 1e-6)) std::abort();
  }
}

template <typename Reader>
void attempt(const Reader& reader) {
  try {
    reader();
  } catch (const InputError&) {
  }
}

void read(std::string_view bytes) {
  // no file lies there
  constexpr const char* kFolder = "nowhere";
  if (isSceneDescription(bytes)) {
    attempt([&] { check(sceneFromJson(bytes, kFolder)); });
  } else {
    attempt([&] { check(sceneFromGltf(bytes, kFolder)); });
  }
  attempt([&] {
    const TexelImage image = decodeTexels(bytes, "T", std::size_t{1} << 20);
    if (image.texels.size() != image.width * image.height) std::abort();
  });
}

}  // namespace
}  // namespace ltcfit

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ltcfit::read({reinterpret_cast<const char*>(data), size});
  return 0;
}

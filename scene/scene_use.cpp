#include "scene/scene_use.h"

#include <fmt/format.h>

#include <utility>

#include "export/atomic_file.h"

namespace ltcfit {

void addMaterial(SceneUse& use, MaterialUse material, std::size_t maxBytes) {
  use.lobeCount += material.lobes.size();
  const std::size_t bytes = use.lobeCount * sizeof(LobeUse);
  if (bytes > maxBytes)
    throw InputError(
        fmt::format("material '{}': with it, the lobes of {} materials would take {} bytes of memory; up to "
                    "{} are allowed: read parts of the scene one by one",
                    material.name, use.materials.size() + 1, bytes, maxBytes));
  use.materials.push_back(std::move(material));
}

}  // namespace ltcfit

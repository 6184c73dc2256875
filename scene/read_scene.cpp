#include "scene/read_scene.h"

#include <filesystem>

#include "export/atomic_file.h"
#include "scene/gltf_file.h"
#include "scene/gltf_scene.h"
#include "scene/json_scene.h"

namespace ltcfit {

SceneUse readScene(const std::string& path) {
  const std::string bytes = readFile(path, kMaxGltfBytes);
  const std::filesystem::path file(path);
  try {
    SceneUse use = isSceneDescription(bytes) ? sceneFromJson(bytes, file.parent_path())
                                             : sceneFromGltf(bytes, file.parent_path());
    if (use.name.empty()) use.name = file.filename().string();
    return use;
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

}  // namespace ltcfit

// Scenes of the shading check, drawn by OpenGL with the shader that we ship and a table's own textures;
// tables that this does not look up with the look-up that we export for them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "render/film.h"
#include "render/gl_objects.h"
#include "render/prefilter.h"
#include "render/scene.h"
#include "render/shader_table.h"
#include "render/shader_text.h"

namespace ltcfit {

/// Largest number of different textures that the shader has room for.
inline constexpr std::size_t kMaxLightTextures = 4;

/// Needs a current context, the same for all calls and the destructor: a GlContext or a window's. All throw
/// GlError, and Refusal for scenes without surfaces or lights, with more of them than there is
/// room for (scene.h), with anisotropic materials where the table is isotropic, with an f0 below 1 where it
/// has no fresnel, or with lights of a texture that was not given.
class GlRenderer {
 public:
  /// `ltcGlsl`: text in place of ltc.glsl, for tests that plant a fault in it.
  explicit GlRenderer(const ShaderTable& table, std::string ltcGlsl = std::string(shaderText("ltc.glsl")));

  /// The scenes' textures from now on, in the order of Scene::textures; at most kMaxLightTextures.
  void useTextures(const std::vector<PrefilteredTexture>& textures);

  /// The scene in float32, as its camera asks. Each kind of scene is drawn by a shader that was compiled for
  /// what it needs, and kept.
  Film render(const Scene& scene);

  /// Median time of one frame, seconds, over `repeats` >= 1 of them after a first one, each waited for.
  double frameSeconds(const Scene& scene, std::size_t width, std::size_t height, int repeats);

  /// Draws into the framebuffer that is bound, in sRGB, clipped to 1.
  void drawForDisplay(const Scene& scene, std::size_t width, std::size_t height);

 private:
  void prepare(const Scene& scene, std::size_t width, std::size_t height, bool forDisplay);
  const GlTarget& targetOf(std::size_t width, std::size_t height);

  std::string ltcGlsl_;
  std::string tableDefines_;
  bool isotropic_;
  bool hasFresnel_;
  std::vector<GlObject> textures_;
  std::vector<GlObject> lightTextures_;
  std::vector<Eigen::Vector2d> lightTextureFetch_;  ///< margin and lodScale of each
  GlObject vertexArray_;
  GlTarget target_;
  std::map<std::string, GlObject> programs_;  ///< by their #defines
};

}  // namespace ltcfit

#include "render/gl_renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/refusal.h"
#include "render/gl_context.h"

namespace ltcfit {
namespace {

bool isTextured(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const PolygonLight& l) { return l.texture >= 0; });
}

void check(const Scene& scene, bool isotropicTable, bool hasFresnel, std::size_t textures) {
  const auto fail = [&](const std::string& what) {
    throw Refusal(fmt::format("scene '{}': {}", scene.name, what));
  };
  if (scene.surfaces.empty() || scene.surfaces.size() > kMaxSurfaces)
    fail(fmt::format("{} surfaces, not 1 to {}", scene.surfaces.size(), kMaxSurfaces));
  if (scene.lights.empty() || scene.lights.size() > kMaxLights)
    fail(fmt::format("{} lights, not 1 to {}", scene.lights.size(), kMaxLights));
  for (const PolygonLight& light : scene.lights) {
    if (light.vertices.size() < 3 || light.vertices.size() > kMaxLightVertices)
      fail(fmt::format("a light of {} vertices, not 3 to {}", light.vertices.size(), kMaxLightVertices));
    if (light.texture < 0) continue;
    if (static_cast<std::size_t>(light.texture) >= textures)
      fail(fmt::format("a light of texture {}, of {} given", light.texture, textures));
    if (light.vertices.size() != 4) fail("a textured light that is no rectangle");
  }
  if (isotropicTable && !scene.isIsotropic()) fail("anisotropic materials need an anisotropic table");
  if (!hasFresnel && scene.needsFresnel()) fail("f0 below 1 needs a table with fresnel");
}

std::size_t mostVertices(const Scene& scene) {
  std::size_t most = 4;
  for (const PolygonLight& light : scene.lights) most = std::max(most, light.vertices.size());
  return most;
}

std::string sceneDefines(const Scene& scene, std::size_t textures) {
  std::string text = fmt::format("#define SURFACES {}\n#define LIGHTS {}\n#define LTC_MAX_VERTICES {}\n",
                                 scene.surfaces.size(), scene.lights.size(), mostVertices(scene));
  const auto anySurface = [&](auto has) {
    return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), has);
  };
  const auto anyLight = [&](auto has) { return std::any_of(scene.lights.begin(), scene.lights.end(), has); };
  const auto define = [&](const char* name, bool needed) {
    if (needed) text += fmt::format("#define {}\n", name);
  };
  define("RECTANGLES", anySurface([](const Surface& s) { return s.shape == SurfaceShape::kRectangle; }));
  define("SPHERES", anySurface([](const Surface& s) { return s.shape == SurfaceShape::kSphere; }));
  define("RAMPS", anySurface([](const Surface& s) { return s.material.isRamp(); }));
  define("FRESNEL", scene.needsFresnel());
  define("DIFFUSE", anySurface([](const Surface& s) { return s.material.diffuse > 0.0; }));
  define("QUADS", anyLight([](const PolygonLight& l) { return l.vertices.size() == 4; }));
  define("POLYGONS", anyLight([](const PolygonLight& l) { return l.vertices.size() != 4; }));
  if (isTextured(scene)) text += fmt::format("#define TEXTURES {}\n", textures);
  define("ONE_SIDED", anyLight([](const PolygonLight& l) { return !l.twoSided; }));
  define("TWO_SIDED", anyLight([](const PolygonLight& l) { return l.twoSided; }));
  return text;
}

// An upper bound: a uniform that is no array takes at most one vector of 4 components, however the driver
// packs them; samplers are counted though few drivers do.
std::size_t uniformComponents(const Scene& scene, std::size_t textures) {
  constexpr std::size_t kOfSurface = 11;  // members of scene.glsl's structs
  constexpr std::size_t kOfLight = 6;
  constexpr std::size_t kOfCamera = 5;
  constexpr std::size_t kOfTable = 2;
  constexpr std::size_t kOfTexture = 2;
  return 4 * (scene.surfaces.size() * kOfSurface + scene.lights.size() * (kOfLight + mostVertices(scene)) +
              kOfCamera + kOfTable + (isTextured(scene) ? textures * kOfTexture : 0));
}

void requireUniforms(const Scene& scene, std::size_t textures) {
  GLint most = 0;
  if (epoxy_is_desktop_gl()) {
    glGetIntegerv(GL_MAX_FRAGMENT_UNIFORM_COMPONENTS, &most);
  } else {
    glGetIntegerv(GL_MAX_FRAGMENT_UNIFORM_VECTORS, &most);
    most *= 4;
  }
  const std::size_t needed = uniformComponents(scene, textures);
  if (std::cmp_less_equal(needed, most)) return;
  throw GlError(fmt::format("OpenGL: scene '{}' needs up to {} uniform components, this context has {}",
                            scene.name, needed, most));
}

// Uniforms of a program, by name; those that its #defines left out are passed over.
class Uniforms {
 public:
  explicit Uniforms(unsigned program) : program_(program) {}

  void set(const std::string& name, double value) const {
    glUniform1f(at(name), static_cast<GLfloat>(value));
  }
  void set(const std::string& name, int value) const { glUniform1i(at(name), value); }
  void set(const std::string& name, int x, int y) const { glUniform2i(at(name), x, y); }
  void set(const std::string& name, const Eigen::Vector2d& v) const {
    glUniform2f(at(name), static_cast<GLfloat>(v.x()), static_cast<GLfloat>(v.y()));
  }
  void set(const std::string& name, const Eigen::Vector3d& v) const {
    glUniform3f(at(name), static_cast<GLfloat>(v.x()), static_cast<GLfloat>(v.y()),
                static_cast<GLfloat>(v.z()));
  }

 private:
  GLint at(const std::string& name) const { return glGetUniformLocation(program_, name.c_str()); }

  unsigned program_;
};

void setSurface(const Uniforms& uniforms, const Surface& s, std::size_t index) {
  const auto set = [&](const char* field, const auto& value) {
    uniforms.set(fmt::format("surfaces[{}].{}", index, field), value);
  };
  const bool sphere = s.shape == SurfaceShape::kSphere;
  const Material& m = s.material;
  set("centre", s.centre);
  set("normal", Eigen::Vector3d(s.tangent.cross(s.bitangent)));
  set("tangent", sphere ? s.axis : s.tangent);
  set("bitangent", s.bitangent);
  set("halfSize", s.halfSize);
  set("radius", sphere ? s.radius : 0.0);
  set("roughness", Eigen::Vector2d(m.alpha.cwiseSqrt()));
  set("roughnessEnd", Eigen::Vector2d(m.alphaEnd.cwiseSqrt()));
  set("turn", Eigen::Vector2d(std::cos(m.rotation), std::sin(m.rotation)));
  set("f0", m.f0);
  set("diffuse", m.diffuse);
}

void setLight(const Uniforms& uniforms, const PolygonLight& light, std::size_t index, std::size_t stride) {
  const auto set = [&](const char* field, const auto& value) {
    uniforms.set(fmt::format("lights[{}].{}", index, field), value);
  };
  const std::vector<Eigen::Vector3d>& v = light.vertices;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < v.size(); ++i) normal += (v[i] - v[0]).cross(v[i + 1] - v[0]);
  int largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  set("normal", Eigen::Vector3d(normal.normalized()));
  set("radiance", light.radiance);
  set("vertices", static_cast<int>(v.size()));
  uniforms.set(fmt::format("lights[{}].plane", index), (largest + 1) % 3, (largest + 2) % 3);
  set("twoSided", light.twoSided ? 1 : 0);
  set("texture", light.texture);
  for (std::size_t i = 0; i < v.size(); ++i)
    uniforms.set(fmt::format("lightVertices[{}]", index * stride + i), v[i]);
}

void setCamera(const Uniforms& uniforms, const Camera& camera, std::size_t width, std::size_t height) {
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  const Eigen::Vector3d up = right.cross(forward);
  const double half = std::tan(0.5 * camera.verticalFov);
  const Eigen::Vector2d size(static_cast<double>(width), static_cast<double>(height));
  uniforms.set("cameraPosition", camera.position);
  uniforms.set("cameraForward", forward);
  uniforms.set("cameraRight", Eigen::Vector3d(right * half * size.x() / size.y()));
  uniforms.set("cameraUp", Eigen::Vector3d(up * half));
  uniforms.set("pictureSize", size);
}

// The look-up with what scene.glsl calls its arguments.
std::string callInScene(const ShaderLookup& lookup) {
  static const std::map<std::string, std::string> kArguments{{"matrixTable", "matrixTable"},
                                                             {"amplitudeTable", "amplitudeTable"},
                                                             {"table", "lobes"},
                                                             {"roughness", "roughness.x"},
                                                             {"nDotV", "dot(n, view)"},
                                                             {"alphaX", "roughness.x * roughness.x"},
                                                             {"alphaY", "roughness.y * roughness.y"},
                                                             {"view", "frame * view"}};
  return lookup.call(kArguments);
}

void drawPicture() {
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

GlRenderer::GlRenderer(const ShaderTable& table, std::string ltcGlsl)
    : ltcGlsl_(std::move(ltcGlsl)),
      isotropic_(table.isIsotropic()),
      hasFresnel_(table.hasFresnel()),
      vertexArray_(makeVertexArray()) {
  if (!isotropic_) {
    const auto [alphas, lambdas] = table.nodes();
    tableDefines_ = fmt::format("#define LTC_NODES ivec2({}, {})\n", alphas, lambdas);
  }
  if (table.lookup) {
    tableDefines_ += fmt::format("#define LTC_LOOKUP {}\n", callInScene(*table.lookup));
    ltcGlsl_ += table.lookup->source;
  }
  for (const Image& image : table.textures) textures_.push_back(makeTexture(image));
}

void GlRenderer::useTextures(const std::vector<PrefilteredTexture>& textures) {
  if (textures.size() > kMaxLightTextures)
    throw std::invalid_argument(fmt::format("{} textures, not 0 to {}", textures.size(), kMaxLightTextures));
  lightTextures_.clear();
  lightTextureFetch_.clear();
  for (const PrefilteredTexture& texture : textures) {
    lightTextures_.push_back(makeTexture(texture));
    lightTextureFetch_.emplace_back(texture.margin, texture.lodScale);
  }
}

// Makes the program of the scene current, with its uniforms and the textures.
void GlRenderer::prepare(const Scene& scene, std::size_t width, std::size_t height, bool forDisplay) {
  check(scene, isotropic_, hasFresnel_, lightTextures_.size());
  const std::string defines =
      tableDefines_ + sceneDefines(scene, lightTextures_.size()) + (forDisplay ? "#define DISPLAY\n" : "");
  auto program = programs_.find(defines);
  if (program == programs_.end()) {
    requireUniforms(scene, lightTextures_.size());
    const std::string_view version = epoxy_is_desktop_gl() ? "#version 330 core\n" : "#version 300 es\n";
    const std::array<std::string_view, 2> vertex{version, shaderText("picture.glsl")};
    const std::array<std::string_view, 5> fragment{version, defines, ltcGlsl_,
                                                   shaderText("ltc_textured.glsl"), shaderText("scene.glsl")};
    program = programs_.emplace(defines, makeProgram(vertex, fragment, "scene.glsl")).first;
  }
  const unsigned id = program->second.id();
  glUseProgram(id);
  glBindVertexArray(vertexArray_.id());
  const Uniforms uniforms(id);
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) setSurface(uniforms, scene.surfaces[i], i);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    setLight(uniforms, scene.lights[i], i, mostVertices(scene));
  setCamera(uniforms, scene.camera, width, height);
  for (std::size_t t = 0; t < textures_.size(); ++t) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + t));
    glBindTexture(isotropic_ ? GL_TEXTURE_2D : GL_TEXTURE_3D, textures_[t].id());
  }
  for (std::size_t t = 0; t < lightTextures_.size(); ++t) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE2 + t));
    glBindTexture(GL_TEXTURE_2D, lightTextures_[t].id());
    uniforms.set(fmt::format("pictures[{}]", t), static_cast<int>(2 + t));
    uniforms.set(fmt::format("pictureFetch[{}]", t), lightTextureFetch_[t]);
  }
  uniforms.set("lobes", 0);
  uniforms.set("matrixTable", 0);
  uniforms.set("amplitudeTable", 1);
  glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
  glDisable(GL_DITHER);
  checkGl(fmt::format("scene '{}'", scene.name));
}

const GlTarget& GlRenderer::targetOf(std::size_t width, std::size_t height) {
  if (target_.width != width || target_.height != height) target_ = makeTarget(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, target_.framebuffer.id());
  return target_;
}

Film GlRenderer::render(const Scene& scene) {
  Film film(scene.camera.width, scene.camera.height);
  targetOf(film.width, film.height);
  prepare(scene, film.width, film.height, false);
  drawPicture();
  std::vector<float> pixels(film.width * film.height * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, static_cast<GLsizei>(film.width), static_cast<GLsizei>(film.height), GL_RGBA, GL_FLOAT,
               pixels.data());
  checkGl(fmt::format("drawing scene '{}'", scene.name));
  for (std::size_t row = 0; row < film.height; ++row) {
    for (std::size_t column = 0; column < film.width; ++column) {
      // OpenGL's rows begin at the bottom
      const float* const p = pixels.data() + ((film.height - 1 - row) * film.width + column) * 4;
      const std::size_t pixel = row * film.width + column;
      film.radiance[pixel] = Eigen::Vector3f(p[0], p[1], p[2]).cast<double>();
      film.kinds[pixel] = static_cast<PixelKind>(std::lround(p[3]));
    }
  }
  return film;
}

double GlRenderer::frameSeconds(const Scene& scene, std::size_t width, std::size_t height, int repeats) {
  targetOf(width, height);
  prepare(scene, width, height, false);
  std::vector<double> seconds;
  for (int i = 0; i <= repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    drawPicture();
    glFinish();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    if (i > 0) seconds.push_back(took.count());
  }
  checkGl(fmt::format("drawing scene '{}'", scene.name));
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

void GlRenderer::drawForDisplay(const Scene& scene, std::size_t width, std::size_t height) {
  prepare(scene, width, height, true);
  drawPicture();
  checkGl(fmt::format("drawing scene '{}'", scene.name));
}

}  // namespace ltcfit

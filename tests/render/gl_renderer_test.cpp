// What OpenGL draws against the double-precision twin.
#include "render/gl_renderer.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "export/atomic_file.h"
#include "export/formats.h"
#include "render/picture_error.h"
#include "render/scenes.h"
#include "render/twin.h"
#include "tests/render/gl.h"
#include "tests/support/tailored.h"

namespace ltcfit::test {
namespace {

class GlRendererTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = glUnavailable();
    if (!reason.empty()) GTEST_SKIP() << reason;
    context_ = std::make_unique<GlContext>();
  }
  std::unique_ptr<GlContext> context_;
};

ShaderTable dataTable(const std::string& name) {
  return loadShaderTable(std::string(LTCFIT_DATA_DIR) + "/" + name);
}

// Half the size is enough to see a fault, and the same scene.
Scene smaller(Scene scene) {
  scene.camera.width /= 2;
  scene.camera.height /= 2;
  return scene;
}

std::optional<Scene> sceneNamed(const std::string& name, const ShaderTable& table) {
  for (const CheckScene& check : namedScenes(!table.isIsotropic())) {
    if (check.scene.name == name) return check.scene;
  }
  return std::nullopt;
}

void expectAgreement(const ShaderTable& table, GlRenderer& renderer, const Scene& scene, double floor) {
  const PictureError error = pictureError(renderer.render(scene), renderTwin(scene, table.table));
  EXPECT_GE(error.psnr, floor) << scene.name;
  EXPECT_EQ(error.nonFinite, 0u) << scene.name;
  EXPECT_GT(error.pixels, 100u) << scene.name;
  // a ray that passes within float32's rounding of an outline
  EXPECT_LE(error.kindsDiffer, 2u) << scene.name;
  std::printf("  %-18s %6.1f dB, largest %.1e, %zu pixels\n", scene.name.c_str(), error.psnr, error.largest,
              error.pixels);
}

// float32 is good for 97 to 150 dB here: 90 leaves room for another compiler of the shader. Halves are the
// same numbers for both.
constexpr double kFloor = 90.0;

TEST_F(GlRendererTest, AgreesWithTheTwinInEveryScene) {
  for (const char* name : {"ltc_iso.json", "ltc_aniso.json"}) {
    const ShaderTable table = dataTable(name);
    GlRenderer renderer(table);
    std::printf("%s: %s\n", name, table.note.c_str());
    for (const CheckScene& check : namedScenes(!table.isIsotropic()))
      expectAgreement(table, renderer, check.scene, kFloor);
  }
}

// Each scene is a program that a software renderer takes about a second to compile: a few of them.
TEST_F(GlRendererTest, AgreesWithHalves) {
  for (const char* name : {"ltc_iso.ktx2", "ltc_aniso.ktx2"}) {
    const ShaderTable table = dataTable(name);
    GlRenderer renderer(table);
    std::printf("%s: %s\n", name, table.note.c_str());
    for (const char* scene : {"rectangle", "mirror", "brushed-spheres"}) {
      if (const auto found = sceneNamed(scene, table)) expectAgreement(table, renderer, *found, kFloor);
    }
  }
}

TEST_F(GlRendererTest, AgreesInRandomScenes) {
  for (const char* name : {"ltc_iso.json", "ltc_aniso.json"}) {
    const ShaderTable table = dataTable(name);
    GlRenderer renderer(table);
    for (std::uint64_t i = 0; i < 20; ++i)
      expectAgreement(table, renderer, randomScene(3, i, !table.isIsotropic(), 48), kFloor);
  }
}

// Materials and lights of every kind in one picture, so that every branch of the shader is compiled.
TEST_F(GlRendererTest, AgreesWithEverythingAtOnce) {
  const ShaderTable table = dataTable("ltc_aniso.json");
  GlRenderer renderer(table);
  Scene scene = smaller(namedScenes(true)[0].scene);
  scene.name = "everything";
  scene.surfaces[0].material.alphaEnd = Eigen::Vector2d(0.6, 0.1);
  scene.surfaces[0].material.f0 = 0.3;
  scene.surfaces[0].material.diffuse = 0.4;
  Surface sphere;
  sphere.shape = SurfaceShape::kSphere;
  sphere.centre = Eigen::Vector3d(1.2, -0.5, 0.6);
  sphere.radius = 0.6;
  sphere.material.alpha = Eigen::Vector2d(0.1, 0.5);
  sphere.material.rotation = 0.8;
  scene.surfaces.push_back(sphere);
  scene.lights.push_back(makeLight(LightShape::kStar, Eigen::Vector3d(-1.5, 0.5, 1.0),
                                   Eigen::Vector3d(0.5, 0.2, -0.6), Eigen::Vector2d(0.7, 0.5), 0.3));
  scene.lights.back().twoSided = true;
  scene.lights.back().radiance = Eigen::Vector3d(1.0, 0.5, 0.25);
  scene.lights.push_back(makeLight(LightShape::kDisk, Eigen::Vector3d(2.0, 1.0, 0.4),
                                   Eigen::Vector3d(-1.0, -0.4, 0.1), Eigen::Vector2d(0.6, 0.6)));
  expectAgreement(table, renderer, scene, kFloor);
}

TEST_F(GlRendererTest, LightFromBehindAddsNothing) {
  const ShaderTable table = dataTable("ltc_iso.json");
  GlRenderer renderer(table);
  Scene scene = smaller(namedScenes(false)[0].scene);
  std::reverse(scene.lights[0].vertices.begin(), scene.lights[0].vertices.end());
  const Film film = renderer.render(scene);
  const auto lit = [](const Film& f) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < f.kinds.size(); ++i)
      count += f.kinds[i] == PixelKind::kSurface && f.radiance[i].maxCoeff() > 1e-6 ? 1 : 0;
    return count;
  };
  // it hangs above and faces the ground: turned around it lights at most what stands behind it
  EXPECT_EQ(lit(film), lit(renderTwin(scene, table.table)));
  scene.lights[0].twoSided = true;
  EXPECT_GT(lit(renderer.render(scene)), lit(film));
}

// Tables made for a scene, by their own look-ups; and what is out of their reach as at its ends.
ShaderTable tailoredShaderTable(const std::string& name, FormatOptions options = {}) {
  options.layout = Layout::kLean;
  std::string folder = (std::filesystem::temp_directory_path() / "ltcfit-gl-table-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no folder " + folder);
  const std::filesystem::path path(folder);
  const ExportResult result = exportTable(tailoredTable(name), *findFormat("dds"), options, "t.dds");
  for (const ExportFile& file : result.files) writeFileAtomically((path / file.name).string(), file.bytes);
  ShaderTable table = loadShaderTable((path / result.files[0].name).string());
  std::filesystem::remove_all(path);
  return table;
}

TEST_F(GlRendererTest, AgreesWithTailoredTables) {
  for (const char* name : {"isoRange", "isoRow", "anisoRange", "anisoOneAlpha", "anisoPair", "anisoBest"}) {
    const ShaderTable table = tailoredShaderTable(name);
    ASSERT_TRUE(table.lookup) << name;
    GlRenderer renderer(table);
    std::printf("%s: %s\n", name, table.note.c_str());
    for (const char* scene : {"rectangle", "ramp", "brushed-spheres", "plastic"}) {
      const auto found = sceneNamed(scene, table);
      if (!found) continue;
      if (found->needsFresnel() && !table.hasFresnel()) {
        EXPECT_THROW(renderer.render(*found), std::invalid_argument);
        continue;
      }
      expectAgreement(table, renderer, *found, kFloor);
    }
    for (std::uint64_t i = 0; i < 4; ++i)
      expectAgreement(table, renderer, randomScene(3, i, !table.isIsotropic(), 48), kFloor);
  }
}

TEST_F(GlRendererTest, AgreesWithTailoredHalves) {
  FormatOptions half;
  half.precision = Precision::kHalf;
  for (const char* name : {"isoRange", "isoRow", "anisoRange"}) {
    const ShaderTable table = tailoredShaderTable(name, half);
    GlRenderer renderer(table);
    expectAgreement(table, renderer, sceneNamed("rectangle", table).value(), kFloor);
  }
}

TEST_F(GlRendererTest, AWrongWarpIsSeen) {
  ShaderTable table = tailoredShaderTable("isoRange");
  TableInfo wrong = table.table.info();
  wrong.axes[1].warp[0] = 0.5;  // 0.4 is right
  table.lookup = makeShaderLookup(wrong, ShadingLanguage::kGlsl, "wrong");
  GlRenderer renderer(table);
  const Scene scene = smaller(sceneNamed("rectangle", table).value());
  const double psnr = pictureError(renderer.render(scene), renderTwin(scene, table.table)).psnr;
  std::printf("  %.1f dB\n", psnr);
  EXPECT_LT(psnr, 60.0);
}

using Replacements = std::vector<std::pair<std::string, std::string>>;

std::string planted(const Replacements& replacements) {
  std::string glsl(shaderText("ltc.glsl"));
  for (const auto& [text, fault] : replacements) {
    const std::size_t at = glsl.find(text);
    if (at == std::string::npos) throw std::logic_error("ltc.glsl has no " + text);
    glsl.replace(at, text.size(), fault);
  }
  return glsl;
}

// A fault in the text of ltc.glsl, and the scene that is looked at.
struct Fault {
  const char* name;
  const char* scene;
  Replacements replacements;
};

double psnrWith(const Fault& fault, const ShaderTable& table) {
  GlRenderer renderer(table, planted(fault.replacements));
  const Scene scene = smaller(sceneNamed(fault.scene, table).value());
  return pictureError(renderer.render(scene), renderTwin(scene, table.table)).psnr;
}

void expectSeen(const char* file, const std::vector<Fault>& faults) {
  const ShaderTable table = dataTable(file);
  for (const Fault& fault : faults) {
    const double psnr = psnrWith(fault, table);
    std::printf("  %s, %s, %s: %.1f dB\n", file, fault.scene, fault.name, psnr);
    EXPECT_LT(psnr, 40.0) << fault.name;
    EXPECT_GT(psnrWith({"none", fault.scene, {}}, table), kFloor);
  }
}

TEST_F(GlRendererTest, PlantedFaultsAreSeen) {
  expectSeen("ltc_iso.json",
             {{"transposed inverse",
               "rectangle",
               {{"vec3(t.x, 0.0, t.y), vec3(0.0, 1.0, 0.0), vec3(t.z, 0.0, t.w)",
                 "vec3(t.x, 0.0, t.z), vec3(0.0, 1.0, 0.0), vec3(t.y, 0.0, t.w)"}}},
              {"texel edges for centres", "mirror", {{"uv = uv * (size - 1.0) / size + 0.5 / size;", ""}}},
              {"no clipping", "horizon", {{"min(min(a.z, b.z), min(c.z, d.z)) > 0.0", "true"}}}});
  // Mirrors on one side only, as eq. 13 and 15 of KT et al. 2022 have them, turn the winding of lights: det M
  // < 0 in two quadrants. ltc.glsl also looks at the sign of the determinant.
  expectSeen("ltc_aniso.json",
             {{"transposed inverse",
               "brushed-spheres",
               {{"entry.inverse = mat3(c0 * scale, c1 * scale, c2 * scale);",
                 "entry.inverse = transpose(mat3(c0 * scale, c1 * scale, c2 * scale));"}}},
              {"missing winding flip",
               "brushed-spheres",
               {{"m0 *= flip * flip.x;", "m0 *= flip;"},
                {"m1 *= flip * flip.y;", "m1 *= flip;"},
                {"if (dot(m0, c0) < 0.0) scale *= vec3(-1.0, 1.0, -1.0);", ""}}},
              {"no mirrors", "brushed-spheres", {{"m0 *= flip * flip.x;", "flip = vec3(1.0);"}}},
              {"no swap", "needles", {{"bool swapped = alphaY > alphaX;", "bool swapped = false;"}}}});
}

TEST_F(GlRendererTest, ErrorsNameWhatIsWrong) {
  const ShaderTable table = dataTable("ltc_iso.json");
  const Scene scene = smaller(namedScenes(false)[0].scene);
  const auto message = [&](GlRenderer& renderer, const Scene& s) {
    try {
      renderer.render(s);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  GlRenderer broken(table, planted({{"entry.norm = a.x;", "entry.norm = a.xy;"}}));
  EXPECT_NE(message(broken, scene).find("scene.glsl does not compile"), std::string::npos);
  GlRenderer renderer(table);
  EXPECT_EQ(message(renderer, scene), "");
  Scene brushed = scene;
  brushed.surfaces[0].material.alpha.y() *= 0.5;
  EXPECT_NE(message(renderer, brushed).find("need an anisotropic table"), std::string::npos);
  Scene dark = scene;
  dark.lights.clear();
  EXPECT_NE(message(renderer, dark).find("0 lights"), std::string::npos);
  Scene empty = scene;
  empty.surfaces.clear();
  EXPECT_NE(message(renderer, empty).find("0 surfaces"), std::string::npos);
  Scene large = scene;
  large.camera.width = 1 << 16;
  EXPECT_NE(message(renderer, large).find("a float picture of 65536 x"), std::string::npos);
  // nothing of that stays behind
  EXPECT_EQ(message(renderer, scene), "");
}

// A context that has few uniforms; epoxy calls OpenGL through pointers.
class FewUniforms {
 public:
  explicit FewUniforms(GLint components) {
    components_ = components;
    // epoxy sets its pointer at the first call
    GLint unused = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &unused);
    original_ = epoxy_glGetIntegerv;
    epoxy_glGetIntegerv = [](GLenum name, GLint* out) {
      original_(name, out);
      if (name == GL_MAX_FRAGMENT_UNIFORM_COMPONENTS) *out = components_;
      if (name == GL_MAX_FRAGMENT_UNIFORM_VECTORS) *out = components_ / 4;
    };
  }
  ~FewUniforms() { epoxy_glGetIntegerv = original_; }
  FewUniforms(const FewUniforms&) = delete;
  FewUniforms& operator=(const FewUniforms&) = delete;

 private:
  static inline GLint components_ = 0;
  static inline decltype(epoxy_glGetIntegerv) original_ = nullptr;
};

// What the message says; 0 where the scene is drawn.
int neededUniforms(const ShaderTable& table, const Scene& scene, GLint components) {
  const FewUniforms few(components);
  GlRenderer renderer(table);
  try {
    renderer.render(scene);
  } catch (const GlError& error) {
    int needed = 0;
    int has = 0;
    const std::string text = error.what();
    const std::size_t at = text.find("needs up to");
    if (at == std::string::npos ||
        std::sscanf(text.c_str() + at, "needs up to %d uniform components, this context has %d", &needed,
                    &has) != 2)
      ADD_FAILURE() << text;
    EXPECT_EQ(has, components);
    return needed;
  }
  return 0;
}

// Vectors of 4 that the current program's uniforms take, one or an array's elements each.
int activeVectors() {
  GLint program = 0;
  GLint count = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  glGetProgramiv(static_cast<GLuint>(program), GL_ACTIVE_UNIFORMS, &count);
  int sum = 0;
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    GLint size = 0;
    GLenum type = 0;
    GLchar name[64];
    glGetActiveUniform(static_cast<GLuint>(program), i, sizeof name, nullptr, &size, &type, name);
    sum += size;
  }
  return sum;
}

TEST_F(GlRendererTest, SaysWhereAContextHasTooFewUniforms) {
  const ShaderTable table = dataTable("ltc_aniso.json");
  const Scene scene = smaller(sceneNamed("brushed-spheres", table).value());
  const int needed = neededUniforms(table, scene, 4);
  EXPECT_GT(neededUniforms(table, scene, needed - 4), 0);
  EXPECT_EQ(neededUniforms(table, scene, needed), 0);
  GlRenderer renderer(table);
  renderer.render(scene);
  EXPECT_GE(needed, 4 * activeVectors());
  EXPECT_GT(activeVectors(), 4);

  Scene most = scene;
  most.surfaces.resize(kMaxSurfaces, scene.surfaces[0]);
  most.lights.assign(kMaxLights, scene.lights[0]);
  most.lights[0] = makeLight(LightShape::kDisk, Eigen::Vector3d(2.0, 1.0, 0.4),
                             Eigen::Vector3d(-1.0, -0.4, 0.1), Eigen::Vector2d(0.6, 0.6));
  EXPECT_EQ(neededUniforms(table, most, 4), 1372 - 4 * 2 * static_cast<int>(kMaxLightTextures));
}

// Named and random scenes, by what OpenGL ES 3.0 promises at least.
TEST_F(GlRendererTest, OwnScenesAreWithinEveryContextsUniforms) {
  constexpr int kPromised = 4 * 224;
  for (const char* name : {"ltc_iso.json", "ltc_aniso.json"}) {
    const ShaderTable table = dataTable(name);
    std::vector<Scene> scenes;
    for (const CheckScene& check : namedScenes(!table.isIsotropic())) scenes.push_back(check.scene);
    for (std::uint64_t i = 0; i < 100; ++i) scenes.push_back(randomScene(1, i, !table.isIsotropic(), 32));
    int most = 0;
    for (const Scene& scene : scenes) most = std::max(most, neededUniforms(table, scene, 4));
    std::printf("  %s: %d components at most\n", name, most);
    EXPECT_GT(most, 100);
    EXPECT_LE(most, kPromised);
  }
}

// Without desktop OpenGL: the renderer's name, and how far a picture of both kinds of tables is off.
[[noreturn]] void drawByEs() {
  try {
    const GlContext context;
    std::fprintf(stderr, "%s", glRendererName().c_str());
    for (const char* name : {"ltc_iso.json", "ltc_aniso.ktx2"}) {
      const ShaderTable table = dataTable(name);
      GlRenderer renderer(table);
      const Scene scene =
          smaller(sceneNamed(table.isIsotropic() ? "rectangle" : "brushed-star", table).value());
      const double psnr = pictureError(renderer.render(scene), renderTwin(scene, table.table)).psnr;
      std::fprintf(stderr, ", %s %.1f dB", name, psnr);
      if (!(psnr > kFloor)) std::exit(2);
    }
    std::fprintf(stderr, ", done\n");
    std::exit(0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  std::exit(1);
}

using GlRendererDeathTest = WithoutLibraries;

TEST_F(GlRendererDeathTest, DrawsByEs) {
  hide("libOpenGL.so.0");
  hide("libGL.so.1");
  const std::string reason = glUnavailable();
  if (!reason.empty()) GTEST_SKIP() << reason;
  if (dlopen("libGLESv2.so.2", RTLD_LAZY) == nullptr) GTEST_SKIP() << "no OpenGL ES (Debian: libgles2)";
  EXPECT_EXIT(drawByEs(), testing::ExitedWithCode(0), "OpenGL ES 3.*done");
}

TEST_F(GlRendererTest, FramesTakeTime) {
  const ShaderTable table = dataTable("ltc_iso.json");
  GlRenderer renderer(table);
  const Scene scene = makeScene({});
  const double small = renderer.frameSeconds(scene, 64, 48, 5);
  const double large = renderer.frameSeconds(scene, 640, 480, 5);
  std::printf("  %s: %zu surfaces at 640 x 480: %.2f ms\n", glRendererName().c_str(), scene.surfaces.size(),
              large * 1e3);
  EXPECT_GT(small, 0.0);
  EXPECT_GT(large, small);  // 100 times the pixels
}

}  // namespace
}  // namespace ltcfit::test

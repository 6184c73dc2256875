#include "render/shading_check.h"

#include <algorithm>
#include <cmath>

#include "render/gl_renderer.h"
#include "render/lost_scene.h"
#include "render/reference.h"
#include "render/textured_scenes.h"

namespace ltcfit {
namespace {

// Frames are timed at these scenes, five times each.
constexpr const char* kTimedScenes[] = {"rectangle", "plastic", "star", "several-lights", "brushed-spheres"};
constexpr int kFrameRepeats = 5;

// A pixel may show another thing in float32 than in double where an outline passes within 1e-6 of its centre.
constexpr double kKindsShare = 0.002;

// The reference's own error is to be a tenth of the smaller error that it judges. It aims lower, since what
// it states can be a tenth low, but at no less than 1e-5, some thousandth of the mean error of the scenes:
// with these, `check-gl data/ltc_iso.json` takes a minute of CPU time and nine scenes in ten are judged so.
constexpr double kShare = 0.1;
constexpr double kAim = 0.06;
constexpr double kLeastTarget = 1e-5;
constexpr double kFirstTarget = 1e-3;  // to learn what is to be judged

ReferenceFilm reference(const Scene& scene, const ShadingCheckOptions& options, double target) {
  ReferenceOptions o;
  o.maxSamples = std::max(options.maxSamples, o.minSamples);
  o.targetRmse = target;
  o.seed = options.seed;
  o.threads = options.threads;
  return renderReference(scene, o);
}

SceneCheck judge(const CheckScene& check, GlRenderer& gl, const ShaderTable& table, GlRenderer* otherGl,
                 const ShadingCheckOptions& options) {
  const Scene& scene = check.scene;
  std::vector<PrefilteredTexture> textures;
  for (const LightTexture& picture : scene.textures) {
    PrefilterOptions prefiltering;
    prefiltering.threads = options.threads;
    textures.push_back(prefilter(picture, prefiltering));
  }
  SceneCheck out;
  out.check = check;
  gl.useTextures(textures);
  out.ltc = gl.render(scene);
  const auto twinOf = [&](HorizonClipping clipping) {
    return renderTwin(scene, table.table, {clipping, textures, options.threads});
  };
  const Film twin = twinOf(HorizonClipping::kExact);
  // dark pictures count as bright ones do
  const double peak = brightest(twin);
  out.gl = pictureError(out.ltc, twin, peak > 0.0 ? std::min(peak, 1.0) : 1.0);
  out.glFloor = isHalf(table) ? kHalfPsnrFloor : check.psnrFloor;
  out.passed =
      out.gl.psnr >= out.glFloor && out.gl.nonFinite == 0 && out.gl.pixels > 0 &&
      static_cast<double>(out.gl.kindsDiffer) <= kKindsShare * static_cast<double>(out.ltc.radiance.size());
  if (otherGl != nullptr) {
    otherGl->useTextures(textures);
    out.otherLtc = otherGl->render(scene);
  }

  const auto compare = [&](const Film& truth) {
    out.error = pictureError(out.ltc, truth);
    if (out.otherLtc) out.other = pictureError(*out.otherLtc, truth);
    return out.other ? std::min(out.error.rmse, out.other->rmse) : out.error.rmse;
  };
  ReferenceFilm truth = reference(scene, options, kFirstTarget);
  double target = std::max(kLeastTarget, kAim * compare(truth.film));
  if (target < truth.ownRmse) {
    truth = reference(scene, options, target);
    // the first one's own error counts in what it judged: once more where that was much of it
    const double smaller = std::max(kLeastTarget, kAim * compare(truth.film));
    if (truth.reachedTarget && smaller < 0.7 * target && smaller < truth.ownRmse) {
      truth = reference(scene, options, smaller);
      compare(truth.film);
    }
  }
  out.reference = truth.film;
  out.referenceRmse = truth.ownRmse;
  out.referenceSamples = truth.meanSamples;
  if (out.lost()) out.explanation = explainLostScene(scene, out.ltc, *out.otherLtc, out.reference);
  // a texture's own error would hide what clipping does
  if (!scene.textures.empty()) return out;
  out.clipping.emplace();
  for (std::size_t c = 0; c < kHorizonClippings; ++c) {
    const HorizonClipping clipping = static_cast<HorizonClipping>(c);
    const Film film = clipping == HorizonClipping::kExact ? twin : twinOf(clipping);
    (*out.clipping)[c] = pictureError(film, truth.film).rmse;
  }
  return out;
}

}  // namespace

bool SceneCheck::resolved() const {
  const double judged = other ? std::min(error.rmse, other->rmse) : error.rmse;
  return referenceRmse <= kShare * judged;
}

bool SceneCheck::closer() const {
  return other && other->rmse - error.rmse > referenceRmse;
}

bool ShadingCheck::passed() const {
  const auto good = [](const SceneCheck& s) { return s.passed; };
  return !scenes.empty() && std::all_of(scenes.begin(), scenes.end(), good) &&
         std::all_of(dielectrics.begin(), dielectrics.end(), good);
}

RandomSummary ShadingCheck::random() const {
  // they stand after the named ones
  const auto first = std::find_if(scenes.begin(), scenes.end(), [](const SceneCheck& s) { return s.random; });
  return summaryOf({first, scenes.end()});
}

RandomSummary summaryOf(std::span<const SceneCheck> scenes) {
  RandomSummary sum;
  sum.scenes = scenes.size();
  if (scenes.empty()) return sum;
  const double n = static_cast<double>(scenes.size());
  double logs = 0.0;
  std::size_t ratios = 0;
  for (const SceneCheck& s : scenes) {
    sum.rmse += s.error.rmse / n;
    if (s.other) sum.otherRmse += s.other->rmse / n;
    if (s.other && s.error.rmse > 0.0 && s.other->rmse > 0.0) {
      logs += std::log(s.error.rmse / s.other->rmse);
      ++ratios;
    }
    if (s.closer()) ++sum.closer;
    if (s.lost()) ++sum.lost;
    if (s.resolved()) ++sum.resolved;
    sum.referenceRmse += s.referenceRmse / n;
    if (s.clipping)
      for (std::size_t c = 0; c < kHorizonClippings; ++c) sum.clipping[c] += (*s.clipping)[c] / n;
  }
  if (ratios > 0) sum.geometricRatio = std::exp(logs / static_cast<double>(ratios));
  return sum;
}

ShadingCheck runShadingCheck(const ShaderTable& table, const ShaderTable* other,
                             const ShadingCheckOptions& options,
                             const std::function<void(std::size_t, std::size_t)>& progress) {
  const GlContext context;
  GlRenderer gl(table);
  std::optional<GlRenderer> otherGl;
  if (other != nullptr) otherGl.emplace(*other);
  GlRenderer* const against = otherGl ? &*otherGl : nullptr;

  ShadingCheck out;
  out.renderer = glRendererName();
  std::vector<CheckScene> scenes;
  const bool anisotropic = !table.table.isIsotropic();
  if (options.custom) {
    scenes.push_back({makeScene(*options.custom), 50.0, ""});
  } else {
    scenes = namedScenes(anisotropic);
    for (CheckScene& check : texturedScenes()) scenes.push_back(std::move(check));
  }
  const bool fresnel = table.hasFresnel() && (other == nullptr || other->hasFresnel());
  if (!fresnel) std::erase_if(scenes, [](const CheckScene& check) { return check.scene.needsFresnel(); });
  for (CheckScene& check : scenes) {
    check.scene.camera.width = options.width;
    check.scene.camera.height = options.height;
  }
  const std::size_t randomScenes = options.custom ? 0 : options.randomScenes;
  const std::size_t dielectrics = fresnel || options.dielectricF0 == 1.0 ? randomScenes / 4 : 0;
  const std::size_t total = scenes.size() + randomScenes + dielectrics;
  for (const CheckScene& check : scenes) {
    progress(out.scenes.size(), total);
    out.scenes.push_back(judge(check, gl, table, against, options));
  }
  for (std::size_t i = 0; i < randomScenes; ++i) {
    progress(out.scenes.size(), total);
    const Scene scene = randomScene(options.seed, i, anisotropic, options.randomSize);
    out.scenes.push_back(judge({scene, 50.0, ""}, gl, table, against, options));
    out.scenes.back().random = true;
  }
  for (std::size_t i = 0; i < dielectrics; ++i) {
    progress(out.scenes.size() + i, total);
    Scene scene = randomScene(options.seed, i, anisotropic, options.randomSize);
    for (Surface& surface : scene.surfaces) surface.material.f0 = options.dielectricF0;
    out.dielectrics.push_back(judge({scene, 50.0, ""}, gl, table, against, options));
    out.dielectrics.back().random = true;
  }
  for (const CheckScene& check : scenes) {
    const bool timed = options.custom || std::find(std::begin(kTimedScenes), std::end(kTimedScenes),
                                                   check.scene.name) != std::end(kTimedScenes);
    if (timed)
      out.frames.push_back(
          {check.scene.name, gl.frameSeconds(check.scene, kFrameWidth, kFrameHeight, kFrameRepeats)});
  }
  return out;
}

}  // namespace ltcfit

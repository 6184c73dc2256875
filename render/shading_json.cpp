#include "render/shading_json.h"

#include <nlohmann/json.hpp>

#include "export/figure.h"
#include "export/png.h"
#include "render/pictures.h"

namespace ltcfit {
namespace {

using Json = nlohmann::ordered_json;

std::string base64Of(const Film& film) {
  return toBase64(toPng(toPicture(film)));
}

Json tableToJson(const CheckedTable& table) {
  if (table.table == nullptr) return nullptr;
  return {{"name", table.name},
          {"source", table.table->note},
          {"isotropic", table.table->table.isIsotropic()},
          {"precision", isHalf(*table.table) ? "half" : "float"}};
}

Json errorToJson(const PictureError& e) {
  return {{"rmse", figure(e.rmse)},
          {"relative_mse", figure(e.relativeMse)},
          {"psnr", figure(e.psnr)},
          {"largest", figure(e.largest)}};
}

Json clippingToJson(const std::array<double, kHorizonClippings>& clipping) {
  Json out = Json::object();
  for (std::size_t c = 0; c < kHorizonClippings; ++c)
    out[std::string(horizonClippingName(static_cast<HorizonClipping>(c)))] = figure(clipping[c]);
  return out;
}

Json picturesToJson(const SceneCheck& s) {
  if (s.random && !s.lost()) return nullptr;
  Json out{{"ltc", base64Of(s.ltc)},
           {"reference", base64Of(s.reference)},
           {"difference", base64Of(difference(s.ltc, s.reference, kDifferenceGain))}};
  if (s.otherLtc) {
    out["against"] = base64Of(*s.otherLtc);
    out["against_difference"] = base64Of(difference(*s.otherLtc, s.reference, kDifferenceGain));
  }
  return out;
}

Json sceneToJson(const SceneCheck& s) {
  const Scene& scene = s.check.scene;
  const Eigen::Vector2d& alpha = scene.surfaces[0].material.alpha;
  return {{"name", scene.name},
          {"title", scene.title},
          {"random", s.random},
          {"loss", s.check.loss},
          {"alpha", {figure(alpha.x()), figure(alpha.y())}},
          {"gl",
           {{"psnr", figure(s.gl.psnr)},
            {"floor", figure(s.glFloor)},
            {"largest", figure(s.gl.largest)},
            {"non_finite", s.gl.nonFinite},
            {"kinds_differ", s.gl.kindsDiffer},
            {"pixels", s.gl.pixels}}},
          {"passed", s.passed},
          {"reference",
           {{"rmse", figure(s.referenceRmse)},
            {"samples", figure(s.referenceSamples)},
            {"resolved", s.resolved()}}},
          {"error", errorToJson(s.error)},
          {"against", s.other ? errorToJson(*s.other) : Json()},
          {"clipping", s.clipping ? clippingToJson(*s.clipping) : Json()},
          {"explanation", s.explanation},
          {"pictures", picturesToJson(s)}};
}

Json summaryToJson(const RandomSummary& s, bool compared) {
  if (s.scenes == 0) return nullptr;
  const auto comparison = [&](Json value) { return compared ? value : Json(); };
  return {{"scenes", s.scenes},
          {"rmse", figure(s.rmse)},
          {"against_rmse", comparison(figure(s.otherRmse))},
          {"geometric_ratio", comparison(figure(s.geometricRatio))},
          {"closer", comparison(s.closer)},
          {"lost", comparison(s.lost)},
          {"resolved", s.resolved},
          {"reference_rmse", figure(s.referenceRmse)},
          {"clipping", clippingToJson(s.clipping)}};
}

Json costToJson(const ShaderVariantCost& c) {
  Json special = Json::object();
  for (const auto& [name, count] : c.cost.special) special[name] = count;
  return {{"name", c.variant.name},    {"fetches", c.cost.fetches},   {"arithmetic", c.cost.arithmetic},
          {"selects", c.cost.selects}, {"branches", c.cost.branches}, {"special", special},
          {"total", c.cost.total()}};
}

}  // namespace

Json shadingToJson(const CheckedTable& table, const CheckedTable& against, const ShadingCheckOptions& options,
                   const ShadingCheck& check, std::span<const ShaderVariantCost> costs,
                   const std::string& command) {
  Json out{{"format", "ltcfit-shading"},
           {"version", 1},
           {"command", command},
           {"tool_version", LTCFIT_VERSION},
           {"table", tableToJson(table)},
           {"against", tableToJson(against)},
           {"renderer", check.renderer},
           {"options",
            {{"width", options.width},
             {"height", options.height},
             {"random_scenes", options.randomScenes},
             {"random_size", options.randomSize},
             {"seed", options.seed},
             {"max_samples", options.maxSamples}}},
           {"passed", check.passed()}};
  out["scenes"] = Json::array();
  for (const SceneCheck& s : check.scenes) out["scenes"].push_back(sceneToJson(s));
  const bool compared = against.table != nullptr;
  out["random"] = summaryToJson(check.random(), compared);
  out["dielectric"] = summaryToJson(summaryOf(check.dielectrics), compared);
  if (!out["dielectric"].is_null()) out["dielectric"]["f0"] = figure(options.dielectricF0);
  out["cost"] = Json::array();
  for (const ShaderVariantCost& c : costs) out["cost"].push_back(costToJson(c));
  out["frames"] = Json::array();
  for (const FrameTime& frame : check.frames) {
    out["frames"].push_back({{"scene", frame.scene},
                             {"seconds", figure(frame.seconds)},
                             {"width", kFrameWidth},
                             {"height", kFrameHeight}});
  }
  return out;
}

}  // namespace ltcfit

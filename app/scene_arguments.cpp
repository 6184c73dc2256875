#include "app/scene_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "app/commands.h"
#include "app/progress.h"
#include "base/angles.h"
#include "export/atomic_file.h"
#include "scene/read_scene.h"

namespace ltcfit::app {
namespace {

// --lights instead of what the scene says.
LightUse lightsOf(const std::vector<std::string>& kinds) {
  LightUse lights;
  for (const std::string& kind : kinds) {
    lights.polygon |= kind == "polygon";
    lights.disk |= kind == "disk";
    lights.sphere |= kind == "sphere";
    lights.textured |= kind == "textured";
    lights.oneSided |= kind == "one-sided";
    lights.twoSided |= kind == "two-sided";
  }
  lights.reasons.emplace_back("lights as --lights says");
  return lights;
}

}  // namespace

void addPlanOptions(CLI::App& command, SceneArguments& a) {
  command
      .add_option("--max-error", a.request.maxError,
                  "Bound of the mean difference between look-ups and direct fits over the scene's lobes and\n"
                  "views: RMS radiance under random lights of radiance 1; 1e-5..1. Not given: 0.001, or what "
                  "the full\n"
                  "table has where that is more")
      ->check(CLI::Range(1e-5, 1.0))
      ->type_name("E")
      ->capture_default_str();
  command
      .add_option(
          "--max-bytes", a.request.maxBytes,
          "Bound of all texels together, bytes; without --max-error: the best tables within it; 0 = none")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1} << 40))
      ->type_name("B")
      ->capture_default_str();
  command
      .add_option("--margin", a.request.margin,
                  "How far nodes reach beyond the ranges that occur, in roughness and in lambda; 0..1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--alpha-floor", a.request.alphaFloor, "GGX alphas below count as this one; 1e-5..0.1")
      ->check(CLI::Range(1e-5, 0.1))
      ->capture_default_str();
  command
      .add_option("--lights", a.lights,
                  "Lights instead of the scene's, with commas: polygon, disk, sphere, textured, one-sided,\n"
                  "two-sided")
      ->delimiter(',')
      ->check(CLI::IsMember({"polygon", "disk", "sphere", "textured", "one-sided", "two-sided"}))
      ->type_name("KIND,..");
  command
      .add_option(
          "--views", a.views,
          "Angles that surfaces are seen under, from their normal, instead of the scene's: degrees, 0..90")
      ->expected(2)
      ->check(CLI::Range(0.0, 90.0))
      ->type_name("LOW HIGH");
  command.add_option("--seed", a.request.seed, "Seed of the sampled look-ups, 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
  command.add_option("--threads", a.threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

ScenePlan planOf(const CLI::App& command, const SceneArguments& a) {
  PlanRequest request = a.request;
  if (command.count("--max-bytes") > 0 && request.maxBytes > 0 && command.count("--max-error") == 0)
    request.maxError = 0.0;
  request.noStricterThanFull = command.count("--max-error") == 0 && request.maxError > 0.0;
  std::string error;
  if (!request.isValid(&error)) throw InputError("--" + error);
  SceneUse use = readScene(a.scene);
  if (!a.lights.empty()) use.lights = lightsOf(a.lights);
  if (!a.views.empty()) {
    if (!(a.views[0] <= a.views[1])) throw InputError("--views: need two angles, the lower one first");
    use.views = {a.views[0] * kRadiansPerDegree,
                 std::min(a.views[1] * kRadiansPerDegree, 0.5 * std::numbers::pi)};
  }
  Progress progress("plan", a.quiet);
  return planScene(use, request, a.threads,
                   [&](std::size_t done, std::size_t total) { progress.update(done, total); });
}

}  // namespace ltcfit::app

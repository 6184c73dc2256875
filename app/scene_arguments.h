// The options that `ltcfit scene` and `ltcfit fit --scene` share: the scene, and what is asked of its tables.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "tailor/scene_plan.h"

namespace ltcfit::app {

struct SceneArguments {
  std::string scene;
  PlanRequest request;
  std::vector<std::string> lights;  // empty: those of the scene
  std::vector<double> views;        // degrees; empty: those of the scene
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

/// Bounds and floor of the tables, threads, seed: --max-error, --max-bytes, --margin, --alpha-floor, --seed,
/// --lights, --views.
void addPlanOptions(CLI::App& command, SceneArguments& a);

/// Reads the scene and makes its plan, with a progress line. InputError, Refusal.
ScenePlan planOf(const CLI::App& command, const SceneArguments& a);

}  // namespace ltcfit::app

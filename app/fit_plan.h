// ltcfit fit without a subcommand: tables tailored to a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/scene_arguments.h"

namespace ltcfit::app {

struct PlanFitArguments {
  std::string plan;
  SceneArguments scene;  // of --scene, and what it needs
  std::string output;
  std::vector<std::string> full;
  bool verify = false;
};

void addPlanFitOptions(CLI::App& command, PlanFitArguments& a);

/// Returns the exit code.
int fitPlanCommand(const CLI::App& command, const PlanFitArguments& a);

}  // namespace ltcfit::app

// ltcfit scene: what tables a scene needs, and why.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.h"
#include "app/scene_arguments.h"
#include "app/shell_quoted.h"
#include "export/atomic_file.h"
#include "tailor/plan_json.h"
#include "tailor/plan_text.h"

namespace ltcfit::app {
namespace {

struct Arguments : SceneArguments {
  std::string output;
};

int plan(const CLI::App& command, const Arguments& a) {
  if (!a.output.empty()) {
    if (isSameFile(a.output, a.scene)) throw InputError(a.output + ": is the scene itself");
    checkWritable(a.output);
  }
  const ScenePlan plan = planOf(command, a);
  const std::string json = planToJson(plan);
  const bool reachable =
      std::all_of(plan.tables.begin(), plan.tables.end(), [](const PlannedTable& t) { return t.reachable; });
  if (!a.output.empty()) writeFileAtomically(a.output, json);
  if (a.json) {
    fmt::print("{}", json);
  } else if (!a.quiet) {
    fmt::print("{}", planText(plan));
    if (!a.output.empty())
      fmt::print("wrote {}{}\n", a.output,
                 plan.tables.empty() || !reachable
                     ? ""
                     : fmt::format("; next: ltcfit fit --plan {} -o NAME.json", shellQuoted(a.output)));
  }
  return reachable ? kExitOk : kExitQuality;
}

}  // namespace

void addSceneCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "scene", "Look at a scene's materials and lights: which tables it needs, of what size, and why");
  auto a = std::make_shared<Arguments>();
  command
      ->add_option(
          "scene", a->scene,
          "Scene: glTF 2.0 (.gltf, .glb), or a description (JSON, data/scenes/ltc-scene.schema.json)")
      ->required()
      ->type_name("SCENE");
  command->add_option("-o,--output", a->output, "Plan to write, for ltcfit fit --plan")
      ->type_name("plan.json");
  addPlanOptions(*command, *a);
  command->add_flag("--json", a->json, "Print the plan as JSON");
  command->add_flag("-q,--quiet", a->quiet, "Print nothing but errors");
  command->footer(
      "Takes some thousand fits: ten to thirty seconds on two cores. Exit code 3: a bound is out of reach; "
      "the plan\nis written all the same.");
  command->callback([a, command, &status] { status.exitCode = plan(*command, *a); });
}

}  // namespace ltcfit::app

// ltcfit fit: iso, aniso, entry.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/axes_argument.h"
#include "app/commands.h"
#include "app/fit_runs.h"
#include "export/atomic_file.h"
#if LTCFIT_SCENE
#include "app/fit_plan.h"
#endif

namespace ltcfit::app {
namespace {

void checkOutputs(const FitArguments& a) {
  checkWritable(a.output);
  const auto file = [](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  if (!a.reportPath.empty() &&
      (file(a.reportPath) == file(a.output) || file(a.reportPath) == file(a.output + ".part") ||
       file(a.reportPath) == file(a.output + ".refine.part"))) {
    throw InputError(a.reportPath + ": --output (or its .part) and --report name the same file");
  }
  if (!a.reportPath.empty()) checkWritable(a.reportPath);
}

template <class Options>
Options valid(Options options) {
  std::string error;
  if (!options.isValid(&error)) throw InputError(error);
  return options;
}

int fitIso(const CLI::App& command, const FitArguments& a) {
  checkFitArguments(command, a);
  const std::vector<std::size_t> size = parseSize(a.size, 2);
  IsotropicTableOptions o;
  o.thetaNodes = size[0];
  o.alphaNodes = size[1];
  o.axes = parseIsotropicAxes(a.axes);
  o.alphaFloor = a.alphaFloor;
  o.thetaMax = a.thetaMax;
  o = valid(o);
  checkOutputs(a);
  requireFitMemory(a, size[0] * size[1]);
  return isWarmStartedL3(a) ? fitIsotropicL3(a, o) : fitTableCommand(a, planIsotropicTable(o));
}

int fitAniso(const CLI::App& command, const FitArguments& a) {
  checkFitArguments(command, a);
  const std::vector<std::size_t> size = parseSize(a.size, 4);
  AnisotropicTableOptions o;
  o.alphaNodes = size[0];
  o.lambdaNodes = size[1];
  o.thetaNodes = size[2];
  o.phiNodes = size[3];
  o.axes = parseAnisotropicAxes(a.axes);
  o.alphaFloor = a.alphaFloor;
  o.thetaMax = a.thetaMax;
  o = valid(o);
  checkOutputs(a);
  requireFitMemory(a, size[0] * size[1] * size[2] * size[3]);
  const SymmetryMode symmetry = symmetryOf(a);
  return fitTableCommand(a, planAnisotropicTable(o, symmetry));
}

void addAxes(CLI::App& command, FitArguments& a, const char* layouts) {
  command
      .add_option("--axes", a.axes,
                  fmt::format("Where the nodes lie. {}\n"
                              "(map and warp: t = s + s (1 - s) (A + B (1 - 2 s)), A > 0 moves nodes to the\n"
                              "low end, B > 0 to both ends). Maps: linear; sqrt, of alpha and lambda;\n"
                              "sqrt-one-minus-cos, of angles; knots:V0:V1:... anywhere (angles in degrees),\n"
                              "which no look-up for shaders is made for: it would have to search them",
                              layouts))
      ->type_name("AXES")
      ->capture_default_str();
}

void addIso(CLI::App& fit, CommandStatus& status) {
  CLI::App* const command = fit.add_subcommand("iso", "Fit the isotropic table (theta, alpha)");
  auto a = std::make_shared<FitArguments>();
  a->kind = FitKind::kIsotropic;
  a->size = "64x64";
  a->axes = kIsotropicAxes;
  a->scorePoints = 64;
  addTableOptions(*command, *a);
  command
      ->add_option(
          "--size", a->size,
          "Nodes along theta and alpha, 2..1024; alpha up to 100 with the default floor, 317 with 1e-5")
      ->type_name("THETAxALPHA")
      ->capture_default_str();
  addAxes(*command, *a,
          "2017: sqrt(1 - cos theta), what engines read; 2016: theta, linear; both with\n"
          "sqrt(alpha). best: of least error, for --layout lean and the look-up that export makes. Or a\n"
          "list of axes that differ from 2017, as theta=linear:0.3:-0.1");
  command
      ->add_option("--alpha-floor", a->alphaFloor,
                   "GGX alpha of the nodes at sqrt(alpha) = 0; 1e-5 to below the second node's")
      ->capture_default_str();
  addFitterOptions(*command, *a);
  command
      ->add_option("--family", a->family,
                   "l3: free parameters of a matrix: 4 = [a 0 b; 0 c 0; d 0 1] (the paper, eq. 6);\n"
                   "3 = in the frame of the mean direction (its authors' code, the 2017 table)")
      ->check(CLI::IsMember({"3", "4"}))
      ->capture_default_str();
  command->add_flag("--json", a->json, "Print the summary as JSON");
  command->callback([a, command, &status] { status.exitCode = fitIso(*command, *a); });
}

void addAniso(CLI::App& fit, CommandStatus& status) {
  CLI::App* const command = fit.add_subcommand(
      "aniso", "Fit the anisotropic table (alpha, lambda = alpha_y / alpha_x, theta, phi)");
  auto a = std::make_shared<FitArguments>();
  a->kind = FitKind::kAnisotropic;
  a->size = "8x8x8x8";
  a->axes = kAnisotropicAxes;
  addTableOptions(*command, *a);
  command->add_option("--size", a->size, "Nodes along alpha, lambda, theta and phi, 2..64 each")
      ->type_name("ALPHAxLAMBDAxTHETAxPHI")
      ->capture_default_str();
  command
      ->add_option("--alpha-floor", a->alphaFloor,
                   "Smallest GGX alpha_x and alpha_y; 1e-5 to below the second node's alpha")
      ->capture_default_str();
  addAxes(*command, *a,
          "2022: alpha, lambda, theta, phi, all linear. best: of least error, for --layout lean and the\n"
          "look-up that export makes. Or a list of axes that differ from 2022, as\n"
          "alpha=sqrt,theta=linear:0.3:-0.1");
  addFitterOptions(*command, *a);
  command
      ->add_option("--symmetry", a->symmetry,
                   "during: each lobe is fitted among the matrices of its symmetry, equal lobes once;\n"
                   "after: all nodes freely, then the symmetries are enforced (shows what that costs)")
      ->check(CLI::IsMember({"during", "after"}))
      ->capture_default_str();
  command->add_flag("--json", a->json, "Print the summary as JSON");
  command->callback([a, command, &status] { status.exitCode = fitAniso(*command, *a); });
}

void addEntry(CLI::App& fit, CommandStatus& status) {
  CLI::App* const command = fit.add_subcommand("entry", "Fit one lobe and print its matrix, error and time");
  auto a = std::make_shared<EntryArguments>();
  a->fit.kind = FitKind::kEntry;
  command->add_option("--alpha-x", a->alphaX, "GGX alpha along x, 1e-5..1")
      ->check(CLI::Range(1e-5, 1.0))
      ->required();
  command->add_option("--alpha-y", a->alphaY, "GGX alpha along y, 1e-5..1")
      ->check(CLI::Range(1e-5, 1.0))
      ->default_str("as --alpha-x");
  command->add_option("--theta", a->theta, "View angle from the normal, degrees, 0..90")
      ->check(CLI::Range(0.0, 90.0))
      ->capture_default_str();
  command->add_option("--phi", a->phi, "Azimuth of the view, degrees, 0..90")
      ->check(CLI::Range(0.0, 90.0))
      ->capture_default_str();
  addFitterOptions(*command, a->fit);
  command->add_flag("--json", a->fit.json, "Print JSON");
  command->callback([a, command, &status] {
    checkFitArguments(*command, a->fit);
    status.exitCode = fitEntryCommand(*a);
  });
}

}  // namespace

void addFitCommand(CLI::App& app, CommandStatus& status) {
#if LTCFIT_SCENE
  CLI::App* const fit =
      app.add_subcommand("fit", "Fit a table, or a single lobe; with --plan or --scene, what a scene needs");
  fit->require_subcommand(0, 1);
  auto a = std::make_shared<PlanFitArguments>();
  addPlanFitOptions(*fit, *a);
  fit->callback([a, fit, &status] {
    if (fit->get_subcommands().empty()) status.exitCode = fitPlanCommand(*fit, *a);
  });
#else
  CLI::App* const fit = app.add_subcommand("fit", "Fit a table, or a single lobe");
  fit->require_subcommand(1);
#endif
  addIso(*fit, status);
  addAniso(*fit, status);
  addEntry(*fit, status);
  for (CLI::App* const subcommand : fit->get_subcommands({})) {
    for (CLI::Option* const option : fit->get_options()) {
      if (option != fit->get_help_ptr()) subcommand->excludes(option);
    }
  }
}

}  // namespace ltcfit::app

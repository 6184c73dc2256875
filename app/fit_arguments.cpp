#include "app/fit_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <variant>

#include "app/axes_argument.h"
#include "app/commands.h"
#include "app/memory.h"
#include "app/refinement_run.h"
#include "app/shell_quoted.h"
#include "base/angles.h"
#include "base/parallel_for.h"
#include "export/atomic_file.h"
#include "fit/fit_provenance.h"
#include "fit/memory_estimate.h"

namespace ltcfit::app {
namespace {

TableKind kindOf(const FitArguments& a) {
  return a.kind == FitKind::kIsotropic ? TableKind::kIsotropic : TableKind::kAnisotropic;
}

LobeFitOptions defaultsOf(const FitArguments& a, std::string_view fitter) {
  return tableFitPreset(kindOf(a), fitterFromName(fitter));
}

[[noreturn]] void refuse(const std::string& message) {
  throw InputError(message);
}

}  // namespace

std::string presetOf(const FitArguments& a) {
  return a.preset.empty() ? std::string(defaultPreset(kindOf(a), fitterFromName(a.fitter))) : a.preset;
}

double leakWeightOf(const FitArguments& a) {
  if (a.leakWeight) return *a.leakWeight;
  const LobeFitOptions defaults = defaultsOf(a, a.fitter);
  return a.fitter == "light" ? defaults.light.leakWeight : defaults.sw.leakWeight;
}

double sizeExponentOf(const FitArguments& a) {
  return a.sizeExponent.value_or(defaultsOf(a, "light").light.lights.sizeExponent);
}

void addFitterOptions(CLI::App& command, FitArguments& a) {
  command
      .add_option("--fitter", a.fitter,
                  "light: least squares over polygon lights, what a renderer computes;\n"
                  "sw: sliced-Wasserstein distance, quasi-Newton;\n"
                  "sw-sgd: the same by stochastic descent (KT et al. 2022);\n"
                  "l3: Nelder-Mead on the L3 error (Heitz et al. 2016)")
      ->check(CLI::IsMember({"light", "sw", "sw-sgd", "l3"}))
      ->capture_default_str();
  command
      .add_option(
          "--preset", a.preset,
          "Effort. light, sw: fast, standard or fine; sw-sgd: quick or paper (10,000 steps of 2048 samples\n"
          "and 64 directions: 17 CPU seconds an entry)")
      ->check(CLI::IsMember({"fast", "standard", "fine", "quick", "paper"}))
      ->default_str(a.kind == FitKind::kIsotropic ? "fast; quick" : "standard; quick");
  command
      .add_option("--samples", a.samples,
                  "Directions of the LTC (and, for sw-sgd and l3, as many of the lobe); 16..1048576")
      ->check(CLI::Range(16, 1 << 20))
      ->default_str(fmt::format("of the preset; l3: {}", EntryFitOptions{}.samples));
  command.add_option("--directions", a.directions, "Projections of sw and sw-sgd; 4..65536")
      ->check(CLI::Range(4, 65536))
      ->default_str("of the preset");
  command
      .add_option(
          "--leak-weight", a.leakWeight,
          "Weight of mass below the horizon: light: in units of the light error; sw: in units of the\n"
          "lobe's width; 0..100")
      ->check(CLI::Range(0.0, 100.0))
      ->default_str(fmt::format("light: {}; sw: {}", defaultsOf(a, "light").light.leakWeight,
                                defaultsOf(a, "sw").sw.leakWeight));
  command
      .add_option(
          "--weighting", a.weighting,
          "light: what a difference counts: absolute, relative to the light (down to 1 % of the lobe), or\n"
          "mixed (its square root)")
      ->check(CLI::IsMember({"absolute", "relative", "mixed"}))
      ->capture_default_str();
  command
      .add_option("--size-exponent", a.sizeExponent,
                  "light: differences of a light of half-size s count s^-X: more favours small lights; -4..4")
      ->check(CLI::Range(-4.0, 4.0))
      ->type_name("X")
      ->default_str(fmt::format("{}", sizeExponentOf(a)));
  command.add_option("--lights", a.lights, "Lights of light, for each entry; 16..65536")
      ->check(CLI::Range(16, 65536))
      ->default_str("of the preset");
  command
      .add_option("--max-evaluations", a.maxEvaluations,
                  "l3: evaluations of the error for one try at one entry, 1..1000000")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--seed", a.seed, "Seed of the sample points, 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
}

void addTableOptions(CLI::App& command, FitArguments& a) {
  command.add_option("-o,--output", a.output, "Table file to write (JSON)")
      ->required()
      ->type_name("FILE.json");
  command
      .add_option(
          "--theta-max", a.thetaMax,
          "View angle of the last nodes, radians; up to pi/2, which needs no clamp (2017 table: 1.57,\n"
          "2022: 1.57064)")
      ->type_name("RAD")
      ->default_str("pi/2");
  command.add_option("--threads", a.threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command.add_flag(
      "--resume", a.resume,
      "Go on from FILE.json.part, which an interrupted run left; the result is the same. With --refine\n"
      "also from FILE.json.refine.part: then as good, but not the same bytes");
  command
      .add_option("--report", a.reportPath, "Also write a CSV with one line for each entry: how its fit went")
      ->type_name("FILE.csv");
  command.add_flag("--refine", a.refine,
                   "Then move all entries together, so that what is read between nodes is best: the same as\n"
                   "ltcfit refine on the fitted table, which is not written itself");
  command
      .add_option("--refine-points", a.refinePoints,
                  "refine: look-ups that the table is fitted for, 16..4194304")
      ->capture_default_str();
  command.add_option("--refine-iterations", a.refineIterations, "refine: at most so many steps, 1..1000")
      ->capture_default_str();
  command.add_option("--score-points", a.scorePoints, "Points of the error figures in the summary; 0 = none")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command.add_flag("-q,--quiet", a.quiet, "Print nothing but errors");
}

void requireFitMemory(const FitArguments& a, std::size_t nodes) {
  const auto threads = static_cast<std::size_t>(threadCount(a.threads));
  const double fits =
      static_cast<double>(std::min(threads, nodes)) * lobeFitBytes(toFitOptions(a), kindOf(a));
  const double entries = static_cast<double>(nodes) * nodeFitBytes(kindOf(a));
  requireMemory(fits + entries, "fit: the fits and the table's entries",
                fits < entries        ? "lower --size"
                : a.fitter == "light" ? "lower --lights or --threads"
                : a.fitter == "l3"    ? "lower --samples or --threads"
                                      : "lower --samples, --directions or --threads");
  if (a.refine) requireRefinementMemory(a.refinePoints, nodes, "--refine-points");
}

SymmetryMode symmetryOf(const FitArguments& a) {
  return a.symmetry == "after" ? SymmetryMode::kAfter : SymmetryMode::kDuring;
}

bool isWarmStartedL3(const FitArguments& a) {
  return a.kind == FitKind::kIsotropic && a.fitter == "l3";
}

void checkFitArguments(const CLI::App& command, const FitArguments& a) {
  const auto given = [&](const char* option) {
    const CLI::Option* const found = command.get_option_no_throw(option);
    return found != nullptr && found->count() > 0;
  };
  if (!std::isfinite(leakWeightOf(a))) refuse("--leak-weight must be a number in 0..100");
  if (!std::isfinite(sizeExponentOf(a))) refuse("--size-exponent must be a number in -4..4");
  const bool light = a.fitter == "light";
  const bool sw = a.fitter == "sw" || light;
  const bool sgd = a.fitter == "sw-sgd";
  const bool l3 = a.fitter == "l3";
  if (l3 && given("--preset")) refuse("--preset needs --fitter light, sw or sw-sgd");
  if (sw && (a.preset == "quick" || a.preset == "paper"))
    refuse("--preset " + a.preset + " needs --fitter sw-sgd; light and sw have fast, standard and fine");
  if (sgd && given("--preset") && a.preset != "quick" && a.preset != "paper")
    refuse("--preset " + a.preset + " needs --fitter light or sw; sw-sgd has quick and paper");
  if ((l3 || light) && given("--directions")) refuse("--directions needs --fitter sw or sw-sgd");
  if (light && given("--samples")) refuse("--samples needs --fitter sw, sw-sgd or l3; light has --lights");
  if (!sw && given("--leak-weight")) refuse("--leak-weight needs --fitter light or sw");
  for (const char* const option : {"--weighting", "--size-exponent", "--lights"}) {
    if (!light && given(option)) refuse(std::string(option) + " needs --fitter light");
  }
  if (!l3 && given("--max-evaluations")) refuse("--max-evaluations needs --fitter l3");
  if (!l3 && a.family != "4")
    refuse("--family " + a.family + " needs --fitter l3: the others fit all 4 parameters");
  for (const char* const option : {"--refine-points", "--refine-iterations"})
    if (!a.refine && given(option)) refuse(std::string(option) + " needs --refine");
  if (a.refine)
    refinementOptions(a.kind == FitKind::kIsotropic, a.refinePoints, a.refineIterations, a.seed, a.threads,
                      "refine-");
  if (isWarmStartedL3(a) && a.resume && !a.refine)
    refuse("--resume needs --fitter light, sw or sw-sgd: the l3 fit of an isotropic table takes seconds");
}

std::vector<std::size_t> parseSize(const std::string& text, std::size_t count) {
  std::vector<std::size_t> out;
  const char* p = text.data();
  const char* const end = p + text.size();
  while (p < end && text.size() < 24) {
    std::size_t n = 0;
    const auto number = std::from_chars(p, end, n);
    if (number.ec != std::errc()) break;
    out.push_back(n);
    p = number.ptr;
    if (p < end && *p == 'x' && p + 1 < end) {
      ++p;
    } else {
      break;
    }
  }
  if (p != end || out.size() != count) {
    refuse("--size '" + text + "': need " +
           (count == 2 ? "THETAxALPHA, for example 64x64" : "ALPHAxLAMBDAxTHETAxPHI, for example 8x8x8x8"));
  }
  return out;
}

TableFitOptions toFitOptions(const FitArguments& a) {
  const bool preset = a.fitter != "l3" && !a.preset.empty();
  TableFitOptions o{tableFitPreset(kindOf(a), fitterFromName(a.fitter), preset ? a.preset : ""), a.threads};
  o.setSeed(static_cast<std::uint64_t>(a.seed));
  if (a.fitter == "light") {
    if (a.lights > 0) o.light.lights.lights = a.lights;
    o.light.lights.weighting = lightWeightingFromName(a.weighting);
    o.light.lights.sizeExponent = sizeExponentOf(a);
    o.light.leakWeight = leakWeightOf(a);
  }
  if (a.fitter == "sw") {
    o.sw.leakWeight = leakWeightOf(a);
    if (a.samples > 0) o.sw.levels.back().samples = a.samples;
    if (a.directions > 0) o.sw.levels.back().slices = a.directions;
  }
  if (a.fitter == "sw-sgd") {
    if (a.samples > 0) o.sgd.samples = a.samples;
    if (a.directions > 0) o.sgd.slices = a.directions;
  }
  if (a.samples > 0) o.l3.samples = a.samples;
  o.l3.nelderMead.maxEvaluations = a.maxEvaluations;
  o.l3.family = a.family == "3" ? IsotropicFamily::kMeanFrame3 : IsotropicFamily::kPlane4;
  std::string error;
  if (!o.isValid(&error)) refuse(error);
  return o;
}

Provenance makeProvenance(const FitArguments& a) {
  const bool iso = a.kind == FitKind::kIsotropic;
  Provenance p;
  p.tool = "ltcfit";
  p.toolVersion = LTCFIT_VERSION;
  p.seed = a.seed;
  p.options = {{"size", a.size}};
  if (iso || a.axes != kAnisotropicAxes) p.options.emplace_back("axes", a.axes);
  const FitRecipe recipe{kindOf(a), a.preset, toFitOptions(a), symmetryOf(a)};
  for (auto& option : provenanceOptions(recipe)) p.options.push_back(std::move(option));
  p.options.emplace_back("alpha_floor", a.alphaFloor);
  if (a.thetaMax != kHalfPi) p.options.emplace_back("theta_max", a.thetaMax);
  p.command = fmt::format("ltcfit fit {}", iso ? "iso" : "aniso");
  for (const auto& [name, value] : p.options) {
    std::string flag = name;
    std::replace(flag.begin(), flag.end(), '_', '-');
    p.command += fmt::format(
        " --{} {}", flag, shellQuoted(std::visit([](const auto& v) { return fmt::format("{}", v); }, value)));
  }
  p.command += fmt::format(" --seed {}", a.seed);
  return p;
}

}  // namespace ltcfit::app

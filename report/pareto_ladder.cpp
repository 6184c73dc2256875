#include "report/pareto_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ltcfit {
namespace {

// Seconds a unit of work, on a core of an AMD EPYC with the release preset: a light; a sample of the LTC on a
// direction, over a whole descent; a sample and evaluation; a sample, direction and step.
constexpr double kSecondsALight = 9e-6;
constexpr double kSecondsAProjection = 25e-9;
constexpr double kSecondsAnL3Sample = 6.4e-9;
constexpr double kSecondsASgdProjection = 13e-9;

FitSetting lightSetting(const LobeFitOptions& o) {
  const int lights = o.light.lights.lights;
  return {.fitter = "light",
          .name = fmt::format("{} lights", lights),
          .effort = {{"lights", lights}},
          .preset = {},
          .options = o};
}

FitSetting slicedSetting(const LobeFitOptions& o) {
  std::string name;
  for (const SlicedWassersteinLevel& l : o.sw.levels)
    name += fmt::format("{}{} x {}", name.empty() ? "" : " + ", l.samples, l.slices);
  const SlicedWassersteinLevel& last = o.sw.levels.back();
  return {.fitter = "sw",
          .name = name,
          .effort = {{"levels", static_cast<double>(o.sw.levels.size())},
                     {"samples", last.samples},
                     {"directions", last.slices},
                     {"target_samples", last.targetSamples}},
          .preset = {},
          .options = o};
}

FitSetting sgdSetting(const LobeFitOptions& o) {
  return {.fitter = "sw-sgd",
          .name = fmt::format("{} steps, {} x {}", o.sgd.steps, o.sgd.samples, o.sgd.slices),
          .effort = {{"steps", o.sgd.steps}, {"samples", o.sgd.samples}, {"directions", o.sgd.slices}},
          .preset = {},
          .options = o};
}

FitSetting l3Setting(const LobeFitOptions& o) {
  const int evaluations = o.l3.nelderMead.maxEvaluations;
  return {.fitter = "l3",
          .name = fmt::format("{} samples, {} evaluations", o.l3.samples, evaluations),
          .effort = {{"samples", o.l3.samples}, {"evaluations", evaluations}},
          .preset = {},
          .options = o};
}

FitSetting settingOf(const LobeFitOptions& o) {
  switch (o.fitter) {
    case Fitter::kLight:
      return lightSetting(o);
    case Fitter::kSlicedWassersteinSgd:
      return sgdSetting(o);
    case Fitter::kL3:
      return l3Setting(o);
    case Fitter::kSlicedWasserstein:
      break;
  }
  return slicedSetting(o);
}

// The rungs of one fitter: its presets, and what lies between and beyond them.
class Rungs {
 public:
  Rungs(TableKind kind, Fitter fitter) : kind_(kind), fitter_(fitter) {}

  void addPreset(std::string_view name) {
    FitSetting s = settingOf(tableFitPreset(kind_, fitter_, name));
    s.preset = name;
    s.isDefault = fitter_ == kDefaultFitter && name == defaultPreset(kind_, fitter_);
    settings_.push_back(std::move(s));
  }

  /// `change` makes it out of the default preset; nothing where there is such a rung already.
  template <class Change>
  void add(const Change& change) {
    LobeFitOptions o = tableFitPreset(kind_, fitter_);
    change(o);
    FitSetting s = settingOf(o);
    if (std::none_of(settings_.begin(), settings_.end(),
                     [&](const FitSetting& other) { return other.effort == s.effort; }))
      settings_.push_back(std::move(s));
  }

  void moveTo(std::vector<FitSetting>& out) {
    std::stable_sort(settings_.begin(), settings_.end(), [](const FitSetting& a, const FitSetting& b) {
      return nominalSeconds(a) < nominalSeconds(b);
    });
    std::move(settings_.begin(), settings_.end(), std::back_inserter(out));
  }

 private:
  TableKind kind_;
  Fitter fitter_;
  std::vector<FitSetting> settings_;
};

}  // namespace

double nominalSeconds(const FitSetting& setting) {
  if (!setting.fits()) return 0.0;
  const LobeFitOptions& o = setting.options;
  switch (o.fitter) {
    case Fitter::kLight:
      return kSecondsALight * o.light.lights.lights;
    case Fitter::kSlicedWassersteinSgd:
      return kSecondsASgdProjection * o.sgd.steps * o.sgd.samples * o.sgd.slices;
    case Fitter::kL3:
      return kSecondsAnL3Sample * o.l3.samples * o.l3.nelderMead.maxEvaluations;
    case Fitter::kSlicedWasserstein:
      break;
  }
  double seconds = 0.0;
  for (const SlicedWassersteinLevel& l : o.sw.levels) seconds += kSecondsAProjection * l.samples * l.slices;
  return seconds;
}

std::vector<FitSetting> paretoLadder(TableKind kind) {
  std::vector<FitSetting> ladder;
  ladder.push_back({.fitter = "moments",
                    .name = "the start",
                    .effort = {},
                    .preset = {},
                    .options = tableFitPreset(kind, kDefaultFitter)});

  Rungs light(kind, Fitter::kLight);
  for (const char* const preset : {"fast", "standard", "fine"}) light.addPreset(preset);
  for (const int lights : {64, 128, 256, 512, 1024, 2048, 4096, 8192})
    light.add([&](LobeFitOptions& o) { o.light.lights.lights = lights; });
  light.moveTo(ladder);

  Rungs sw(kind, Fitter::kSlicedWasserstein);
  for (const char* const preset : {"fast", "standard", "fine"}) sw.addPreset(preset);
  const SlicedWassersteinLevel coarse{.samples = 512, .slices = 24, .targetSamples = 2048};
  const SlicedWassersteinLevel middle{.samples = 2048, .slices = 96, .targetSamples = 8192};
  const SlicedWassersteinLevel large{.samples = 4096, .slices = 128, .targetSamples = 16384};
  using Levels = std::vector<SlicedWassersteinLevel>;
  for (const Levels& levels : {Levels{coarse}, Levels{middle}, Levels{coarse, middle}, Levels{coarse, large}})
    sw.add([&](LobeFitOptions& o) { o.sw.levels = levels; });
  sw.moveTo(ladder);

  Rungs l3(kind, Fitter::kL3);
  l3.addPreset("");
  for (const auto [samples, evaluations] : {std::array{256, 100},
                                            {256, 300},
                                            {256, 1000},
                                            {1024, 100},
                                            {1024, 300},
                                            {1024, 1000},
                                            {4096, 300},
                                            {4096, 1000}}) {
    l3.add([&, n = samples, most = evaluations](LobeFitOptions& o) {
      o.l3.samples = n;
      o.l3.nelderMead.maxEvaluations = most;
    });
  }
  l3.moveTo(ladder);

  Rungs sgd(kind, Fitter::kSlicedWassersteinSgd);
  for (const char* const preset : {"quick", "paper"}) sgd.addPreset(preset);
  for (const auto [steps, samples, slices] :
       {std::array{100, 512, 16}, {300, 512, 32}, {3000, 1024, 32}, {3000, 2048, 64}}) {
    sgd.add([&, s = steps, n = samples, w = slices](LobeFitOptions& o) {
      o.sgd.steps = s;
      o.sgd.samples = n;
      o.sgd.slices = w;
    });
  }
  sgd.moveTo(ladder);
  return ladder;
}

FitShare shareOf(const FitSetting& setting, std::size_t entries, std::size_t repeats) {
  LobeFitOptions paper;
  paper.fitter = Fitter::kSlicedWassersteinSgd;
  paper.sgd = paperSgdOptions();
  const double most = 2.0 * nominalSeconds(sgdSetting(paper));
  const double each = nominalSeconds(setting);
  if (each * static_cast<double>(entries * repeats) <= most) return {entries, repeats};
  const std::size_t fits = std::max<std::size_t>(2, static_cast<std::size_t>(most / each));
  const std::size_t share = std::min(entries, fits);
  return {share, std::clamp<std::size_t>(fits / share, 1, repeats)};
}

}  // namespace ltcfit

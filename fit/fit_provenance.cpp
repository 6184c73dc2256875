#include "fit/fit_provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/refusal.h"

namespace ltcfit {
namespace {

using Value = Provenance::Value;

constexpr std::int64_t kLargestSeed = std::int64_t{1} << 53;

const char* symmetryName(SymmetryMode symmetry) {
  return symmetry == SymmetryMode::kAfter ? "after" : "during";
}

const Value* find(const Provenance& provenance, std::string_view name) {
  for (const auto& [key, value] : provenance.options)
    if (key == name) return &value;
  return nullptr;
}

std::string shown(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return fmt::format("'{:.40}'", *text);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* number = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *number);
  return std::get<bool>(value) ? "true" : "false";
}

std::optional<double> numberOf(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  return std::nullopt;
}

// Reads option after option into a recipe; one that makes it invalid changes nothing and leaves a note.
class Reader {
 public:
  explicit Reader(const TableInfo& info) : provenance_(info.provenance) {
    out_.recipe.kind = info.axes.size() == 2 ? TableKind::kIsotropic : TableKind::kAnisotropic;
  }

  RecordedFit read() {
    FitRecipe& recipe = out_.recipe;
    const bool isotropic = recipe.kind == TableKind::kIsotropic;
    Fitter fitter = isotropic ? Fitter::kL3 : Fitter::kSlicedWasserstein;
    std::string preset;
    text("fitter", [&](const std::string& name) {
      fitter = fitterFromName(name);
      out_.hasFitter = true;
    });
    recipe.fit = tableFitPreset(recipe.kind, fitter);
    text("preset", [&](const std::string& name) {
      recipe.fit = tableFitPreset(recipe.kind, fitter, name);
      recipe.preset = name;
    });
    switch (fitter) {
      case Fitter::kL3:
        if (isotropic)
          text("family", [&](const std::string& name) { recipe.fit.l3.family = familyFrom(name); });
        count("samples", [](LobeFitOptions& o) -> int& { return o.l3.samples; });
        count("max_evaluations", [](LobeFitOptions& o) -> int& { return o.l3.nelderMead.maxEvaluations; });
        break;
      case Fitter::kSlicedWasserstein:
        count("samples", [](LobeFitOptions& o) -> int& { return o.sw.levels.back().samples; });
        count("directions", [](LobeFitOptions& o) -> int& { return o.sw.levels.back().slices; });
        number("leak_weight", [](LobeFitOptions& o) -> double& { return o.sw.leakWeight; });
        break;
      case Fitter::kSlicedWassersteinSgd:
        count("samples", [](LobeFitOptions& o) -> int& { return o.sgd.samples; });
        count("directions", [](LobeFitOptions& o) -> int& { return o.sgd.slices; });
        break;
      case Fitter::kLight:
        count("lights", [](LobeFitOptions& o) -> int& { return o.light.lights.lights; });
        text("weighting", [&](const std::string& name) {
          recipe.fit.light.lights.weighting = lightWeightingFromName(name);
        });
        number("size_exponent", [](LobeFitOptions& o) -> double& { return o.light.lights.sizeExponent; });
        number("leak_weight", [](LobeFitOptions& o) -> double& { return o.light.leakWeight; });
        break;
    }
    if (!isotropic) text("symmetry", [&](const std::string& name) { recipe.symmetry = symmetryFrom(name); });
    readSeed();
    return std::move(out_);
  }

 private:
  static IsotropicFamily familyFrom(const std::string& name) {
    for (const IsotropicFamily family : {IsotropicFamily::kPlane4, IsotropicFamily::kMeanFrame3})
      if (name == familyName(family)) return family;
    throw Refusal("");
  }
  static SymmetryMode symmetryFrom(const std::string& name) {
    for (const SymmetryMode mode : {SymmetryMode::kDuring, SymmetryMode::kAfter})
      if (name == symmetryName(mode)) return mode;
    throw Refusal("");
  }

  void refuse(std::string_view name, const Value& value) {
    out_.notes.push_back(
        fmt::format("provenance.options.{}: no fit has {}; the default is taken", name, shown(value)));
  }

  // `take` throws Refusal for a text that it does not know.
  template <class Take>
  void text(std::string_view name, const Take& take) {
    const Value* const value = find(provenance_, name);
    if (value == nullptr) return;
    try {
      if (!std::holds_alternative<std::string>(*value)) throw Refusal("");
      take(std::get<std::string>(*value));
    } catch (const Refusal&) {
      refuse(name, *value);
    }
  }

  // The value of type T becomes `field` of the options, if these are valid with it.
  template <class T, class Field>
  void set(std::string_view name, const Value& value, std::optional<T> given, const Field& field) {
    LobeFitOptions changed = out_.recipe.fit;
    if (given) field(changed) = *given;
    std::string ignored;
    if (given && changed.isValid(&ignored)) {
      out_.recipe.fit = std::move(changed);
    } else {
      refuse(name, value);
    }
  }

  template <class Field>
  void number(std::string_view name, const Field& field) {
    const Value* const value = find(provenance_, name);
    if (value != nullptr) set<double>(name, *value, numberOf(*value), field);
  }

  template <class Field>
  void count(std::string_view name, const Field& field) {
    const Value* const value = find(provenance_, name);
    if (value == nullptr) return;
    const double most = std::numeric_limits<int>::max();
    const std::optional<double> given = numberOf(*value);
    const bool whole = given && std::abs(*given) <= most && std::floor(*given) == *given;
    set<int>(name, *value, whole ? std::optional<int>(static_cast<int>(*given)) : std::nullopt, field);
  }

  void readSeed() {
    if (!out_.hasFitter) return;
    std::int64_t seed = provenance_.seed;
    // of a table that was refined with another seed
    if (const Value* const value = find(provenance_, "fit_seed")) {
      if (const auto* given = std::get_if<std::int64_t>(value)) {
        seed = *given;
      } else {
        refuse("fit_seed", *value);
      }
    }
    if (seed < 0 || seed > kLargestSeed) {
      out_.notes.push_back(fmt::format("provenance.seed: no fit has {}; 1 is taken", seed));
      seed = 1;
    }
    out_.recipe.fit.setSeed(static_cast<std::uint64_t>(seed));
  }

  const Provenance& provenance_;
  RecordedFit out_;
};

}  // namespace

std::vector<std::pair<std::string, Value>> provenanceOptions(const FitRecipe& recipe) {
  const LobeFitOptions& fit = recipe.fit;
  const bool isotropic = recipe.kind == TableKind::kIsotropic;
  const std::string preset(recipe.preset.empty() ? defaultPreset(recipe.kind, fit.fitter) : recipe.preset);
  const LobeFitOptions usual = tableFitPreset(recipe.kind, fit.fitter, preset);
  std::vector<std::pair<std::string, Value>> out;
  const auto add = [&](const char* name, Value value) { out.emplace_back(name, std::move(value)); };
  const auto addUnusual = [&](const char* name, int value, int usualValue) {
    if (value != usualValue) add(name, std::int64_t{value});
  };
  add("fitter", std::string(fitterName(fit.fitter)));
  if (!preset.empty()) add("preset", preset);
  switch (fit.fitter) {
    case Fitter::kL3:
      if (isotropic) add("family", std::string(familyName(fit.l3.family)));
      add("samples", std::int64_t{fit.l3.samples});
      addUnusual("max_evaluations", fit.l3.nelderMead.maxEvaluations, usual.l3.nelderMead.maxEvaluations);
      break;
    case Fitter::kSlicedWasserstein:
      addUnusual("samples", fit.sw.levels.back().samples, usual.sw.levels.back().samples);
      addUnusual("directions", fit.sw.levels.back().slices, usual.sw.levels.back().slices);
      add("leak_weight", fit.sw.leakWeight);
      break;
    case Fitter::kSlicedWassersteinSgd:
      addUnusual("samples", fit.sgd.samples, usual.sgd.samples);
      addUnusual("directions", fit.sgd.slices, usual.sgd.slices);
      break;
    case Fitter::kLight:
      addUnusual("lights", fit.light.lights.lights, usual.light.lights.lights);
      add("weighting", std::string(lightWeightingName(fit.light.lights.weighting)));
      add("size_exponent", fit.light.lights.sizeExponent);
      add("leak_weight", fit.light.leakWeight);
      break;
  }
  if (!isotropic && recipe.symmetry != SymmetryMode::kDuring)
    add("symmetry", std::string(symmetryName(recipe.symmetry)));
  return out;
}

RecordedFit fitFromProvenance(const TableInfo& info) {
  return Reader(info).read();
}

}  // namespace ltcfit

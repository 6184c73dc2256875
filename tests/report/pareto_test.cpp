#include "report/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "fit/target_lobe.h"
#include "report/pareto_entries.h"
#include "report/pareto_json.h"
#include "report/pareto_text.h"

namespace ltcfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ParetoRun run(double seconds, double error, bool converged = true) {
  ParetoRun r{.cpuSeconds = seconds, .converged = converged};
  r.errors.fill(error);
  return r;
}

// Few samples: these tests compare runs with each other.
ParetoOptions smallOptions() {
  ParetoOptions o;
  o.entries = 2;
  o.repeats = 2;
  o.metrics = {.samples = 256, .directions = 4, .quads = 4, .lights = 16};
  return o;
}

TEST(Pareto, ErrorsDoNotDependOnThreads) {
  ParetoOptions options = smallOptions();
  options.fitters = {"moments", "light", "l3"};
  options.threads = 1;
  const ParetoResult one = runPareto(options);
  options.threads = 2;
  double total = 0.0;
  double done = 0.0;
  const ParetoResult two = runPareto(options, [&](double d, double t) {
    EXPECT_GT(d, done);
    done = d;
    total = t;
  });
  EXPECT_NEAR(done / total, 1.0, 1e-9);  // sums in another order
  ASSERT_EQ(one.settings.size(), two.settings.size());
  for (std::size_t s = 0; s < one.settings.size(); ++s) {
    EXPECT_EQ(one.summaries[s].runs, 4u);
    EXPECT_GT(one.summaries[s].cpuSeconds.low, 0.0);
    for (std::size_t m = 0; m < kParetoMetrics; ++m) {
      const SettingErrors& a = one.summaries[s].errors[m];
      const SettingErrors& b = two.summaries[s].errors[m];
      EXPECT_EQ(a.ratio.low, b.ratio.low) << one.settings[s].name;
      EXPECT_EQ(a.ratio.median, b.ratio.median);
      EXPECT_EQ(a.ratio.high, b.ratio.high);
      EXPECT_EQ(a.value, b.value);
      EXPECT_GE(a.ratio.low, 1.0);
      EXPECT_TRUE(std::isfinite(a.ratio.high));
    }
  }
  // the seed moves the fits
  options.fitters = {"l3"};
  const ParetoResult same = runPareto(options);
  options.seed = 9;
  const ParetoResult other = runPareto(options);
  EXPECT_NE(same.summaries[0].errors[0].value, other.summaries[0].errors[0].value);
}

TEST(Pareto, FitsThatRunOutOfEvaluationsAreNotConverged) {
  ParetoOptions options = smallOptions();
  options.entries = 1;
  options.fitters = {"moments", "l3"};
  const ParetoResult result = runPareto(options);
  const auto notConverged = [&](const std::string& name) {
    for (std::size_t s = 0; s < result.settings.size(); ++s)
      if (result.settings[s].name == name) return static_cast<int>(result.summaries[s].notConverged);
    ADD_FAILURE() << name;
    return -1;
  };
  // a lobe without symmetry has seven parameters: 100 evaluations are too few of a simplex, 1000 plenty
  EXPECT_EQ(notConverged("256 samples, 100 evaluations"), 2);
  EXPECT_EQ(notConverged("4096 samples, 1000 evaluations"), 0);
  EXPECT_EQ(notConverged("the start"), 0);
}

TEST(Pareto, TheDefaultIsTheFitOfATable) {
  for (const TableKind kind : {TableKind::kIsotropic, TableKind::kAnisotropic}) {
    ParetoOptions options = smallOptions();
    options.kind = kind;
    options.entries = options.repeats = 1;
    options.seed = 5;
    options.fitters = {std::string(fitterName(kDefaultFitter))};
    const ParetoResult result = runPareto(options);
    const LobeParameters p = result.entries[0];
    LobeFitOptions fitter = tableFitPreset(kind, kDefaultFitter);
    fitter.setSeed(options.seed);
    LobeFitTarget target({p, familyOf(p)}, "ggx", fitter);
    const LobeFit fit = fitLobe(target, target.momentStart(), fitter);
    MetricOptions unseen = options.metrics;
    unseen.seed = mixSeed(options.seed, 1000);
    const EntryMetrics errors = MetricTarget(target.lobe(), unseen).evaluate(Ltc(fit.m));
    const std::vector<ParetoDefault> defaults = explainDefaults(kind, result);
    ASSERT_EQ(defaults.size(), 1u);
    EXPECT_EQ(defaults[0].command, kind == TableKind::kIsotropic ? "fit iso" : "fit aniso");
    for (std::size_t s = 0; s < result.settings.size(); ++s) {
      const double ratio = result.summaries[s].errors[0].value / errors.get(Metric::kSw1);
      if (s == defaults[0].setting) {
        EXPECT_NEAR(ratio, 1.0, 1e-12);  // the value went through a logarithm
      } else {
        EXPECT_GT(std::abs(ratio - 1.0), 1e-9) << result.settings[s].name;
      }
    }
  }
}

// A result with three settings of known figures; the middle one is the default.
ParetoResult threeSettings(double defaultSeconds, double defaultError) {
  ParetoResult r;
  r.entries = paretoEntries(TableKind::kAnisotropic, 1);
  for (const FitSetting& s : paretoLadder(TableKind::kAnisotropic))
    if (s.preset == "fast" || s.isDefault) r.settings.push_back(s);
  EXPECT_EQ(r.settings.size(), 3u);  // light fast, light standard, sw fast
  r.summaries =
      summarizePareto({{{run(0.010, 2.0)}}, {{run(defaultSeconds, defaultError)}}, {{run(0.018, 1.6)}}});
  return r;
}

TEST(ParetoText, SaysThatTheDefaultIsOnTheFront) {
  const std::vector<ParetoDefault> d = explainDefaults(TableKind::kAnisotropic, threeSettings(0.020, 1.5));
  ASSERT_EQ(d.size(), 1u);
  EXPECT_EQ(d[0].setting, 1u);
  const auto has = [&](const char* text) { return d[0].why.find(text) != std::string::npos; };
  EXPECT_TRUE(has("takes 20 ms an entry and is on the front of light:")) << d[0].why;
  EXPECT_TRUE(
      has("The next cheaper on that front is sw, 512 x 24 + 1024 x 64 (fast): 0.90 times its time, "
          "6.7 % more error"))
      << d[0].why;
  EXPECT_TRUE(has("Nothing on that front is dearer")) << d[0].why;
}

TEST(ParetoText, SaysWhatBeatsTheDefault) {
  const std::vector<ParetoDefault> d = explainDefaults(TableKind::kAnisotropic, threeSettings(0.020, 3.2));
  ASSERT_EQ(d.size(), 1u);
  const auto has = [&](const char* text) { return d[0].why.find(text) != std::string::npos; };
  EXPECT_TRUE(
      has("is not on the front of light. It is beaten by: sw, 512 x 24 + 1024 x 64 (fast) (0.90 times "
          "its time, 50.0 % less error); light, 256 lights (fast) (0.50 times its time, 37.5 % less "
          "error)"))
      << d[0].why;
  EXPECT_TRUE(has("it is on the front of none")) << d[0].why;
}

TEST(ParetoText, SaysThatTheDefaultFailed) {
  EXPECT_EQ(explainDefaults(TableKind::kAnisotropic, threeSettings(0.020, kInfinity)).at(0).why,
            "light, 1024 lights (standard) is on no front: 1 of its 1 fits failed.");
}

TEST(ParetoText, WithoutTheDefaultThereIsNothingToSay) {
  ParetoResult r = threeSettings(0.02, 1.5);
  r.settings.erase(r.settings.begin() + 1);
  r.summaries.erase(r.summaries.begin() + 1);
  EXPECT_TRUE(explainDefaults(TableKind::kAnisotropic, r).empty());
}

TEST(ParetoJson, HoldsTheFigures) {
  ParetoResult r = threeSettings(0.0123456789, kInfinity);
  const nlohmann::ordered_json json = paretoToJson({}, r, "ltcfit pareto");
  EXPECT_EQ(json["format"], "ltcfit-pareto");
  EXPECT_EQ(json["table"], "aniso");
  EXPECT_EQ(json["metrics"].size(), kParetoMetrics);
  EXPECT_EQ(json["entries"][0]["theta_degrees"], 45.0);
  ASSERT_EQ(json["settings"].size(), 3u);
  const nlohmann::ordered_json& failed = json["settings"][1];
  EXPECT_EQ(failed["default_of"][0], "fit aniso");
  EXPECT_EQ(failed["cpu_seconds"]["median"], 0.012346);
  EXPECT_TRUE(failed["errors"]["light"]["ratio"].is_null());
  EXPECT_EQ(failed["errors"]["light"]["front"], false);
  EXPECT_EQ(failed["non_finite"], 1);
  EXPECT_EQ(json["settings"][2]["errors"]["TV"]["value"], 1.6);
  EXPECT_EQ(json["settings"][2]["effort"]["samples"], 1024);
  EXPECT_EQ(json["defaults"][0]["setting"], 1);
}

}  // namespace
}  // namespace ltcfit

#include "tailor/scene_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "export/atomic_file.h"
#include "ggx/random.h"
#include "tailor/plan_json.h"
#include "tailor/plan_text.h"

namespace ltcfit {
namespace {

MaterialUse material(const char* name, std::vector<LobeUse> lobes) {
  MaterialUse m;
  m.name = name;
  for (const LobeUse& l : lobes) m.area += l.weight;
  m.lobes = std::move(lobes);
  return m;
}

TEST(ScenePlan, LobesAreSplitByKindAndTheDarkOnesLeftOut) {
  SceneUse use;
  use.materials = {material("a", {{0.25, 0.25, 0.04, 1.0, 0.25}, {0.25, 0.125, 1.0, 1.0, 0.25}}),
                   material("b", {{0.25, 0.25, 0.04, 1.0, 0.25}, {0.04, 0.04, 0.0, 0.0, 0.25}})};
  use.views = {0.0, 1.0};
  const LobeDistribution iso = distributionOf(use, true);
  ASSERT_EQ(iso.lobes.size(), 1u);  // alike ones merged
  EXPECT_DOUBLE_EQ(iso.lobes[0].weight, 0.5);
  EXPECT_EQ(iso.views.high, 1.0);
  const LobeDistribution aniso = distributionOf(use, false);
  ASSERT_EQ(aniso.lobes.size(), 1u);
  EXPECT_EQ(aniso.lobes[0].alphaY, 0.125);
}

TEST(ScenePlan, ManyLobesAreMergedWithoutLosingWeightOrEnds) {
  SceneUse use;
  Random random(1);
  std::vector<LobeUse> lobes;
  double low = 1.0;
  double high = 0.0;
  double mean = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double r = 0.1 + 0.8 * random.uniform();
    const double f0 = random.uniform();
    lobes.push_back({r * r, r * r, f0, 1.0, 1.0 / 20000});
    low = std::min(low, r * r);
    high = std::max(high, r * r);
    mean += r * r / 20000;
  }
  use.materials = {material("noise", lobes)};
  const LobeDistribution d = distributionOf(use, true);
  EXPECT_LE(d.lobes.size(), 2048u);
  EXPECT_GT(d.lobes.size(), 200u);
  double weight = 0.0;
  double merged = 0.0;
  double least = 1.0;
  double most = 0.0;
  for (const LobeUse& l : d.lobes) {
    weight += l.weight;
    merged += l.weight * l.alphaX;
    least = std::min(least, l.alphaX);
    most = std::max(most, l.alphaX);
    EXPECT_EQ(l.alphaX, l.alphaY);
  }
  EXPECT_NEAR(weight, 1.0, 1e-9);
  EXPECT_NEAR(merged, mean, 1e-9);
  EXPECT_EQ(least, low);
  EXPECT_EQ(most, high);
}

// A plan takes some thousand fits: one scene with everything, for all that is asked of it.
ScenePlan fullPlan() {
  SceneUse use;
  use.name = "all.glb";
  use.materials = {material("paint", {{0.25, 0.25, 0.04, 1.0, 0.2}, {0.3, 0.3, 0.04, 1.0, 0.3}}),
                   material("steel", {{0.3, 0.12, 0.6, 1.0, 0.5}})};
  use.materials[0].reasons = {"a reason with \x1b[31m colour"};
  use.lights.polygon = use.lights.textured = use.lights.twoSided = true;
  use.notes = {"a note"};
  PlanRequest request;
  request.maxError = 0.003;
  return planScene(use, request, 0);
}

void hasBothTablesAndSaysWhy(const ScenePlan& plan) {
  ASSERT_EQ(plan.tables.size(), 2u);
  const PlannedTable& iso = plan.tables[0];
  const PlannedTable& aniso = plan.tables[1];
  EXPECT_TRUE(iso.distribution.isotropic);
  EXPECT_TRUE(iso.reachable);
  EXPECT_TRUE(aniso.reachable);
  EXPECT_EQ(iso.amplitudes, (std::vector<std::string>{"norm", "fresnel"}));
  EXPECT_EQ(aniso.axes[0].size(), 1u);  // one alpha, one lambda
  EXPECT_EQ(aniso.axes[1].size(), 1u);
  EXPECT_LE(1.2 * aniso.cost.error, 0.003);
  EXPECT_LT(iso.cost.bytes, iso.full.bytes / 16);
  EXPECT_LT(aniso.cost.fetches, aniso.full.fetches);
  EXPECT_EQ(iso.full.bytes, 64u * 64u * 12u);
  EXPECT_EQ(aniso.full.bytes, 4096u * 24u);
  for (std::size_t i = 1; i < iso.curve.size(); ++i) {
    EXPECT_GT(iso.curve[i].first, iso.curve[i - 1].first);
    EXPECT_LT(iso.curve[i].second, iso.curve[i - 1].second);
  }
  const std::string text = planText(plan);
  for (const char* part :
       {"all.glb", "paint", "steel", "Isotropic table", "Anisotropic table", "a note", "textured",
        "two-sided", "lambda 0.4", "fresnel: F0 differs from F90", "roughness 0.5 to 0.548"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string messageOf(const std::string& text) {
  try {
    planFromJson(text, "p.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void filesReadBack(const ScenePlan& plan) {
  const std::string text = planToJson(plan);
  const ScenePlan back = planFromJson(text, "p.json");
  EXPECT_EQ(back.scene, "all.glb");
  EXPECT_EQ(back.request.maxError, 0.003);
  EXPECT_TRUE(back.lights.textured);
  EXPECT_FALSE(back.lights.disk);
  ASSERT_EQ(back.tables.size(), 2u);
  for (std::size_t t = 0; t < 2; ++t) {
    const auto& a = plan.tables[t].distribution;
    const auto& b = back.tables[t].distribution;
    EXPECT_EQ(a.isotropic, b.isotropic);
    EXPECT_EQ(a.views.high, b.views.high);
    ASSERT_EQ(a.lobes.size(), b.lobes.size());
    for (std::size_t i = 0; i < a.lobes.size(); ++i) {
      EXPECT_EQ(a.lobes[i].alphaX, b.lobes[i].alphaX);
      EXPECT_EQ(a.lobes[i].f0, b.lobes[i].f0);
      EXPECT_EQ(a.lobes[i].weight, b.lobes[i].weight);
    }
  }
}

void damagedFilesGetAMessage(const ScenePlan& plan) {
  const std::string text = planToJson(plan);
  for (std::size_t n = 0; n + 3 < text.size(); n += 7)
    EXPECT_NE(messageOf(text.substr(0, n)), "accepted") << n;
  EXPECT_EQ(messageOf(replaced(text, "\"ltc-plan\"", "\"ltc-table\"")), "p.json: format is not \"ltc-plan\"");
  EXPECT_NE(messageOf(replaced(text, "\"max_error\": 0.003,\n  \"no", "\"max_error\": 7,\n  \"no"))
                .find("max-error 7: need"),
            std::string::npos);
  EXPECT_NE(messageOf(replaced(text, "\"kind\": \"isotropic\"", "\"kind\": \"round\""))
                .find("tables[0].kind 'round'"),
            std::string::npos);
  EXPECT_NE(
      messageOf(replaced(text, "\"kind\": \"isotropic\"", "\"kind\": \"anisotropic\"")).find("lobes[0]"),
      std::string::npos);
  EXPECT_NE(messageOf(replaced(text, "\"polygon\": true", "\"polygon\": 1")).find("lights.polygon"),
            std::string::npos);
}

TEST(ScenePlan, OfASceneWithEverything) {
  const ScenePlan plan = fullPlan();
  ASSERT_EQ(plan.tables.size(), 2u);
  hasBothTablesAndSaysWhy(plan);
  filesReadBack(plan);
  damagedFilesGetAMessage(plan);
}

TEST(ScenePlan, BytesAreSharedOut) {
  SceneUse use;
  use.materials = {material("paint", {{0.25, 0.25, 1.0, 1.0, 0.5}, {0.3, 0.3, 1.0, 1.0, 0.3}}),
                   material("steel", {{0.3, 0.12, 1.0, 1.0, 0.2}})};
  PlanRequest request;
  request.maxError = 0.0;
  request.maxBytes = 3000;
  const ScenePlan plan = planScene(use, request, 0);
  ASSERT_EQ(plan.tables.size(), 2u);
  const PlannedTable& iso = plan.tables[0];
  const PlannedTable& aniso = plan.tables[1];
  EXPECT_LE(iso.maxBytes + aniso.maxBytes, 3000u);
  EXPECT_LE(iso.cost.bytes, iso.maxBytes);
  EXPECT_LE(aniso.cost.bytes, aniso.maxBytes);
  EXPECT_GT(aniso.cost.bytes, iso.cost.bytes);  // of four axes, though of fewer lobes
  EXPECT_LT(aniso.cost.error, 20.0 * iso.cost.error);
  const ScenePlan back = planFromJson(planToJson(plan), "p.json");
  EXPECT_EQ(back.tables[0].maxBytes, iso.maxBytes);
  EXPECT_EQ(back.tables[1].maxError, 0.0);
}

TEST(ScenePlan, WithoutLobesItSaysWhy) {
  PlanRequest request;
  SceneUse use;
  const ScenePlan nothing = planScene(use, request, 1);
  EXPECT_TRUE(nothing.tables.empty());
  EXPECT_EQ(nothing.notes.back(), "No table is needed: nothing that the scene shows has a specular lobe.");
  use.materials.assign(5, material("chalk", {{0.25, 0.25, 0.0, 0.0, 0.2}}));
  const ScenePlan dull = planScene(use, request, 1);
  EXPECT_TRUE(dull.tables.empty());
  EXPECT_EQ(
      dull.notes.back(),
      "No table is needed: no lobe reflects anything, F0 and F90 are 0 ('chalk', 'chalk', 'chalk' and 2 "
      "more).");
  EXPECT_NE(planText(dull).find("no lobe reflects anything"), std::string::npos);
  EXPECT_TRUE(planFromJson(planToJson(dull), "p.json").tables.empty());
}

TEST(ScenePlan, PlansThatWouldTakeGigabytesAreRefused) {
  std::string text = "{\"tables\": [";
  for (int i = 0; i < (9 << 20); ++i) text += "[],";
  EXPECT_EQ(
      messageOf(text + "0]}"),
      "p.json: 28311567 bytes of JSON, which would take some 2444230927 bytes of memory; up to 268435456 and "
      "2147483648 are read: plan parts of the scene one by one");
}

TEST(ScenePlan, RequestsAreChecked) {
  std::string error;
  PlanRequest r;
  EXPECT_TRUE(r.isValid(&error));
  r.maxError = 0.0;
  EXPECT_FALSE(r.isValid(&error));
  r.maxBytes = 100;
  EXPECT_TRUE(r.isValid(&error));
  r.maxError = std::nan("");
  EXPECT_FALSE(r.isValid(&error));
  r = {};
  r.alphaFloor = 0.0;
  EXPECT_FALSE(r.isValid(&error));
  EXPECT_NE(error.find("alpha-floor 0"), std::string::npos);
}

}  // namespace
}  // namespace ltcfit

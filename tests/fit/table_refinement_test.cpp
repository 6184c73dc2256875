#include "fit/table_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "fit/table_fit.h"

namespace ltcfit {
namespace {

using Eigen::Matrix3d;

TableFitOptions quickFit() {
  TableFitOptions o;
  o.sw.levels = {{256, 16, 1024}};
  o.threads = 1;
  return o;
}

Table fitted(const TablePlan& plan) {
  TableInfo info = plan.info;
  info.provenance.tool = "a test";
  return Table(info, fitTable(plan, SymmetryMode::kDuring, quickFit(), nullptr).data);
}

const Table& anisotropic() {
  static const Table table = [] {
    AnisotropicTableOptions o;
    o.alphaNodes = o.lambdaNodes = o.thetaNodes = o.phiNodes = 3;
    o.alphaFloor = 1e-2;
    return fitted(planAnisotropicTable(o, SymmetryMode::kDuring));
  }();
  return table;
}

// As the layout of 2017 has it.
const Table& isotropic() {
  static const Table table = [] {
    IsotropicTableOptions o;
    o.thetaNodes = o.alphaNodes = 5;
    return storedAs(fitted(planIsotropicTable(o)), MatrixStorage::kMinv, MatrixNormalization::kMiddleElement);
  }();
  return table;
}

LookUpLossOptions fewLossOptions() {
  return {.slices = 8,
          .targetSamples = 2048,
          .samples = 64,
          .lights = {.lights = 32, .sizeExponent = 0.0},
          .quads = 16};
}

RefinementOptions fewOptions() {
  RefinementOptions o;
  o.loss = fewLossOptions();
  o.points = 400;
  o.iterations = 5;
  o.threads = 1;
  return o;
}

const RefinementResult& refinedAnisotropic() {
  static const RefinementResult result = refineTable(anisotropic(), fewOptions());
  return result;
}
const RefinementResult& refinedIsotropic() {
  static const RefinementResult result = refineTable(isotropic(), fewOptions());
  return result;
}

void expectBetter(const Table& before, const RefinementResult& result) {
  EXPECT_LT(result.state.cost, 0.95 * result.startCost);
  EXPECT_NE(result.termination, Termination::kFailure);
  EXPECT_GT(result.state.iterations, 0);
  EXPECT_EQ(result.unusable, 0u);
  const std::vector<FreshErrors> e =
      errorsAtFreshPoints({&before, &result.table}, fewLossOptions(), 300, 77, 1);
  ASSERT_EQ(e.size(), 3u);
  EXPECT_LT(e[2].mean.sw, e[1].mean.sw);
  EXPECT_LT(e[2].swRel, e[1].swRel);
  EXPECT_LT(e[2].mean.form, e[1].mean.form);
  EXPECT_LT(e[2].mean.light, e[1].mean.light);
  EXPECT_LT(e[0].mean.sw, e[2].mean.sw) << "no look-up can have less than its own fit";
  EXPECT_EQ(e[2].unusable, 0u);
}

TEST(TableRefinement, LessensTheErrorsOfLookUpsItHasNotSeen) {
  expectBetter(anisotropic(), refinedAnisotropic());
  expectBetter(isotropic(), refinedIsotropic());
}

TEST(TableRefinement, LeavesEverythingElseAsItIs) {
  for (const bool isIsotropic : {false, true}) {
    const Table& before = isIsotropic ? isotropic() : anisotropic();
    const Table& after = (isIsotropic ? refinedIsotropic() : refinedAnisotropic()).table;
    EXPECT_EQ(after.info().channels, before.info().channels);
    EXPECT_EQ(after.info().stores, before.info().stores);
    EXPECT_EQ(after.info().normalization, before.info().normalization);
    EXPECT_EQ(after.info().provenance.tool, "a test");
    bool changed = false;
    for (std::size_t i = 0; i < before.data().size(); ++i) {
      const std::string& channel = before.info().channels[i % before.channelCount()];
      if (channel == "norm" || channel == "fresnel") {
        EXPECT_EQ(after.data()[i], before.data()[i]);
      } else {
        changed = changed || after.data()[i] != before.data()[i];
      }
      if (isIsotropic && channel == "m11") {
        EXPECT_EQ(after.data()[i], 1.0f);
      }
    }
    EXPECT_TRUE(changed);
  }
}

TEST(TableRefinement, KeepsSymmetriesExactly) {
  const Table& table = refinedAnisotropic().table;
  std::size_t turnedNodes = 0;
  for (std::size_t n = 0; n < table.nodeCount(); ++n) {
    const std::vector<std::size_t> node = table.node(n);
    const Matrix3d m = table.entry(node).m;
    EXPECT_GT(m.determinant(), 0.0);
    EXPECT_NEAR(m.col(2).norm(), 1.0, 1e-6);
    EXPECT_EQ(projectOnFamily(m, familyOf(table.parameters(node))), m) << "zeros of node " << n;
    std::vector<std::size_t> first = node;
    first[3] = 0;
    const Matrix3d atZero = table.entry(first).m;
    const LobeParameters p = table.parameters(node);
    if (p.theta == 0.0) {
      EXPECT_EQ(m, atZero) << "one lobe for all phi";
    } else if (p.alphaX == p.alphaY) {
      EXPECT_LT((m - turned(atZero, p.phi)).norm(), 3e-7) << "float32, node " << n;
      ++turnedNodes;
    }
  }
  // 3 angles of 2 views; all lambdas at the floor, else lambda = 1
  EXPECT_EQ(turnedNodes, 3u * 2u * (3u + 2u));
}

TEST(TableRefinement, DoesNotDependOnTheNumberOfThreads) {
  RefinementOptions o = fewOptions();
  o.points = 60;
  o.iterations = 3;
  for (const Table* table : {&anisotropic(), &isotropic()}) {
    o.threads = 1;
    const RefinementResult one = refineTable(*table, o);
    o.threads = 2;
    const RefinementResult two = refineTable(*table, o);
    EXPECT_EQ(one.table.data(), two.table.data());
    EXPECT_EQ(one.state.parameters, two.state.parameters);
    EXPECT_EQ(one.state.cost, two.state.cost);
    o.seed = 2;
    EXPECT_NE(refineTable(*table, o).table.data(), one.table.data());
    o.seed = 1;
  }
}

// What it is told; throws when told to.
class Witness final : public RefinementObserver {
 public:
  void prepared(std::size_t done, std::size_t total) override {
    EXPECT_EQ(done, ++preparedCalls);
    EXPECT_LE(done, total);
    if (static_cast<int>(done) == throwAtPrepared) throw std::runtime_error("stop preparing");
  }
  void iterated(const RefinementState& state) override {
    states.push_back(state);
    if (state.iterations == throwAtIteration) throw std::runtime_error("stop iterating");
  }

  std::size_t preparedCalls = 0;
  int throwAtPrepared = -1;
  int throwAtIteration = -1;
  std::vector<RefinementState> states;
};

TEST(TableRefinement, TellsWhereItStands) {
  RefinementOptions o = fewOptions();
  Witness witness;
  const RefinementResult result = refineTable(anisotropic(), o, nullptr, &witness);
  EXPECT_EQ(result.table.data(), refinedAnisotropic().table.data()) << "being watched changes nothing";
  ASSERT_GE(witness.states.size(), 3u);
  const TablePlan plan =
      planAnisotropicTable(anisotropic().info().axes, anisotropic().info().alphaFloor, SymmetryMode::kDuring);
  EXPECT_EQ(witness.preparedCalls, static_cast<std::size_t>(o.points) + plan.jobs.size());
  EXPECT_EQ(witness.states[0].iterations, 0);
  EXPECT_EQ(witness.states[0].cost, result.startCost);
  for (const double p : witness.states[0].parameters) EXPECT_EQ(p, 0.0);
  for (std::size_t i = 1; i < witness.states.size(); ++i) {
    EXPECT_EQ(witness.states[i].iterations, static_cast<int>(i));
    EXPECT_LE(witness.states[i].cost, witness.states[i - 1].cost) << "of the parameters told";
    EXPECT_GT(witness.states[i].radius, 0.0);
  }
  EXPECT_EQ(witness.states.back().parameters, result.state.parameters);
}

TEST(TableRefinement, GoesOnWhereItStood) {
  const RefinementOptions o = fewOptions();
  Witness witness;
  const RefinementResult through = refineTable(isotropic(), o, nullptr, &witness);
  ASSERT_GE(witness.states.size(), 4u);
  const RefinementState& middle = witness.states[2];
  Witness resumed;
  const RefinementResult rest = refineTable(isotropic(), o, &middle, &resumed);
  EXPECT_EQ(resumed.states[0].iterations, 2);
  // float sums in another order: none, but the solver's scaling is taken anew
  EXPECT_NEAR(rest.startCost / middle.cost, 1.0, 1e-9);
  EXPECT_EQ(resumed.states[0].parameters, middle.parameters);
  EXPECT_LE(rest.state.iterations, o.iterations);
  const double gain = through.startCost - through.state.cost;
  EXPECT_NEAR(rest.state.cost, through.state.cost, 0.05 * gain);

  // one that has arrived stays
  RefinementState end = through.state;
  end.iterations = o.iterations;
  EXPECT_EQ(refineTable(isotropic(), o, &end).table.data(), through.table.data());
}

TEST(TableRefinement, ExceptionsOfTheObserverComeOut) {
  for (const int threads : {1, 2}) {
    RefinementOptions o = fewOptions();
    o.points = 40;
    o.threads = threads;
    Witness preparing;
    preparing.throwAtPrepared = 10;
    EXPECT_THROW(refineTable(isotropic(), o, nullptr, &preparing), std::runtime_error);
    EXPECT_EQ(preparing.preparedCalls, 10u);
    Witness iterating;
    iterating.throwAtIteration = 1;
    EXPECT_THROW(refineTable(isotropic(), o, nullptr, &iterating), std::runtime_error);
    EXPECT_EQ(iterating.states.size(), 2u);
    // nothing is left behind
    Witness calm;
    refineTable(isotropic(), o, nullptr, &calm);
    EXPECT_EQ(calm.states[0].cost, iterating.states[0].cost);
  }
}

// The message of the refusal, or "accepted".
std::string refusal(const Table& table, const RefinementState* resumed = nullptr) {
  RefinementOptions o = fewOptions();
  o.points = 16;
  o.iterations = 1;
  try {
    refineTable(table, o, resumed);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

Table with(const Table& table, const std::function<void(TableInfo*, std::vector<float>*)>& change) {
  TableInfo info = table.info();
  std::vector<float> data = table.data();
  change(&info, &data);
  return Table(info, data);
}

TEST(TableRefinement, RefusesWhatItCannotRefine) {
  using Data = std::vector<float>;
  EXPECT_EQ(refusal(isotropic()), "accepted");
  EXPECT_NE(refusal(storedAs(anisotropic(), MatrixStorage::kMinv, MatrixNormalization::kNone)).find("Minv"),
            std::string::npos);
  const std::size_t channels = isotropic().channelCount();
  const Table mirrored = with(isotropic(), [&](TableInfo*, Data* data) { (*data)[7 * channels] *= -1.0f; });
  EXPECT_NE(refusal(mirrored).find("node 7 "), std::string::npos) << refusal(mirrored);
  const Table singular = with(isotropic(), [&](TableInfo*, Data* data) {
    std::fill_n(data->begin() + static_cast<std::ptrdiff_t>(3 * channels), channels, 0.0f);
  });
  EXPECT_NE(refusal(singular).find("node 3 "), std::string::npos) << refusal(singular);
  const Table unknown = with(isotropic(), [](TableInfo* info, Data*) { info->brdf = "beckmann"; });
  EXPECT_NE(refusal(unknown).find("beckmann"), std::string::npos);
  // a floor of 0 leaves nodes of alpha 0
  const Table noFloor = with(isotropic(), [](TableInfo* info, Data*) {
    info->alphaFloor = 0.0;
    info->axes[1].values[0] = 0.0;
  });
  EXPECT_NE(refusal(noFloor).find("alpha"), std::string::npos) << refusal(noFloor);
  const Table planar = with(anisotropic(), [](TableInfo* info, Data* data) {
    info->channels = {"m00", "m02", "m11", "m20", "m22"};
    Data kept;
    for (std::size_t i = 0; i < data->size(); i += 11)
      kept.insert(kept.end(), {(*data)[i], (*data)[i + 2], (*data)[i + 4], (*data)[i + 6], (*data)[i + 8]});
    *data = kept;
  });
  EXPECT_NE(refusal(planar).find("no channel"), std::string::npos) << refusal(planar);

  RefinementState other = refinedIsotropic().state;
  other.parameters.pop_back();
  EXPECT_NE(refusal(isotropic(), &other).find("another table"), std::string::npos);
}

TEST(TableRefinement, LookUpsWithoutAnLtcAreCountedAndMended) {
  // det > 0 at every node, but M diag(-3, -0.5, 1) halfway to M has det < 0
  const Table folded = with(anisotropic(), [](TableInfo*, std::vector<float>* data) {
    for (std::size_t n = 54; n < 81; ++n) {
      for (std::size_t row = 0; row < 3; ++row) {
        (*data)[n * 11 + 3 * row] *= -3.0f;
        (*data)[n * 11 + 3 * row + 1] *= -0.5f;
      }
    }
  });
  const std::vector<FreshErrors> e =
      errorsAtFreshPoints({&anisotropic(), &folded}, fewLossOptions(), 200, 5, 1);
  EXPECT_EQ(e[1].unusable, 0u);
  EXPECT_GT(e[2].unusable, 5u);
  EXPECT_GT(e[2].mean.sw, 1.2 * e[1].mean.sw);
  RefinementOptions o = fewOptions();
  o.points = 200;
  const RefinementResult r = refineTable(folded, o);
  EXPECT_TRUE(std::isfinite(r.startCost));
  EXPECT_NE(r.termination, Termination::kFailure);
  EXPECT_LT(r.state.cost, r.startCost);
}

TEST(TableRefinement, TakesPartialAxesAndAxesOfOneNode) {
  const TablePlan plan = planAnisotropicTable(
      {makeAxis("alpha", "1", AxisMap::kLinear, 2, 0.2, 0.5),
       makeAxis("lambda", "1", AxisMap::kLinear, 2, 0.5, 1.0), singleNodeAxis("theta", "rad", 0.8),
       makeAxis("phi", "rad", AxisMap::kLinear, 2, 0.3, 1.2)},
      1e-4, SymmetryMode::kDuring);
  const Table table = fitted(plan);
  RefinementOptions o = fewOptions();
  o.points = 100;
  const RefinementResult r = refineTable(table, o);
  EXPECT_LT(r.state.cost, r.startCost);
  EXPECT_EQ(r.unusable, 0u);
  // lambda = 1: copies turned from 0.3 to 1.2
  for (const std::size_t alpha : {std::size_t{0}, std::size_t{1}}) {
    const Matrix3d low = r.table.entry(std::vector<std::size_t>{alpha, 1, 0, 0}).m;
    const Matrix3d high = r.table.entry(std::vector<std::size_t>{alpha, 1, 0, 1}).m;
    EXPECT_LT((high - turned(low, 0.9)).norm(), 3e-7) << "float32";
  }
}

TEST(TableRefinement, FreshErrorsDoNotDependOnThreadsOrCompany) {
  const auto one = errorsAtFreshPoints({&isotropic()}, fewLossOptions(), 50, 3, 1);
  const auto two = errorsAtFreshPoints({&isotropic(), &refinedIsotropic().table}, fewLossOptions(), 50, 3, 2);
  for (const std::size_t t : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_EQ(one[t].mean.sw, two[t].mean.sw);
    EXPECT_EQ(one[t].mean.light, two[t].mean.light);
    EXPECT_EQ(one[t].below, two[t].below);
  }
  EXPECT_NE(errorsAtFreshPoints({&isotropic()}, fewLossOptions(), 50, 4, 1)[1].mean.sw, one[1].mean.sw);
}

TEST(RefinementOptions, AreChecked) {
  std::string error;
  EXPECT_TRUE(RefinementOptions{}.isValid(&error)) << error;
  EXPECT_TRUE(fewOptions().isValid(&error)) << error;
  const auto refuses = [&](const char* part, const auto& change) {
    RefinementOptions o;
    change(o);
    error.clear();
    EXPECT_FALSE(o.isValid(&error)) << part;
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  refuses("points = 15, must be in 16..4194304", [](auto& o) { o.points = 15; });
  refuses("iterations = 0, must be in 1..1000", [](auto& o) { o.iterations = 0; });
  refuses("node weight -1, must be in 0..1000", [](auto& o) { o.nodeWeight = -1.0; });
  refuses("smoothness 1001, must be in 0..1000", [](auto& o) { o.smoothness = 1001.0; });
  refuses("prior nan, must be in 0..1000", [](auto& o) { o.prior = std::nan(""); });
  refuses("threads = -1,", [](auto& o) { o.threads = -1; });
  refuses("weight of form -1, must be in 0..", [](auto& o) { o.weights.form = -1.0; });
  refuses("weight of sw-rel", [](auto& o) { o.weights.swRel = std::nan(""); });
  refuses("all weights are 0", [](auto& o) { o.weights = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; });
  refuses("slices = 1,", [](auto& o) { o.loss.slices = 1; });
}

}  // namespace
}  // namespace ltcfit

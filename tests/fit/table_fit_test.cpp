#include "fit/table_fit.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "fit/checkpoint.h"
#include "ltc/ltc.h"

namespace ltcfit {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

AnisotropicTableOptions smallTable() {
  AnisotropicTableOptions o;
  o.alphaNodes = o.lambdaNodes = 3;
  o.thetaNodes = o.phiNodes = 3;
  return o;
}

TableFitOptions quick() {
  TableFitOptions o;
  o.sw = slicedWassersteinPreset("fast");
  o.sw.levels = {{256, 16, 1024}};
  o.sgd.steps = 60;
  o.sgd.samples = 256;
  o.l3.samples = 256;
  o.light.lights.lights = 64;
  return o;
}

TEST(TablePlan, FitsEachLobeOnce) {
  const TablePlan plan = planAnisotropicTable({}, SymmetryMode::kDuring);
  EXPECT_EQ(plan.nodes.size(), 4096u);
  // alpha > 0 and lambda < 1: normal view and 7 x 8 others; alpha_x = alpha_y: 8 angles for each alpha
  EXPECT_EQ(plan.jobs.size(), 7u * 7u * (1u + 7u * 8u) + 8u * 8u);
  const TablePlan free = planAnisotropicTable({}, SymmetryMode::kAfter);
  EXPECT_EQ(free.jobs.size(), 4096u);
  EXPECT_EQ(planIsotropicTable({}).jobs.size(), 4096u);
}

TEST(TablePlan, NodesAreTheirJobsLobesTurned) {
  for (const SymmetryMode mode : {SymmetryMode::kDuring, SymmetryMode::kAfter}) {
    const TablePlan plan = planAnisotropicTable(smallTable(), mode);
    const Table table(plan.info, std::vector<float>(plan.nodes.size() * plan.info.channels.size(), 0.0f));
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      const LobeParameters node = table.parameters(table.node(i));
      const LobeParameters job = plan.jobs[plan.nodes[i].job].parameters;
      EXPECT_EQ(node.alphaX, job.alphaX);
      EXPECT_EQ(node.alphaY, job.alphaY);
      EXPECT_EQ(node.theta, job.theta);
      // the same azimuth, or one that the rotation makes up for, or none that matters
      if (node.theta > 0.0) {
        EXPECT_EQ(node.phi, job.phi + plan.nodes[i].rotation);
      }
      EXPECT_EQ(plan.nodes[i].family, familyOf(node));
      if (mode == SymmetryMode::kDuring) {
        EXPECT_EQ(plan.jobs[plan.nodes[i].job].family, familyOf(job));
      }
    }
  }
  EXPECT_EQ(familyOf({0.5, 0.2, 1.0, kHalfPi}), MatrixFamily::kMirrorX);
  EXPECT_EQ(familyOf({0.5, 0.2, 0.0, 0.3}), MatrixFamily::kMirrorXY);
  EXPECT_EQ(familyOf({0.5, 0.5, 0.0, 0.3}), MatrixFamily::kRotational);
  EXPECT_EQ(familyOf({0.5, 0.5, 0.3, 0.3}), MatrixFamily::kGeneral);
}

TEST(TablePlan, OptionsAreChecked) {
  std::string error;
  AnisotropicTableOptions o;
  EXPECT_TRUE(o.isValid(&error));
  o.phiNodes = 65;
  EXPECT_FALSE(o.isValid(&error));
  EXPECT_NE(error.find("65 phi nodes"), std::string::npos);
  o = {};
  o.alphaFloor = 0.2;
  EXPECT_FALSE(o.isValid(&error));
  o.alphaFloor = std::nan("");
  EXPECT_FALSE(o.isValid(&error));
  o = {};
  o.thetaMax = 1.3;
  EXPECT_FALSE(o.isValid(&error));
}

TEST(TableFit, EveryFitterMakesAUsableSymmetricTable) {
  for (const Fitter fitter :
       {Fitter::kLight, Fitter::kSlicedWasserstein, Fitter::kSlicedWassersteinSgd, Fitter::kL3}) {
    for (const SymmetryMode mode : {SymmetryMode::kDuring, SymmetryMode::kAfter}) {
      const TablePlan plan = planAnisotropicTable(smallTable(), mode);
      TableFitOptions options = quick();
      options.fitter = fitter;
      const TableFitResult result = fitTable(plan, mode, options, nullptr);
      EXPECT_EQ(result.unusable, 0u) << fitterName(fitter);
      const Table table(plan.info, result.data);
      for (std::size_t i = 0; i < table.nodeCount(); ++i) {
        const auto node = table.node(i);
        const Eigen::Matrix3d m = table.entry(node).m;
        EXPECT_GT(m.determinant(), 0.0);
        EXPECT_NEAR(m.col(2).norm(), 1.0, 1e-6);
        EXPECT_EQ(projectOnFamily(m, familyOf(table.parameters(node))), m) << "zeros of eq. 16";
        const LobeParameters p = table.parameters(node);
        if (p.alphaX == p.alphaY) {
          auto first = node;
          first[3] = 0;
          EXPECT_LT((m - turned(table.entry(first).m, p.phi)).norm(), 1e-6);
        }
      }
    }
  }
}

TEST(TableFit, OneNodeAloneIsWhatTheTableHas) {
  const TablePlan plan = planAnisotropicTable(smallTable(), SymmetryMode::kDuring);
  TableFitOptions options = quick();
  options.fitter = Fitter::kLight;
  const Table table(plan.info, fitTable(plan, SymmetryMode::kDuring, options, nullptr).data);
  // also a node whose lobe is another's turned, and one at normal view
  for (std::size_t node : {0u, 5u, 40u, 50u, 76u, 80u}) {
    const NodeFit alone = fitNode(plan, node, options);
    ASSERT_TRUE(alone.usable);
    const TableEntry entry = table.entry(table.node(node));
    EXPECT_LT((alone.m - entry.m).norm(), 1e-6) << node;  // float32
    EXPECT_NEAR(alone.norm, *entry.norm, 1e-7);
    EXPECT_NEAR(alone.fresnel, *entry.fresnel, 1e-7);
  }
}

TEST(TableFit, AxesOfAnyRangeWarpAndSize) {
  const std::vector<Axis> axes{makeAxis("alpha", "1", AxisMap::kLinear, 3, 0.2, 0.5, 0.0, {0.3, 0.1}),
                               singleNodeAxis("lambda", "1", 0.4),
                               makeAxis("theta", "rad", AxisMap::kLinear, 2, 0.1, 1.2),
                               singleNodeAxis("phi", "rad", 0.7)};
  const TablePlan plan = planAnisotropicTable(axes, 0.1, SymmetryMode::kDuring);
  ASSERT_EQ(plan.jobs.size(), 6u);
  EXPECT_EQ(plan.jobs[0].parameters.alphaY, 0.1);  // 0.08 but for the floor
  EXPECT_EQ(plan.jobs[5].parameters.alphaX, 0.5);
  EXPECT_EQ(plan.jobs[5].parameters.alphaY, 0.2);
  EXPECT_EQ(plan.jobs[5].parameters.theta, 1.2);
  TableFitOptions options = quick();
  options.fitter = Fitter::kLight;
  const TableFitResult result = fitTable(plan, SymmetryMode::kDuring, options, nullptr);
  EXPECT_EQ(result.unusable, 0u);
  const Table table(plan.info, result.data);
  EXPECT_EQ(table.parameters(table.node(0)).alphaY, 0.1);

  const TablePlan row =
      planIsotropicTable({makeAxis("theta", "rad", AxisMap::kSqrtOneMinusCos, 4, 0.0, kHalfPi),
                          singleNodeAxis("alpha", "1", 0.16)},
                         1e-4);
  EXPECT_EQ(row.jobs.size(), 4u);
  EXPECT_EQ(row.jobs[0].family, MatrixFamily::kRotational);
}

TEST(TableFit, EnforcingSymmetryAfterwardsCostsAndIsReported) {
  const TablePlan plan = planAnisotropicTable(smallTable(), SymmetryMode::kAfter);
  const TableFitResult result = fitTable(plan, SymmetryMode::kAfter, quick(), nullptr);
  double fitted = 0.0;
  double symmetric = 0.0;
  for (std::size_t i = 0; i < result.jobs.size(); ++i) {
    const JobResult& r = result.jobs[i];
    EXPECT_LE(r.distanceAfter, r.distanceBefore + 1e-12);
    EXPECT_LE(r.loss, r.startLoss);
    EXPECT_NEAR(r.storedLoss, r.symmetricLoss, 1e-4 * r.symmetricLoss + 1e-7) << "float32 costs nothing";
    fitted += r.alignedLoss;
    symmetric += r.symmetricLoss;
  }
  EXPECT_GT(symmetric, fitted);
}

TEST(TableFit, ThreadsAndStoredJobsDoNotChangeTheResult) {
  const TablePlan plan = planAnisotropicTable(smallTable(), SymmetryMode::kDuring);
  TableFitOptions options = quick();
  options.threads = 1;
  const TableFitResult one = fitTable(plan, SymmetryMode::kDuring, options, nullptr);
  options.threads = 3;
  class Half final : public JobStore {
   public:
    explicit Half(const std::vector<JobResult>& jobs) : jobs_(jobs) {}
    const JobResult* find(std::size_t job) const override { return job % 2 == 0 ? &jobs_[job] : nullptr; }
    void add(std::size_t job, const JobResult& /*result*/) override { added += job % 2 == 1 ? 1 : 1000; }
    int added = 0;

   private:
    const std::vector<JobResult>& jobs_;
  } half(one.jobs);
  const TableFitResult three = fitTable(plan, SymmetryMode::kDuring, options, &half);
  EXPECT_EQ(one.data, three.data);
  EXPECT_EQ(half.added, static_cast<int>(plan.jobs.size() / 2));
}

TEST(TableFit, AStoreThatFailsEndsTheRun) {
  class Full final : public JobStore {
    const JobResult* find(std::size_t /*job*/) const override { return nullptr; }
    void add(std::size_t /*job*/, const JobResult& /*result*/) override {
      throw std::runtime_error("disk full");
    }
  } full;
  const TablePlan plan = planAnisotropicTable(smallTable(), SymmetryMode::kDuring);
  EXPECT_THROW(fitTable(plan, SymmetryMode::kDuring, quick(), &full), std::runtime_error);
}

class CheckpointTest : public testing::Test {
 protected:
  CheckpointTest() : path_(testing::TempDir() + "checkpoint." + std::to_string(::getpid()) + ".part") {
    std::remove(path_.c_str());
  }
  ~CheckpointTest() override { std::remove(path_.c_str()); }
  static JobResult result(int k) {
    JobResult r;
    r.m << 0.1 * k, 1.0 / 3.0, -1e-17, 4e-300, 5, 6, 7, -8, 9;
    r.loss = 0.1 + k;
    r.norm = 1.0 - 1e-16;
    r.evaluations = 42 + k;
    r.termination = Termination::kMaxEvaluations;
    r.fitted = true;
    r.flipWouldBeCloser = k % 2 == 1;
    return r;
  }
  static void expectSame(const JobResult& a, const JobResult& b) {
    EXPECT_EQ(a.m, b.m);
    EXPECT_EQ(a.loss, b.loss);
    EXPECT_EQ(a.norm, b.norm);
    EXPECT_EQ(a.evaluations, b.evaluations);
    EXPECT_EQ(a.termination, b.termination);
    EXPECT_EQ(a.fitted, b.fitted);
    EXPECT_EQ(a.flipWouldBeCloser, b.flipWouldBeCloser);
  }
  std::string read() const {
    std::ifstream in(path_, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  std::string path_;
};

TEST_F(CheckpointTest, GivesBackWhatWasAdded) {
  {
    Checkpoint c(path_, "a run", 10);
    c.add(3, result(3));
    c.add(0, result(0));
    EXPECT_EQ(c.size(), 0u) << "of an earlier run";
    EXPECT_THROW(Checkpoint(path_, "a run", 10), std::runtime_error) << "two runs at once";
  }
  Checkpoint c(path_, "a run", 10);
  ASSERT_EQ(c.size(), 2u);
  EXPECT_EQ(c.find(1), nullptr);
  expectSame(*c.find(0), result(0));
  expectSame(*c.find(3), result(3));
  c.remove();
  EXPECT_TRUE(read().empty());
}

TEST_F(CheckpointTest, ReadsWhatIsWholeAtEveryLength) {
  {
    Checkpoint c(path_, "a run", 10);
    for (int k = 0; k < 3; ++k) c.add(static_cast<std::size_t>(k), result(k));
  }
  const std::string whole = read();
  const std::size_t header = whole.find('\n') + 1;
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    write(whole.substr(0, length));
    Checkpoint c(path_, "a run", 10);
    const auto lines = static_cast<std::size_t>(
        std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length), '\n'));
    EXPECT_EQ(c.size(), length < header ? 0 : lines - 1) << length;
    c.add(7, result(7));  // goes to a line of its own
    c.remove();
  }
}

TEST_F(CheckpointTest, RefusesOtherRunsAndOtherFilesAndDoesNotTouchThem) {
  { Checkpoint(path_, "a run", 10).add(1, result(1)); }
  const std::string before = read();
  EXPECT_THROW(Checkpoint(path_, "another run", 10), std::invalid_argument);
  EXPECT_THROW(Checkpoint(path_, "a run", 11), std::invalid_argument);
  EXPECT_EQ(read(), before);
  write("a letter to a friend, which is much longer than the first line of a checkpoint would be\n");
  EXPECT_THROW(Checkpoint(path_, "a run", 10), std::invalid_argument);
  EXPECT_THROW(Checkpoint("no/such/folder/c", "a run", 10), std::runtime_error);
}

TEST_F(CheckpointTest, FollowsNoLink) {
  const std::string target = path_ + ".target";
  std::ofstream(target).close();
  ASSERT_EQ(::symlink(target.c_str(), path_.c_str()), 0);
  EXPECT_THROW(Checkpoint(path_, "a run", 9), std::invalid_argument);
  EXPECT_EQ(std::ifstream(target).peek(), EOF) << "another's file was written to";
  std::remove(target.c_str());
}

TEST_F(CheckpointTest, DoesNotBelieveDamagedLines) {
  { Checkpoint(path_, "a run", 10).add(1, result(1)); }
  const std::string whole = read();
  for (std::size_t i = whole.find('\n') + 1; i + 1 < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = damaged[i] == '1' ? '2' : '1';
    write(damaged);
    EXPECT_EQ(Checkpoint(path_, "a run", 10).size(), 0u) << i;
  }
}

}  // namespace
}  // namespace ltcfit

#include "report/table_at_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fit/table_fit.h"

namespace ltcfit {
namespace {

// Has every job but those that are wanted, as the identity.
class AllBut final : public JobStore {
 public:
  explicit AllBut(std::vector<bool> wanted) : wanted_(std::move(wanted)) { rest_.fitted = true; }
  const JobResult* find(std::size_t job) const override { return wanted_[job] ? nullptr : &rest_; }
  void add(std::size_t, const JobResult&) override {}

 private:
  std::vector<bool> wanted_;
  JobResult rest_;
};

// Marks the jobs of the nodes about a lobe.
void want(const TablePlan& plan, const LobeParameters& p, std::vector<bool>& wanted) {
  const std::vector<Axis>& axes = plan.info.axes;
  const std::vector<double> at = axes.size() == 2
                                     ? std::vector<double>{p.theta, p.alphaX}
                                     : std::vector<double>{p.alphaX, p.alphaY / p.alphaX, p.theta, p.phi};
  for (std::size_t corner = 0; corner < std::size_t{1} << axes.size(); ++corner) {
    std::size_t flat = 0;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const double texel = axes[a].texelFromValue(at[a]);
      const auto below = static_cast<std::size_t>(texel);
      flat = flat * axes[a].size() + std::min(below + ((corner >> a) & 1), axes[a].size() - 1);
    }
    wanted[plan.nodes[flat].job] = true;
  }
}

std::optional<Table> fitAt(const TablePlan& plan, TableKind kind, const std::vector<LobeParameters>& lobes,
                           int threads) {
  std::vector<bool> wanted(plan.jobs.size(), false);
  for (const LobeParameters& p : lobes) {
    if ((p.alphaX == p.alphaY) == (kind == TableKind::kIsotropic)) want(plan, p, wanted);
  }
  if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) return std::nullopt;
  AllBut store(wanted);
  const TableFitOptions options{tableFitPreset(kind, kDefaultFitter), threads};
  return Table(plan.info, fitTable(plan, SymmetryMode::kDuring, options, &store).data);
}

}  // namespace

TablesAtLobes fitTablesAt(const std::vector<LobeParameters>& lobes, int threads) {
  return {fitAt(planIsotropicTable({}), TableKind::kIsotropic, lobes, threads),
          fitAt(planAnisotropicTable({}, SymmetryMode::kDuring), TableKind::kAnisotropic, lobes, threads)};
}

}  // namespace ltcfit

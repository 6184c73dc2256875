#include "tailor/tailored_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/refusal.h"
#include "export/packing.h"
#include "fit/table_fit.h"
#include "fit/table_plan.h"
#include "ggx/random.h"

namespace ltcfit {
namespace {

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

TableInfo infoOf(const std::vector<Axis>& axes, const std::vector<std::string>& amplitudes) {
  TableInfo info;
  info.axes = axes;
  info.channels = amplitudes;
  return info;
}

// Without the amplitudes that are not among `kept`.
Table withAmplitudes(const Table& table, const std::vector<std::string>& kept) {
  TableInfo info = table.info();
  std::vector<std::size_t> channels;
  info.channels.clear();
  for (std::size_t c = 0; c < table.channelCount(); ++c) {
    const std::string& name = table.info().channels[c];
    if ((name == "norm" || name == "fresnel") && !contains(kept, name)) continue;
    channels.push_back(c);
    info.channels.push_back(name);
  }
  std::vector<float> data;
  for (std::size_t i = 0; i < table.nodeCount(); ++i)
    for (std::size_t c : channels) data.push_back(table.data()[i * table.channelCount() + c]);
  return Table(std::move(info), std::move(data));
}

}  // namespace

std::vector<std::string> neededAmplitudes(const LobeDistribution& distribution) {
  std::vector<std::string> out;
  const auto& lobes = distribution.lobes;
  if (std::any_of(lobes.begin(), lobes.end(), [](const LobeUse& l) { return l.f0 != 0.0; }))
    out.emplace_back("norm");
  if (std::any_of(lobes.begin(), lobes.end(), [](const LobeUse& l) { return l.f0 != l.f90; }))
    out.emplace_back("fresnel");
  return out;
}

std::size_t shippedBytes(const std::vector<Axis>& axes, const std::vector<std::string>& amplitudes,
                         Precision precision) {
  return leanSize(infoOf(axes, amplitudes), precision).bytes;
}

Table shippedTable(const Table& table, Precision precision) {
  return unpack(pack(table, packingLean(table.info()), precision));
}

std::optional<Table> fitAxes(const std::vector<Axis>& axes, bool isotropic,
                             const std::vector<std::string>& amplitudes,
                             const InterpolationModelOptions& options, const FitProgress& progress) {
  TablePlan plan = isotropic ? planIsotropicTable(axes, options.alphaFloor)
                             : planAnisotropicTable(axes, options.alphaFloor, SymmetryMode::kDuring);
  plan.info.brdf = options.brdf;
  TableFitOptions fit;
  static_cast<LobeFitOptions&>(fit) = options.fit;
  fit.threads = options.threads;
  TableFitResult result = fitTable(plan, SymmetryMode::kDuring, fit, nullptr, progress);
  if (result.unusable > 0) return std::nullopt;
  return withAmplitudes(Table(plan.info, std::move(result.data)), amplitudes);
}

namespace {

class Tailor {
 public:
  Tailor(const LobeDistribution& distribution, const TableDesigns& designs, const TailorOptions& options,
         const FitProgress& progress)
      : distribution_(distribution),
        designs_(designs),
        options_(options),
        amplitudes_(neededAmplitudes(distribution)),
        check_(distribution, options.checkPoints, options.model, mixSeed(options.model.seed, 7), progress) {}

  TailoredTable run() {
    choosePrecision();
    alongTheFront();
    if (out_.kept && options_.maxError > 0.0) withoutSingleNodes();
    return std::move(out_);
  }

 private:
  std::size_t bytesOf(const TableDesign& design) const {
    return shippedBytes(designs_.axes(design), amplitudes_, out_.precision);
  }
  bool fits(const TableDesign& design) const {
    return options_.maxBytes == 0 || bytesOf(design) <= options_.maxBytes;
  }
  bool mayTryMore() const { return out_.steps.size() < options_.maxTables; }
  double predicted(const TableDesign& design) const { return ratio_ * design.error; }

  // Rounding every channel of every direct fit to its nearest half.
  void choosePrecision() {
    double sum = 0.0;
    std::size_t count = 0;
    const MatrixStorage stores = lookUpStorage(distribution_.isotropic);
    for (std::size_t i = 0; i < check_.lookUps().size(); ++i) {
      const StoredEntry& direct = check_.directFits()[i];
      if (!direct.allFinite()) continue;
      const StoredEntry half = direct.unaryExpr([](double v) {
        return static_cast<double>(static_cast<float>(Eigen::half(static_cast<float>(v))));
      });
      sum += LightResponse(check_.lookUps()[i], direct, stores, mixSeed(options_.model.seed, 300 + i))
                 .difference(half);
      ++count;
    }
    if (count > 0 && options_.maxError > 0.0 && sum / static_cast<double>(count) > 0.5 * options_.maxError)
      out_.precision = Precision::kFloat;
  }

  // Fits and measures one design; whether it is within the bound.
  bool tryDesign(const TableDesign& design) {
    const std::optional<Table> table =
        fitAxes(designs_.axes(design), distribution_.isotropic, amplitudes_, options_.model);
    if (!table) {
      out_.steps.push_back({design, bytesOf(design), out_.precision, {}});
      out_.steps.back().error.mean = std::numeric_limits<double>::infinity();
      return false;
    }
    FetchError error;
    try {
      error = check_.measure(shippedTable(*table, out_.precision));
    } catch (const Refusal&) {  // numbers that no half holds
      error.mean = error.standardError = std::numeric_limits<double>::infinity();
    }
    const TailorStep step{design, bytesOf(design), out_.precision, error};
    out_.steps.push_back(step);
    const bool within = error.isWithin(options_.maxError);
    if (design.error > 0.0 && std::isfinite(error.mean)) ratio_ = error.mean / design.error;
    const bool better = !out_.table || (within && (!out_.kept || step.bytes <= out_.step.bytes)) ||
                        (!within && !out_.kept && error.mean < out_.step.error.mean);
    if (better) {
      out_.table = *table;
      out_.step = step;
      out_.kept = within;
    }
    return within;
  }

  // Bisection, with a first guess at every turn by what the last measurement says.
  void alongTheFront() {
    const std::vector<TableDesign>& front = designs_.front();
    std::size_t below = 0;  // designs before it are too coarse
    std::size_t above = 0;  // and from it on within the bound, or too large
    while (above < front.size() && fits(front[above])) ++above;
    const std::size_t end = above;
    if (options_.maxError == 0.0) {
      if (end > 0) tryDesign(front[end - 1]);
      out_.kept = out_.table.has_value();
      return;
    }
    while (below < above && mayTryMore()) {
      std::size_t guess = below;
      // two standard errors are some 0.1 of the mean, more for sharp lobes: then the next guess is larger
      while (guess + 1 < above && predicted(front[guess]) > 0.92 * options_.maxError) ++guess;
      // where guesses end beside a bound again and again, the middle
      if (out_.steps.size() >= 6) guess = below + (above - below) / 2;
      if (tryDesign(front[guess])) {
        above = guess;
      } else {
        below = guess + 1;
      }
    }
  }

  // A design beside the front may do as well, by what was measured.
  void withoutSingleNodes() {
    for (bool again = true; again && mayTryMore();) {
      again = false;
      const TableDesign from = out_.step.design;
      for (std::size_t a = 0; a < from.nodes.size() && mayTryMore() && !again; ++a) {
        if (from.nodes[a] == 1) continue;
        std::vector<std::size_t> nodes = from.nodes;
        --nodes[a];
        const TableDesign fewer = designs_.design(nodes);
        if (wasTried(fewer)) continue;
        // predictions are good to a tenth beside a measured neighbour
        if (out_.step.error.mean * fewer.error / from.error > 1.1 * options_.maxError) continue;
        again = tryDesign(fewer);
      }
    }
  }
  bool wasTried(const TableDesign& design) const {
    return std::any_of(out_.steps.begin(), out_.steps.end(),
                       [&](const TailorStep& s) { return s.design.nodes == design.nodes; });
  }

  const LobeDistribution& distribution_;
  const TableDesigns& designs_;
  const TailorOptions& options_;
  std::vector<std::string> amplitudes_;
  FetchCheck check_;
  TailoredTable out_;
  double ratio_ = 1.1;  // of measured to predicted errors, before the first one (DESIGN.md, Tailored tables)
};

}  // namespace

TailoredTable tailorTable(const LobeDistribution& distribution, const TableDesigns& designs,
                          const TailorOptions& options, const FitProgress& progress) {
  return Tailor(distribution, designs, options, progress).run();
}

}  // namespace ltcfit

#include "app/refinement_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "app/memory.h"
#include "app/progress.h"
#include "app/refinement_checkpoint.h"
#include "app/shell_quoted.h"
#include "base/diagnostics.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/json_table.h"
#include "export/little_endian.h"
#include "fit/memory_estimate.h"

namespace ltcfit::app {
namespace {

// The same lobes in the form that the refined table has.
Table inRefinedForm(const Table& table, const RefinementRequest& request) {
  const TableInfo& info = table.info();
  const bool scaleFree = !table.isIsotropic() && !request.keepScale;
  if (scaleFree && info.stores == request.stores) {
    TableInfo free = info;
    free.normalization = MatrixNormalization::kNone;
    return Table(std::move(free), table.data());
  }
  const MatrixNormalization normalization = scaleFree ? MatrixNormalization::kNone
                                            : request.stores == MatrixStorage::kMinv
                                                ? MatrixNormalization::kMiddleElement
                                                : MatrixNormalization::kThirdColumnUnit;
  // what has this form keeps its very bits
  if (info.stores == request.stores && info.normalization == normalization) return table;
  return storedAs(table, request.stores, normalization);
}

void setOption(Provenance* p, const std::string& name, Provenance::Value value) {
  for (auto& [key, old] : p->options) {
    if (key != name) continue;
    old = std::move(value);
    return;
  }
  p->options.emplace_back(name, std::move(value));
}

Provenance provenanceOf(const Table& table, const RefinementSource& source,
                        const RefinementRequest& request) {
  const Provenance& from = table.info().provenance;
  const RefinementOptions& o = request.options;
  const auto seed = static_cast<std::int64_t>(o.seed);
  const bool usual = request.stores == usualStorage(table.isIsotropic()) && !request.keepScale;
  Provenance p = from;
  // of an earlier refinement: it stays in the source's command
  std::erase_if(p.options, [](const auto& option) { return option.first.starts_with("refine_"); });
  if (source.asFitted && usual && seed == from.seed) {
    p.command += fmt::format(" --refine --refine-points {} --refine-iterations {}", o.points, o.iterations);
  } else {
    p.tool.assign("ltcfit");
    p.toolVersion.assign(LTCFIT_VERSION);
    p.seed = seed;
    p.command = fmt::format("ltcfit refine {} --points {} --iterations {}", shellFileName(source.name),
                            o.points, o.iterations);
    if (!usual) p.command += fmt::format(" --stored-as {}", matrixStorageName(request.stores));
    if (request.keepScale) p.command += " --keep-scale";
    p.command += fmt::format(" --seed {}", seed);
    setOption(&p, "source",
              from.command.empty() ? from.tool : fmt::format("{}: {}", from.tool, from.command));
    const bool kept = std::any_of(p.options.begin(), p.options.end(),
                                  [](const auto& option) { return option.first == "fit_seed"; });
    if (from.tool == "ltcfit" && seed != from.seed && !kept) setOption(&p, "fit_seed", from.seed);
  }
  setOption(&p, "refine_points", std::int64_t{o.points});
  setOption(&p, "refine_iterations", std::int64_t{o.iterations});
  if (!usual) setOption(&p, "refine_stored_as", std::string(matrixStorageName(request.stores)));
  if (request.keepScale) setOption(&p, "refine_keep_scale", true);
  return p;
}

std::string fingerprintOf(const Table& table, const std::string& command) {
#ifdef __FMA__
  constexpr const char* kBuild = " native";
#else
  constexpr const char* kBuild = "";
#endif
  return fmt::format("{}, ltcfit {}{}, table {}", command, LTCFIT_VERSION, kBuild,
                     checksum(tableToJson(table)));
}

class ShownAndSaved final : public RefinementObserver {
 public:
  ShownAndSaved(const RefinementRequest& request, const RefinementCheckpoint* checkpoint)
      : checkpoint_(checkpoint),
        iterations_(static_cast<std::size_t>(request.options.iterations)),
        preparing_(std::in_place, "look-ups", request.quiet),
        quiet_(request.quiet) {}

  void prepared(std::size_t done, std::size_t total) override { preparing_->update(done, total); }

  void iterated(const RefinementState& state) override {
    if (checkpoint_ != nullptr) checkpoint_->save(state);
    if (preparing_) {
      preparing_.reset();
      iterating_.emplace("iterations", quiet_);
      first_ = state.iterations;
    } else {
      const auto first = static_cast<std::size_t>(first_);
      iterating_->update(static_cast<std::size_t>(state.iterations) - first, iterations_ - first);
    }
  }

 private:
  const RefinementCheckpoint* checkpoint_;
  std::size_t iterations_;
  std::optional<Progress> preparing_;
  std::optional<Progress> iterating_;
  bool quiet_;
  int first_ = 0;
};

}  // namespace

MatrixStorage usualStorage(bool isotropic) {
  return isotropic ? MatrixStorage::kMinv : MatrixStorage::kM;
}

RefinementOptions refinementOptions(bool isotropic, int points, int iterations, std::int64_t seed,
                                    int threads, const std::string& prefix) {
  RefinementOptions o = refinementDefaults(isotropic ? TableKind::kIsotropic : TableKind::kAnisotropic);
  o.points = points;
  o.iterations = iterations;
  o.seed = static_cast<std::uint64_t>(seed);
  o.threads = threads;
  std::string error;
  if (!o.isValid(&error)) throw InputError(fmt::format("--{}{}", prefix, error));
  return o;
}

void requireRefinementMemory(int points, std::size_t nodes, const std::string& option) {
  const double bytes = refinementBytes(static_cast<std::size_t>(points), nodes);
  const double each = bytes / static_cast<double>(static_cast<std::size_t>(points) + nodes);
  const double most = static_cast<double>(availableMemory()) / each - static_cast<double>(nodes);
  requireMemory(bytes, fmt::format("{} {}: the look-ups of a table of {} nodes", option, points, nodes),
                most >= 16.0 ? fmt::format("at most {:.0f} fit", most)
                             : "its nodes alone are too many, a smaller table is refined in less");
}

RefinementRun refineToFile(const Table& table, const RefinementSource& source,
                           const RefinementRequest& request, const std::string& output,
                           const std::string& checkpointPath) {
  try {
    const Table before = inRefinedForm(table, request);
    TableInfo info = before.info();
    info.provenance = provenanceOf(table, source, request);
    std::optional<RefinementCheckpoint> checkpoint;
    if (!checkpointPath.empty())
      checkpoint.emplace(checkpointPath, fingerprintOf(before, info.provenance.command), request.resume);
    const RefinementState* const found = checkpoint ? checkpoint->found() : nullptr;

    const Stopwatch watch;
    RefinementRun run{before, {.table = before}};
    {
      ShownAndSaved observer(request, checkpoint ? &*checkpoint : nullptr);
      run.result = refineTable(before, request.options, found, &observer);
    }
    run.times = watch.elapsed();
    if (found != nullptr) {
      run.resumedAt = found->iterations;
      // such a run need not end with the bytes that the command gives
      setOption(&info.provenance, "refine_resumed_at", std::int64_t{found->iterations});
    }
    run.result.table = Table(std::move(info), run.result.table.data());
    if (run.result.unusable == 0) writeFileAtomically(output, tableToJson(run.result.table));
    if (checkpoint) checkpoint->remove();
    return run;
  } catch (const Refusal& error) {
    throw InputError((source.name.empty() ? std::string("--refine") : source.name) + ": " + error.what());
  }
}

int refuseUnusableRefinement(const RefinementRun& run) {
  if (run.result.unusable == 0) return kExitOk;
  complain(fmt::format("refined, {} nodes are unusable (no inverse in float32): no table was written",
                       run.result.unusable));
  return kExitQuality;
}

}  // namespace ltcfit::app

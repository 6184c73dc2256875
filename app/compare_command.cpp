// ltcfit compare: how two tables differ.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "app/commands.h"
#include "app/table_arguments.h"
#include "base/angles.h"
#include "base/diagnostics.h"
#include "export/atomic_file.h"
#include "export/read_table.h"
#include "report/compare.h"

namespace ltcfit::app {
namespace {

struct CompareArguments {
  std::string first;
  std::string second;
  std::optional<double> tolerance;
  bool json = false;
};

std::string describeTable(const Table& table) {
  const TableInfo& info = table.info();
  std::string text;
  for (const Axis& axis : info.axes)
    text += fmt::format("{}{} {}{}", text.empty() ? "" : " x ", axis.size(), axis.name,
                        axis.map == AxisMap::kNone ? "" : fmt::format(" ({})", axisMapName(axis.map)));
  const std::string& tool = info.provenance.tool;
  if (!tool.empty() && tool != "ltcfit") text += "; " + tool;
  return fmt::format("{}; {}, {}; {}", text, matrixStorageName(info.stores),
                     matrixNormalizationName(info.normalization), fmt::join(info.channels, " "));
}

nlohmann::ordered_json toJson(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p90", s.p90},
          {"p99", s.p99},   {"max", s.max}, {"count", s.count}};
}

void printJson(const CompareArguments& a, const TableDifference& d) {
  nlohmann::ordered_json out{
      {"tables", {a.first, a.second}}, {"same_nodes", d.sameNodes}, {"same_storage", d.sameStorage}};
  for (const ChannelDifference& c : d.channels)
    out["channels"][c.channel] = {{"different", c.different}, {"largest", c.largest}};
  out["sw1"] = toJson(d.sw1);
  out["sw1_between"] = toJson(d.between);
  out["only_in_one"] = d.oneSided;
  if (d.norm.count > 0) out["norm"] = toJson(d.norm);
  if (d.fresnel.count > 0) out["fresnel"] = toJson(d.fresnel);
  out["singular"] = d.singular;
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void printText(const CompareArguments& a, const Table& first, const Table& second, const TableDifference& d) {
  fmt::print("A {}\n  {}\nB {}\n  {}\n", a.first, describeTable(first), a.second, describeTable(second));
  if (!d.sameNodes) fmt::print("other nodes: B is interpolated at those of A\n");
  if (d.sameStorage) {
    std::size_t different = 0;
    for (const ChannelDifference& c : d.channels) different += c.different;
    if (different == 0) {
      fmt::print("all {} numbers are the same float32\n", first.data().size());
    } else {
      fmt::print("{:<10}{:>12}{:>14}\n", "channel", "different", "largest");
      for (const ChannelDifference& c : d.channels)
        fmt::print("{:<10}{:>12}{:>14.3e}\n", c.channel, c.different, c.largest);
    }
  }
  fmt::print("{:<10}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "", "mean", "p50", "p90", "p99", "max");
  const auto line = [](const char* name, const Summary& s) {
    if (s.count == 0) return;
    fmt::print("{:<10}{:>12.3e}{:>12.3e}{:>12.3e}{:>12.3e}{:>12.3e}\n", name, s.mean, s.p50, s.p90, s.p99,
               s.max);
  };
  line("SW1", d.sw1);
  line("  between", d.between);
  line("norm", d.norm);
  line("fresnel", d.fresnel);
  if (d.sw1.count > 0 && d.sw1.max > 0.0) {
    const LobeParameters p = first.parameters(first.node(d.worstNode));
    fmt::print("largest SW1 at alpha_x {:.6g}, alpha_y {:.6g}, theta {:.2f} deg, phi {:.2f} deg\n", p.alphaX,
               p.alphaY, p.theta * kDegreesPerRadian, p.phi * kDegreesPerRadian);
  }
  for (const std::string& channel : d.oneSided)
    fmt::print("only one of the two has the channel {}\n", channel);
  if (d.singular > 0) fmt::print("{} nodes have no inverse in one of the two\n", d.singular);
}

int compare(const CompareArguments& a) {
  if (a.tolerance && !std::isfinite(*a.tolerance)) throw InputError("--tolerance must be a number in 0..2");
  const Table first = readInput(a.first).table;
  const Table second = readInput(a.second).table;
  const TableDifference difference = compareTables(first, second);
  if (a.json) {
    printJson(a, difference);
  } else {
    printText(a, first, second, difference);
  }
  if (!a.tolerance) return kExitOk;
  const bool within = difference.singular == 0 && difference.oneSided.empty() &&
                      difference.sw1.max <= *a.tolerance && difference.between.max <= *a.tolerance &&
                      (difference.norm.count == 0 || difference.norm.max <= *a.tolerance) &&
                      (difference.fresnel.count == 0 || difference.fresnel.max <= *a.tolerance);
  if (!within) complain(fmt::format("the tables differ by more than {}", *a.tolerance));
  return within ? kExitOk : kExitQuality;
}

}  // namespace

void addCompareCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "compare", "How two tables differ, number by number and lobe by lobe; of any form that ltcfit reads");
  auto a = std::make_shared<CompareArguments>();
  command->add_option("A", a->first, "Table, at whose nodes both are compared")
      ->required()
      ->type_name("FILE");
  command->add_option("B", a->second, "The other one")->required()->type_name("FILE");
  command
      ->add_option("--tolerance", a->tolerance,
                   "Exit 3 where SW1 (at nodes and between them), norm or Fresnel differ by more; 0..2")
      ->check(CLI::Range(0.0, 2.0));
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a, &status] { status.exitCode = compare(*a); });
}

}  // namespace ltcfit::app

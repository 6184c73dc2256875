#include "tailor/plan_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace ltcfit {
namespace {

// Names of files are not trusted with a terminal.
std::string printable(const std::string& text) {
  std::string out;
  for (char c : text) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out.empty() ? "(no name)" : out;
}

void addMaterial(const MaterialSummary& m, bool reasons, std::string* out) {
  const auto into = std::back_inserter(*out);
  fmt::format_to(into, "  {:<28} {:5.1f} %  roughness {}", printable(m.name), 100.0 * m.area,
                 rangeText(m.roughness[0], m.roughness[2]));
  if (m.lambda[0] < 1.0) fmt::format_to(into, ", lambda {}", rangeText(m.lambda[0], m.lambda[1]));
  fmt::format_to(into, ", F0 {}", rangeText(m.f0[0], m.f0[1]));
  if (m.texels > 0) fmt::format_to(into, " ({} texels)", m.texels);
  *out += '\n';
  if (!reasons) return;
  for (const std::string& reason : m.reasons) fmt::format_to(into, "      {}\n", printable(reason));
}

// The largest ones; a few with their reasons.
void addMaterials(std::vector<MaterialSummary> materials, std::string* out) {
  constexpr std::size_t kShown = 12;
  constexpr std::size_t kExplained = 6;
  std::stable_sort(materials.begin(), materials.end(),
                   [](const MaterialSummary& a, const MaterialSummary& b) { return a.area > b.area; });
  const std::size_t shown = std::min(materials.size(), kShown);
  for (std::size_t i = 0; i < shown; ++i) addMaterial(materials[i], materials.size() <= kExplained, out);
  if (materials.size() > shown)
    *out += fmt::format("  ... and {} more; the plan has all, with reasons\n", materials.size() - shown);
}

void addCost(const char* name, const TableCost& cost, const char* what, std::string* out) {
  fmt::format_to(std::back_inserter(*out),
                 "  {:<9} {:<15} {:>9} in halves  {} texture{}, {} fetch{}  mean error {:.2g}{}\n", name,
                 nodesText(cost.nodes), bytesText(cost.bytes), cost.textures, cost.textures == 1 ? "" : "s",
                 cost.fetches, cost.fetches == 1 ? "" : "es", cost.error, what);
}

void addTable(const PlannedTable& t, const PlanRequest& request, std::string* out) {
  const auto into = std::back_inserter(*out);
  std::string axes;
  for (const Axis& axis : t.axes) axes += (axes.empty() ? "" : " x ") + axis.name;
  fmt::format_to(into, "{} table ({})\n", t.distribution.isotropic ? "Isotropic" : "Anisotropic", axes);
  addCost("tailored", t.cost, ", predicted", out);
  addCost("full", t.full, ", predicted, over the same look-ups", out);
  if (!t.reachable && t.maxError > 0.0)
    fmt::format_to(into, "  a mean error of {:g} is out of reach{}\n", t.maxError,
                   t.maxBytes > 0 ? fmt::format(" within {}", bytesText(t.maxBytes)) : "");
  if (!t.reachable && t.maxError == 0.0)
    fmt::format_to(into, "  the smallest table has {}: out of reach\n", bytesText(t.cost.bytes));
  if (request.maxError > 0.0 && t.maxError > request.maxError)
    fmt::format_to(into, "  bound {:g}: {:g} is more than the full table keeps to; --max-error insists\n",
                   t.maxError, request.maxError);
  if (t.maxError > 0.0 && t.full.error > t.maxError)
    fmt::format_to(
        into, "  the full table does not keep to {:g} either: --max-error {:.2g} is as good as it{}\n",
        t.maxError, t.full.error,
        t.cost.bytes > t.full.bytes ? ", and smaller than this one, which is larger than the full table"
                                    : "");
  for (const std::string& reason : t.reasons) fmt::format_to(into, "    {}\n", reason);
}

}  // namespace

std::string rangeText(double low, double high) {
  const std::string a = fmt::format("{:.3g}", low);
  const std::string b = fmt::format("{:.3g}", high);
  return a == b ? a : fmt::format("{} to {}", a, b);
}

std::string bytesText(std::size_t bytes) {
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  return fmt::format("{:.1f} KB", static_cast<double>(bytes) / 1024.0);
}

std::string nodesText(const std::vector<std::size_t>& nodes) {
  std::string out;
  for (std::size_t n : nodes) out += fmt::format("{}{}", out.empty() ? "" : " x ", n);
  return out;
}

std::string planText(const ScenePlan& plan) {
  std::string out =
      fmt::format("{}: {} specular lobe{}, with the share of the surface that has it\n",
                  printable(plan.scene), plan.materials.size(), plan.materials.size() == 1 ? "" : "s");
  addMaterials(plan.materials, &out);
  for (const PlannedTable& t : plan.tables) addTable(t, plan.request, &out);
  if (!plan.tables.empty()) {
    out += "Shading\n";
    for (const std::string& line : plan.shading) out += "    " + line + "\n";
    for (const std::string& line : plan.lights.reasons) out += "    " + printable(line) + "\n";
  }
  if (!plan.notes.empty()) out += "Notes\n";
  for (const std::string& line : plan.notes) out += "    " + printable(line) + "\n";
  return out;
}

}  // namespace ltcfit

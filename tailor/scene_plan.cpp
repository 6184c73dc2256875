#include "tailor/scene_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include "export/packing.h"
#include "export/shader_lookup.h"
#include "tailor/table_designs.h"
#include "tailor/tailored_table.h"

namespace ltcfit {
namespace {

// More lobes than these are merged to a grid: no table is the better for them.
constexpr std::size_t kMostLobes = 2048;

struct LobeExtent {
  double low = 0.0;
  double high = 0.0;
  bool empty = true;

  void add(double v) {
    low = empty ? v : std::min(low, v);
    high = empty ? v : std::max(high, v);
    empty = false;
  }
};

// Lobes with equal coordinates on a grid of `steps` a unit of roughness, lambda, f0 and f90, as their mean;
// ends of the ranges stay.
std::vector<LobeUse> merged(const std::vector<LobeUse>& lobes, double steps) {
  LobeExtent alpha;
  LobeExtent lambda;
  for (const LobeUse& l : lobes) {
    alpha.add(l.alphaX);
    lambda.add(l.alphaX > 0.0 ? l.alphaY / l.alphaX : 1.0);
  }
  std::map<std::tuple<long, long, long, long, int>, LobeUse> cells;
  for (const LobeUse& l : lobes) {
    const auto cell = [steps](double v) { return std::lround(v * steps); };
    const double ratio = l.alphaX > 0.0 ? l.alphaY / l.alphaX : 1.0;
    const int end = (l.alphaX == alpha.low ? 1 : 0) + (l.alphaX == alpha.high ? 2 : 0) +
                    (ratio == lambda.low ? 4 : 0) + (ratio == lambda.high ? 8 : 0);
    LobeUse& sum = cells[{cell(std::sqrt(l.alphaX)), cell(ratio), cell(l.f0), cell(l.f90), end}];
    const double weight = sum.weight + l.weight;
    const auto mean = [&](double LobeUse::*field) {
      if (sum.weight == 0.0 || sum.*field == l.*field) {
        sum.*field = l.*field;
      } else {
        sum.*field = (sum.*field * sum.weight + l.*field * l.weight) / weight;
      }
    };
    mean(&LobeUse::alphaX);
    mean(&LobeUse::alphaY);
    mean(&LobeUse::f0);
    mean(&LobeUse::f90);
    sum.weight = weight;
  }
  std::vector<LobeUse> out;
  for (const auto& [key, lobe] : cells) out.push_back(lobe);
  return out;
}

MaterialSummary summaryOf(const MaterialUse& material) {
  MaterialSummary s{material.name,   material.area, material.textured ? material.texels : 0, {}, {}, {},
                    material.reasons};
  LobeExtent roughness;
  LobeExtent lambda;
  LobeExtent f0;
  double mean = 0.0;
  double weight = 0.0;
  for (const LobeUse& l : material.lobes) {
    roughness.add(std::sqrt(l.alphaX));
    lambda.add(l.alphaX > 0.0 ? l.alphaY / l.alphaX : 1.0);
    f0.add(l.f0);
    mean += l.weight * std::sqrt(l.alphaX);
    weight += l.weight;
  }
  s.roughness = {roughness.low, weight > 0.0 ? mean / weight : roughness.low, roughness.high};
  s.lambda = {lambda.low, lambda.high};
  s.f0 = {f0.low, f0.high};
  return s;
}

TableCost costOf(const std::vector<Axis>& axes, const std::vector<std::string>& amplitudes,
                 Precision precision, double error) {
  TableInfo info;
  info.axes = axes;
  info.channels = amplitudes;
  const LeanSize size = leanSize(info, precision);
  TableCost cost;
  for (const Axis& axis : axes) cost.nodes.push_back(axis.size());
  cost.bytes = size.bytes;
  cost.textures = size.textures;
  cost.fetches = static_cast<std::size_t>(fetchesOf(info));
  cost.error = error;
  return cost;
}

std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

void explainRange(const AxisRange& range, std::vector<std::string>* reasons) {
  if (range.name == "theta") {
    if (range.low > 0.0 || range.high < 1.57)
      reasons->push_back(fmt::format("theta: the scene is seen from {:.3g} to {:.3g} degrees only",
                                     range.low * 57.29577951, range.high * 57.29577951));
    return;
  }
  if (range.name == "phi") return;
  const bool alpha = range.name == "alpha";
  const char* const what = alpha ? "roughness (the root of alpha)" : "lambda (alpha_y / alpha_x)";
  const double low = alpha ? std::sqrt(range.low) : range.low;
  const double high = alpha ? std::sqrt(range.high) : range.high;
  reasons->push_back(
      range.isSingle()
          ? fmt::format("{}: all lobes have {} {:.3g}, one node", range.name, what, low)
          : fmt::format("{}: {} is {:.3g} to {:.3g}, margin included", range.name, what, low, high));
}

double weightOf(const LobeDistribution& distribution) {
  double sum = 0.0;
  for (const LobeUse& lobe : distribution.lobes) sum += lobe.weight;
  return sum;
}

// What a table is chosen from.
struct Candidates {
  LobeDistribution distribution;
  double share = 0.0;  // of the distribution in all lobes
  std::vector<std::string> amplitudes;
  std::unique_ptr<InterpolationModel> model;
  std::unique_ptr<TableDesigns> designs;

  std::size_t bytes(const TableDesign& d) const {
    return shippedBytes(designs->axes(d), amplitudes, Precision::kHalf);
  }
};

Candidates makeCandidates(LobeDistribution distribution, double share, const PlanRequest& request,
                          int threads, const FitProgress& progress) {
  Candidates c;
  c.distribution = std::move(distribution);
  c.share = share;
  c.amplitudes = neededAmplitudes(c.distribution);
  const InterpolationModelOptions options = modelOptions(request, c.distribution.isotropic, threads);
  c.model = std::make_unique<InterpolationModel>(
      c.distribution, axisRanges(c.distribution, request.alphaFloor, request.margin), options, progress);
  c.designs = std::make_unique<TableDesigns>(*c.model);
  return c;
}

// Of maxBytes so many for the first table that the error over the lobes of both is least; the rest is the
// second's.
std::size_t firstShare(const Candidates& first, const Candidates& second, std::size_t maxBytes) {
  std::size_t best = 1;
  double least = std::numeric_limits<double>::infinity();
  const std::vector<TableDesign>& other = second.designs->front();
  std::size_t k = other.size();
  for (const TableDesign& d : first.designs->front()) {
    const std::size_t bytes = first.bytes(d);
    while (k > 0 && bytes + second.bytes(other[k - 1]) > maxBytes) --k;
    if (k == 0) break;
    const double error = first.share * d.error + second.share * other[k - 1].error;
    if (error < least) {
      least = error;
      best = maxBytes - second.bytes(other[k - 1]);
    }
  }
  return best;
}

PlannedTable planTable(const Candidates& c, const PlanRequest& request, std::size_t maxBytes) {
  PlannedTable t;
  t.distribution = c.distribution;
  t.amplitudes = c.amplitudes;
  t.maxBytes = maxBytes;
  const LobeDistribution& distribution = c.distribution;
  const InterpolationModel& model = *c.model;
  const TableDesigns& designs = *c.designs;
  // measured errors are above predicted ones by a tenth to a fifth (DESIGN.md, Tailored tables), and the fit
  // asks for two standard errors below the bound
  constexpr double kSafety = 1.25;
  // of the curve, points that differ by more than a sixth
  constexpr double kCurveStep = 0.85;
  const std::vector<Axis> full = fullAxes(distribution.isotropic, request.alphaFloor);
  t.full = costOf(full, {"norm", "fresnel"}, Precision::kHalf, model.error(full));
  t.maxError = request.maxError;
  if (request.noStricterThanFull && t.full.error > t.maxError) {
    // two digits, as it is printed, rounded up
    const double step = std::pow(10.0, std::floor(std::log10(t.full.error)) - 1.0);
    t.maxError = std::min(1.0, std::ceil(t.full.error / step) * step);
  }
  const TableDesign* chosen = &designs.front().front();
  t.reachable = false;
  double last = 0.0;
  for (const TableDesign& d : designs.front()) {
    const std::size_t bytes = c.bytes(d);
    if (t.curve.empty() || d.error < kCurveStep * last) {
      t.curve.emplace_back(bytes, d.error);
      last = d.error;
    }
    if (maxBytes > 0 && bytes > maxBytes) break;
    if (!t.reachable) chosen = &d;
    if (t.maxError > 0.0 && kSafety * d.error <= t.maxError) t.reachable = true;
  }
  if (request.maxError == 0.0 && c.bytes(*chosen) <= maxBytes) t.reachable = true;
  t.axes = designs.axes(*chosen);
  t.cost = costOf(t.axes, t.amplitudes, Precision::kHalf, chosen->error);
  t.reasons.push_back(fmt::format("{} of the scene's lobes, by the surface that has them, are {}",
                                  percent(c.share), distribution.isotropic ? "isotropic" : "anisotropic"));
  for (const AxisRange& range : model.ranges()) explainRange(range, &t.reasons);
  t.reasons.emplace_back(
      distribution.isotropic
          ? "matrix: 4 coefficients, Minv over its middle element, which the plane of incidence's "
            "mirror leaves; no inversion in the shader"
          : "matrix: all 9 coefficients of M, inverted in the shader");
  t.reasons.emplace_back(
      "halves: floats only where halves alone cost half of the bound, which the fit measures");
  const auto has = [&](const char* name) {
    return std::find(t.amplitudes.begin(), t.amplitudes.end(), name) != t.amplitudes.end();
  };
  t.reasons.emplace_back(has("norm") ? "norm: it scales every lobe" : "norm: left out, F0 is 0 everywhere");
  t.reasons.emplace_back(has("fresnel") ? "fresnel: F0 differs from F90"
                                        : "fresnel: left out, F0 is F90 everywhere");
  if (model.leftOut() > 0)
    t.reasons.push_back(fmt::format("{} of {} sampled lobes could not be fitted and do not count",
                                    model.leftOut(), model.leftOut() + model.lookUps()));
  return t;
}

// What the shader's integral has to be, by the kinds of lights.
std::vector<std::string> shadingOf(const LightUse& lights) {
  std::vector<std::string> out;
  if (lights.polygon || !lights.any())
    out.emplace_back("polygons: ltcQuad or ltcPolygon of ltc.glsl, clipped exactly; no texture for it");
  if (lights.disk || lights.sphere)
    out.emplace_back(
        "disks and spheres: as polygons (ltcPolygon), or by their vector form factor and the closed fit of "
        "ltc_proxy.glsl; the sphere table (t2.w of the layout of 2017) is not needed");
  if (lights.textured)
    out.emplace_back(
        "textured: ltc_textured.glsl and a chain of prefiltered levels for each texture (ltcfit prefilter)");
  if (lights.twoSided) out.emplace_back("two-sided lights: abs() of the integral");
  if (lights.oneSided || !lights.twoSided)
    out.emplace_back(
        "one-sided lights: max(0, .) of the integral, after ltcFacing, which spares the look-up");
  return out;
}

}  // namespace

bool PlanRequest::isValid(std::string* error) const {
  const auto check = [error](const char* name, double v, double low, double high) {
    if (v >= low && v <= high) return true;
    *error = fmt::format("{} {}: need {} to {}", name, v, low, high);
    return false;
  };
  if (maxError == 0.0 && maxBytes == 0) {
    *error = "max-error 0: needs a bound of the bytes";
    return false;
  }
  return (maxError == 0.0 || check("max-error", maxError, 1e-5, 1.0)) && check("margin", margin, 0.0, 1.0) &&
         check("alpha-floor", alphaFloor, 1e-5, 0.1) && check("seed", static_cast<double>(seed), 0.0, 9e15);
}

std::string whyNoTable(const SceneUse& use) {
  if (use.materials.empty()) return "No table is needed: nothing that the scene shows has a specular lobe.";
  constexpr std::size_t kMostNames = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(use.materials.size(), kMostNames); ++i)
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", use.materials[i].name);
  if (use.materials.size() > kMostNames)
    names += fmt::format(" and {} more", use.materials.size() - kMostNames);
  return fmt::format("No table is needed: no lobe reflects anything, F0 and F90 are 0 ({}).", names);
}

LobeDistribution distributionOf(const SceneUse& use, bool isotropic) {
  LobeDistribution d;
  d.isotropic = isotropic;
  d.views = use.views;
  for (const MaterialUse& material : use.materials) {
    for (const LobeUse& lobe : material.lobes) {
      const bool reflects = lobe.weight > 0.0 && (lobe.f0 > 0.0 || lobe.f90 > 0.0);
      if (reflects && (lobe.alphaX == lobe.alphaY) == isotropic) d.lobes.push_back(lobe);
    }
  }
  // distinct ones first, then coarser and coarser
  std::vector<LobeUse> lobes = merged(d.lobes, 4096.0);
  for (double steps = 256.0; lobes.size() > kMostLobes; steps *= 0.5) lobes = merged(d.lobes, steps);
  d.lobes = std::move(lobes);
  return d;
}

InterpolationModelOptions modelOptions(const PlanRequest& request, bool isotropic, int threads) {
  InterpolationModelOptions o;
  o.fit = tableFitPreset(isotropic ? TableKind::kIsotropic : TableKind::kAnisotropic, kDefaultFitter);
  o.alphaFloor = request.alphaFloor;
  // errors of designs come within some 10 % of those of twice as many points (DESIGN.md, Tailored tables)
  o.points = isotropic ? 96 : 48;
  o.lineFits = 11;
  o.seed = static_cast<std::uint64_t>(request.seed);
  o.threads = threads;
  return o;
}

ScenePlan planScene(const SceneUse& use, const PlanRequest& request, int threads,
                    const FitProgress& progress) {
  ScenePlan plan;
  plan.scene = use.name;
  plan.request = request;
  plan.lights = use.lights;
  plan.notes = use.notes;
  for (const MaterialUse& material : use.materials) plan.materials.push_back(summaryOf(material));
  std::vector<LobeDistribution> distributions;
  double weight = 0.0;
  for (const bool isotropic : {true, false}) {
    LobeDistribution d = distributionOf(use, isotropic);
    if (d.lobes.empty()) continue;
    weight += weightOf(d);
    distributions.push_back(std::move(d));
  }
  std::vector<Candidates> candidates;
  for (LobeDistribution& d : distributions) {
    const double share = weightOf(d) / weight;
    candidates.push_back(makeCandidates(std::move(d), share, request, threads, progress));
  }
  std::size_t left = request.maxBytes;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool shared = i == 0 && candidates.size() == 2 && left > 0 && request.maxError == 0.0;
    plan.tables.push_back(
        planTable(candidates[i], request, shared ? firstShare(candidates[0], candidates[1], left) : left));
    const std::size_t used = shared ? plan.tables.back().maxBytes : plan.tables.back().cost.bytes;
    if (left > 0) left = left > used ? left - used : 1;
  }
  if (plan.tables.empty()) plan.notes.push_back(whyNoTable(use));
  plan.shading = shadingOf(use.lights);
  return plan;
}

}  // namespace ltcfit

#include "report/report_json.h"

#include <fmt/format.h>

#include <array>
#include <variant>

#include "base/angles.h"
#include "export/figure.h"

namespace ltcfit {
namespace {

struct MetricText {
  Metric metric;
  const char* unit;
  const char* meaning;
};
// In the order of the page: what lights see first.
constexpr std::array<MetricText, 13> kMetrics{{
    {Metric::kLightS, "",
     "RMS error of the reflected light over random lights of half-size 0.05 at distance 1."},
    {Metric::kLightM, "", "The same for half-size 0.25."},
    {Metric::kLightL, "", "The same for half-size 0.8."},
    {Metric::kForm, "", "Mean difference of the integrals over random quads near the lobe."},
    {Metric::kSw1, "", "Mean over projections of the distance between the CDFs of lobe and fit, 0 to 2."},
    {Metric::kSw1Rel, "", "SW1 in units of the lobe's width."},
    {Metric::kTv, "", "Total variation, 0 to 1: the share of the light that goes elsewhere."},
    {Metric::kL3, "sr^-2/3", "L3 norm of the difference of the densities."},
    {Metric::kL3Cost, "sr^-2",
     "Integral of the cubed difference, not normalised: the objective of Heitz et al. 2016."},
    {Metric::kBelow, "", "Mass of the fit below the horizon: light that leaks."},
    {Metric::kAlbedoError, "", "Error of the stored norm, the directional albedo."},
    {Metric::kFresnelError, "", "Error of the stored Fresnel term."},
    {Metric::kDetError, "", "Relative error of the determinant of the inverse in float32 arithmetic."},
}};

constexpr std::array kLobeFigures{Metric::kSw1Rel, Metric::kTv,     Metric::kForm, Metric::kLightS,
                                  Metric::kLightM, Metric::kLightL, Metric::kBelow};

Json figures(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(figure(v));
  return out;
}

Json summaryJson(const Summary& s) {
  const auto known = [&](double v) { return s.count > 0 ? figure(v) : Json(nullptr); };
  return {{"mean", known(s.mean)}, {"p50", known(s.p50)}, {"p90", known(s.p90)},      {"p99", known(s.p99)},
          {"max", known(s.max)},   {"count", s.count},    {"non_finite", s.nonFinite}};
}

Json axisJson(const Axis& axis) {
  const bool angle = axis.unit == "rad";
  Json values = Json::array();
  for (const double v : axis.values) values.push_back(figure(angle ? v * kDegreesPerRadian : v));
  return {{"name", axis.name}, {"unit", angle ? "degrees" : ""}, {"values", values}};
}

Json provenanceJson(const Provenance& p) {
  Json options = Json::object();
  for (const auto& [key, value] : p.options) {
    Json& option = options[key];
    std::visit([&](const auto& v) { option = v; }, value);
  }
  return {{"tool", p.tool},
          {"tool_version", p.toolVersion},
          {"command", p.command},
          {"seed", p.seed},
          {"options", options}};
}

Json verdictsJson(const std::vector<Verdict>& verdicts) {
  Json out = Json::array();
  for (const Verdict& v : verdicts)
    out.push_back({{"what", v.what},
                   {"value", figure(v.value)},
                   {"limit", v.limit},
                   {"relation", "<="},
                   {"pass", v.passes()},
                   {"detail", v.detail}});
  return out;
}

Json scoresJson(const std::vector<ReportTable>& tables, const std::vector<ScoredSet>& sets) {
  Json out = Json::array();
  for (const ScoredSet& set : sets) {
    Json results = Json::array();
    for (std::size_t t = 0; t < tables.size(); ++t) {
      const Score& score = set.scores[t];
      Json metrics = Json::object();
      for (const MetricText& m : kMetrics) {
        const auto k = static_cast<std::size_t>(m.metric);
        if (score.present[k]) metrics[metricName(m.metric)] = summaryJson(score.summary[k]);
      }
      results.push_back({{"table", tables[t].name},
                         {"singular", score.singular},
                         {"singular_float32", score.singularFloat32},
                         {"metrics", metrics}});
    }
    out.push_back({{"points", pointSetName(set.set)}, {"count", set.scores[0].points}, {"results", results}});
  }
  return out;
}

Json mapsJson(const std::vector<ReportTable>& tables, const ScoredSet& nodes) {
  Json out = Json::array();
  for (const MetricText& m : kMetrics) {
    for (std::size_t t = 0; t < tables.size(); ++t) {
      if (!nodes.scores[t].present[static_cast<std::size_t>(m.metric)]) continue;
      Json values = Json::array();
      for (const PointScore& point : nodes.scores[t].all)
        values.push_back(figure(point.metrics.get(m.metric)));
      out.push_back({{"metric", metricName(m.metric)}, {"table", tables[t].name}, {"values", values}});
    }
  }
  return out;
}

Json histogramsJson(const std::vector<ReportTable>& tables, const std::vector<ReportHistogram>& histograms) {
  Json out = Json::array();
  for (const ReportHistogram& h : histograms) {
    if (h.histogram.edges.empty()) continue;  // no positive value in any table
    Json series = Json::array();
    for (std::size_t t = 0; t < tables.size(); ++t) {
      const HistogramSeries& s = h.histogram.series[t];
      series.push_back(
          {{"table", tables[t].name}, {"counts", s.counts}, {"zero", s.zero}, {"non_finite", s.nonFinite}});
    }
    out.push_back({{"points", pointSetName(h.set)},
                   {"metric", metricName(h.metric)},
                   {"edges", figures(h.histogram.edges)},
                   {"log", true},
                   {"series", series}});
  }
  return out;
}

// Nodes of the other tables compare one by one only where their axes have the same number of nodes.
bool sameSizes(const Table& a, const Table& b) {
  for (std::size_t i = 0; i < a.info().axes.size(); ++i)
    if (a.info().axes[i].size() != b.info().axes[i].size()) return false;
  return true;
}

Json smoothnessJson(const std::vector<ReportTable>& tables,
                    const std::vector<std::vector<AxisSmoothness>>& smoothness) {
  Json axes = Json::array();
  Json maps = Json::array();
  for (std::size_t a = 0; a < smoothness[0].size(); ++a) {
    Json results = Json::array();
    for (std::size_t t = 0; t < tables.size(); ++t) {
      const AxisSmoothness& s = smoothness[t][a];
      results.push_back({{"table", tables[t].name}, {"summary", summaryJson(s.summary)}});
      if (sameSizes(tables[0].file, tables[t].file))
        maps.push_back({{"axis", s.axis}, {"table", tables[t].name}, {"values", figures(s.steps)}});
    }
    axes.push_back({{"axis", smoothness[0][a].axis}, {"results", results}});
  }
  return {
      {"meaning",
       "How much farther the fetched lobe travels from a node, over the lobe half way, to the next node than "
       "the true lobe does: sliced Wasserstein distances, in units of the lobe's width. 0: no farther; a "
       "lobe "
       "that is off its neighbours or does not interpolate stands out."},
      {"unit", "lobe widths"},
      {"axes", axes},
      {"maps", maps}};
}

std::string place(const LobeParameters& p, bool isotropic) {
  if (isotropic) return fmt::format("alpha {:.3g}, theta {:.3g}°", p.alphaX, p.theta * kDegreesPerRadian);
  return fmt::format("alpha_x {:.3g}, alpha_y {:.3g}, theta {:.3g}°, phi {:.3g}°", p.alphaX, p.alphaY,
                     p.theta * kDegreesPerRadian, p.phi * kDegreesPerRadian);
}

class Pictures {
 public:
  Pictures(std::string prefix, std::string where, Json& images, Json& list)
      : prefix_(std::move(prefix)), where_(std::move(where)), images_(images), list_(list) {}

  void add(const Picture& picture, const std::string* table, const char* what) {
    const std::string id = fmt::format("{}-{}", prefix_, list_.size());
    images_[id] = fmt::format("data:image/png;base64,{}", toBase64(toPng(picture)));
    const std::string of = table == nullptr ? std::string() : fmt::format(" of {}", *table);
    list_.push_back({{"id", id},
                     {"table", table == nullptr ? Json(nullptr) : Json(*table)},
                     {"what", what},
                     {"alt", fmt::format("{}{} at {}", what, of, where_)}});
  }

 private:
  std::string prefix_;
  std::string where_;
  Json& images_;
  Json& list_;
};

Json lobeJson(const std::vector<ReportTable>& tables, const ReportLobe& lobe, const ScoredSet& nodes,
              const std::string& prefix, Json& images) {
  const std::string where = place(lobe.parameters, tables[0].file.isIsotropic());
  Json list = Json::array();
  Pictures pictures(prefix, where, images, list);
  pictures.add(lobe.pictures.lobe, nullptr, "GGX");
  Json figuresOfTables = Json::array();
  for (std::size_t t = 0; t < tables.size(); ++t) {
    if (const std::optional<LobePictures::Ltc>& ltc = lobe.pictures.tables[t]) {
      pictures.add(ltc->density, &tables[t].name, "LTC");
      pictures.add(ltc->difference, &tables[t].name, "difference");
    }
    Json metrics = Json::object();
    const EntryMetrics& values = nodes.scores[t].all[lobe.node].metrics;
    for (const Metric m : kLobeFigures) metrics[metricName(m)] = figure(values.get(m));
    figuresOfTables.push_back({{"table", tables[t].name}, {"metrics", metrics}});
  }
  const LobeParameters& p = lobe.parameters;
  return {{"title", fmt::format("{}: {}", lobe.why, where)},
          {"parameters",
           {{"alpha_x", figure(p.alphaX)},
            {"alpha_y", figure(p.alphaY)},
            {"theta_degrees", figure(p.theta * kDegreesPerRadian)},
            {"phi_degrees", figure(p.phi * kDegreesPerRadian)}}},
          {"half_width_degrees", figure(lobe.pictures.window.halfWidth * kDegreesPerRadian)},
          {"peak", figure(lobe.pictures.peak)},
          {"difference", figure(lobe.pictures.difference)},
          {"images", list},
          {"figures", figuresOfTables}};
}

}  // namespace

Json reportHead(const ReportSettings& settings) {
  Json metrics = Json::array();
  for (const MetricText& m : kMetrics)
    metrics.push_back({{"name", metricName(m.metric)}, {"unit", m.unit}, {"meaning", m.meaning}});
  const MetricOptions& o = settings.options.metrics;
  return {{"format", "ltcfit-report"},
          {"version", 1},
          {"command", settings.command},
          {"tool_version", LTCFIT_VERSION},
          {"options",
           {{"seed", settings.seed},
            {"samples", o.samples},
            {"directions", o.directions},
            {"quads", o.quads},
            {"lights", o.lights},
            {"points", settings.options.points},
            {"stored_as", settings.storedAs}}},
          {"metrics", metrics},
          {"tables", Json::array()},
          {"shading", Json::array()},
          {"pareto", Json::array()},
          {"stability", nullptr}};
}

Json tableReportJson(const std::vector<ReportTable>& tables, const TableReport& report, std::size_t number,
                     Json& images) {
  const TableInfo& info = tables[0].file.info();
  const TableInfo& read = tables[0].read.info();
  Json axes = Json::array();
  for (const Axis& axis : info.axes) axes.push_back(axisJson(axis));
  Json against = Json::array();
  for (std::size_t t = 1; t < tables.size(); ++t) against.push_back(tables[t].name);
  Json lobes = Json::array();
  for (const ReportLobe& lobe : report.lobes)
    lobes.push_back(
        lobeJson(tables, lobe, report.sets[0], fmt::format("lobe-{}-{}", number, lobes.size()), images));
  return {{"name", tables[0].name},
          {"kind", tables[0].file.isIsotropic() ? "isotropic" : "anisotropic"},
          {"nodes", tables[0].file.nodeCount()},
          {"axes", axes},
          {"stores", matrixStorageName(info.stores)},
          {"normalization", matrixNormalizationName(info.normalization)},
          {"interpolated",
           {{"stores", matrixStorageName(read.stores)},
            {"normalization", matrixNormalizationName(read.normalization)}}},
          {"channels", info.channels},
          {"alpha_floor", figure(info.alphaFloor)},
          {"provenance", provenanceJson(info.provenance)},
          {"against", against},
          {"verdicts", verdictsJson(report.verdicts)},
          {"scores", scoresJson(tables, report.sets)},
          {"maps", mapsJson(tables, report.sets[0])},
          {"histograms", histogramsJson(tables, report.histograms)},
          {"smoothness", smoothnessJson(tables, report.smoothness)},
          {"lobes", lobes}};
}

}  // namespace ltcfit

#include "report/report_json.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <set>

#include "export/figure.h"
#include "fit/isotropic_table_fit.h"
#include "fit/target_lobe.h"
#include "ggx/moments.h"
#include "report/verdicts.h"

namespace ltcfit {
namespace {

ReportTable fitted(const std::string& name) {
  IsotropicFitOptions o;
  o.table.thetaNodes = o.table.alphaNodes = 6;
  const IsotropicFitResult r = fitIsotropicTable(o);
  const Table table(r.info, r.data);
  return {name, table, storedAs(table, MatrixStorage::kMinv, MatrixNormalization::kMiddleElement)};
}

ReportTable with(const ReportTable& table, std::vector<float> data) {
  const Table file(table.file.info(), std::move(data));
  return {table.name, file, storedAs(file, MatrixStorage::kMinv, MatrixNormalization::kMiddleElement)};
}

// All lobes half again as wide in the plane of incidence.
ReportTable widened(const std::string& name) {
  const ReportTable good = fitted(name);
  std::vector<float> data = good.file.data();
  for (std::size_t i = 0; i < data.size(); i += good.file.channelCount()) data[i] *= 1.5f;
  return with(good, data);
}

// The norm of one node off by a tenth, the matrix of another turned inside out.
ReportTable spoilt(const std::string& name) {
  const ReportTable good = fitted(name);
  std::vector<float> data = good.file.data();
  const std::size_t channels = good.file.channelCount();
  data[10 * channels + 5] += 0.1f;
  for (std::size_t c : {0u, 3u}) data[20 * channels + c] *= -1.0f;  // column 0: m00, m20
  return with(good, data);
}

ReportSettings quick() {
  ReportSettings s;
  s.options.metrics.samples = 128;
  s.options.metrics.directions = 4;
  s.options.metrics.quads = s.options.metrics.lights = 4;
  s.options.points = 10;
  s.command = "ltcfit report a.json";
  return s;
}

const Json& find(const Json& list, const char* key, const std::string& value) {
  for (const Json& item : list)
    if (item[key].get<std::string>() == value) return item;
  ADD_FAILURE() << "no " << key << " " << value;
  return list;
}

TEST(ReportJson, FiguresHaveFiveDigits) {
  EXPECT_EQ(figure(1.23456789), 1.2346);
  EXPECT_EQ(figure(-1.23456789e-9), -1.2346e-9);
  EXPECT_EQ(figure(0.0), 0.0);
  EXPECT_TRUE(figure(std::nan("")).is_null());
  EXPECT_TRUE(figure(-INFINITY).is_null());
}

TEST(ReportJson, HoldsEveryPart) {
  const ReportSettings settings = quick();
  const std::vector<ReportTable> tables{fitted("a.json"), spoilt("b.json")};
  const TableReport report = reportTable(tables, settings.options);
  Json images = Json::object();
  const Json t = tableReportJson(tables, report, 1, images);
  EXPECT_EQ(t["kind"], "isotropic");
  EXPECT_EQ(t["nodes"], 36);
  EXPECT_EQ(t["axes"][0]["unit"], "degrees");
  EXPECT_EQ(t["axes"][0]["values"].back(), 90.0);
  EXPECT_EQ(t["interpolated"]["stores"], "Minv");
  EXPECT_EQ(t["against"], Json({"b.json"}));
  ASSERT_EQ(t["scores"].size(), 3u);
  for (const Json& score : t["scores"]) {
    EXPECT_EQ(score["count"], score["points"] == "nodes" ? 36 : 10);
    ASSERT_EQ(score["results"].size(), 2u);
    EXPECT_EQ(score["results"][0]["metrics"]["TV"]["count"], score["count"]);
  }
  // 13 metrics of two tables
  EXPECT_EQ(t["maps"].size(), 26u);
  for (const Json& map : t["maps"]) EXPECT_EQ(map["values"].size(), 36u);
  for (const Json& h : t["histograms"]) {
    ASSERT_EQ(h["series"].size(), 2u);
    EXPECT_EQ(h["edges"].size(), h["series"][0]["counts"].size() + 1);
    std::size_t sum = 0;
    for (const Json& count : h["series"][0]["counts"]) sum += count.get<std::size_t>();
    sum += h["series"][0]["zero"].get<std::size_t>() + h["series"][0]["non_finite"].get<std::size_t>();
    EXPECT_EQ(sum, h["points"] == "nodes" ? 36u : 10u);
  }
  EXPECT_EQ(t["smoothness"]["axes"].size(), 2u);
  EXPECT_EQ(t["smoothness"]["maps"].size(), 4u);
  EXPECT_EQ(t["smoothness"]["maps"][0]["values"].size(), 36u);
  ASSERT_GE(t["lobes"].size(), 5u);
  std::set<std::string> ids;
  for (const Json& lobe : t["lobes"]) {
    EXPECT_EQ(lobe["images"].size(), 5u);
    EXPECT_EQ(lobe["figures"].size(), 2u);
    EXPECT_GE(lobe["peak"].get<double>(), lobe["difference"].get<double>());
    for (const Json& image : lobe["images"]) {
      const std::string id = image["id"].get<std::string>();
      EXPECT_TRUE(ids.insert(id).second);
      ASSERT_TRUE(images.contains(id));
      EXPECT_EQ(images[id].get<std::string>().rfind("data:image/png;base64,iVBOR", 0), 0u);
    }
  }
  EXPECT_EQ(ids.size(), images.size());
}

TEST(ReportJson, VerdictsTellAGoodTableFromASpoiltOne) {
  const ReportSettings settings = quick();
  const auto verdicts = [&](ReportTable first, ReportTable second) {
    const std::vector<ReportTable> tables{std::move(first), std::move(second)};
    Json images = Json::object();
    return tableReportJson(tables, reportTable(tables, settings.options), 0, images)["verdicts"];
  };
  const Json good = verdicts(fitted("a"), widened("b"));
  for (const char* what : {"Nodes without an inverse in float32", "Nodes where det M is not above 0",
                           "Norm, largest error at nodes", "Fresnel, largest error at nodes",
                           "Mean light_m off-grid over that of b", "Mean SW1 off-grid over that of b"})
    EXPECT_TRUE(find(good, "what", what)["pass"].get<bool>()) << find(good, "what", what).dump();
  const Json wide = verdicts(widened("b"), fitted("a"));
  for (const char* what : {"Mean light_m off-grid over that of a", "Mean SW1 off-grid over that of a"}) {
    EXPECT_FALSE(find(wide, "what", what)["pass"].get<bool>());
    EXPECT_GT(find(wide, "what", what)["value"].get<double>(), 1.5);
  }
  const Json bad = verdicts(spoilt("b"), fitted("a"));
  EXPECT_FALSE(find(bad, "what", "Norm, largest error at nodes")["pass"].get<bool>());
  EXPECT_NEAR(find(bad, "what", "Norm, largest error at nodes")["value"].get<double>(), 0.1, 1e-4);
  EXPECT_EQ(find(bad, "what", "Nodes where det M is not above 0")["value"], 1.0);
  EXPECT_TRUE(find(bad, "what", "Fresnel, largest error at nodes")["pass"].get<bool>());
}

TEST(Verdicts, RatioOfMeansAndItsStandardError) {
  // a = {1, 2, 3, 6}, b = {2, 2, 4, 4}: ratio 1, differences -1, 0, -1, 2, sd sqrt(6 / 3), over sqrt(4) * 3
  const MeanRatio r = ratioOfMeans({1, 2, 3, 6}, {2, 2, 4, 4});
  EXPECT_NEAR(r.ratio, 1.0, 1e-15);
  EXPECT_NEAR(r.standardError, std::sqrt(2.0) / 6.0, 1e-15);
  EXPECT_EQ(r.points, 4u);
  // a common factor of all points leaves nothing to chance
  const MeanRatio twice = ratioOfMeans({2, 6, 10}, {1, 3, 5});
  EXPECT_EQ(twice.ratio, 2.0);
  EXPECT_EQ(twice.standardError, 0.0);
  // pairs with a hole are left out of both
  const MeanRatio holes = ratioOfMeans({1, 2, 3, 6, 100, 5}, {2, 2, 4, 4, std::nan(""), INFINITY});
  EXPECT_EQ(holes.ratio, r.ratio);
  EXPECT_EQ(holes.standardError, r.standardError);
  EXPECT_EQ(holes.points, 4u);
  EXPECT_EQ(ratioOfMeans({3}, {2}).ratio, 1.5);
  EXPECT_EQ(ratioOfMeans({3}, {2}).standardError, 0.0);
  EXPECT_TRUE(std::isnan(ratioOfMeans({1}, {0}).ratio));
  EXPECT_TRUE(std::isnan(ratioOfMeans({}, {}).ratio));
}

TEST(Verdicts, TheStandardErrorIsTheSpreadOverDraws) {
  std::mt19937_64 random(1);
  const auto draw = [&] { return 0.5 + static_cast<double>(random() >> 11) * 0x1p-53; };
  constexpr int kDraws = 400;
  double sum = 0.0, squares = 0.0, told = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    std::vector<double> a, b;
    for (int k = 0; k < 100; ++k) {
      b.push_back(draw());
      a.push_back(0.8 * b.back() * draw());
    }
    const MeanRatio r = ratioOfMeans(a, b);
    sum += r.ratio;
    squares += r.ratio * r.ratio;
    told += r.standardError / kDraws;
  }
  const double spread = std::sqrt((squares - sum * sum / kDraws) / (kDraws - 1));
  // a spread over 400 draws is known to 1 / sqrt(800) = 3.5 %: four of these
  EXPECT_NEAR(told / spread, 1.0, 0.14);
}

TEST(Verdicts, LimitsOfRatiosLeaveRoomForChance) {
  const ReportSettings settings = quick();
  const std::vector<ReportTable> tables{fitted("a"), widened("b")};
  Json images = Json::object();
  const Json verdicts = tableReportJson(tables, reportTable(tables, settings.options), 0, images)["verdicts"];
  const Json& light = find(verdicts, "what", "Mean light_m off-grid over that of b");
  EXPECT_GT(light["limit"].get<double>(), 1.0);
  const std::string detail = light["detail"].get<std::string>();
  EXPECT_EQ(detail.rfind("1 and two standard errors, ", 0), 0u) << detail;
  EXPECT_NE(detail.find(" each, over 10 points"), std::string::npos) << detail;
}

TEST(LobeImages, TheWindowIsAboutTheMeanWithTheNormalUp) {
  const Eigen::Vector3d mean(-0.6, 0.0, 0.5);
  const LobeWindow w = lobeWindow(mean, 0.2, Eigen::Vector3d(0.77, 0.0, 0.64));
  EXPECT_NEAR(w.halfWidth, 0.3, 1e-15);
  EXPECT_NEAR((w.direction(0.0, 0.0) - mean.normalized()).norm(), 0.0, 1e-15);
  // distances from the middle are kept
  EXPECT_NEAR(std::acos(w.direction(0.6, -0.8).dot(mean.normalized())), 0.3, 1e-12);
  EXPECT_GT(w.direction(0.0, 1.0).z(), w.direction(0.0, -1.0).z());
  EXPECT_NEAR(w.direction(1.0, 0.0).z(), w.direction(-1.0, 0.0).z(), 1e-15);
  // at most the hemisphere about it
  EXPECT_EQ(lobeWindow(Eigen::Vector3d::UnitZ(), 2.0, Eigen::Vector3d::UnitZ()).halfWidth,
            0.5 * std::numbers::pi);
}

TEST(LobeImages, ThePeakIsTheLobesAndTheDifferenceThatOfTheDensities) {
  // alpha 1 at normal view: the lobe is highest at the normal
  TableEntry entry;
  entry.m = Eigen::Matrix3d::Identity();
  entry.mInv = entry.m;
  entry.invertible = true;
  TableEntry singular = entry;
  singular.invertible = false;
  const LobePictures p = drawLobe("ggx", {1.0, 1.0, 0.0, 0.0}, {entry, singular});
  const std::unique_ptr<Lobe> lobe = makeTargetLobe("ggx", {1.0, 1.0, 0.0, 0.0});
  const double albedo = computeMoments(*lobe).albedo;
  // a pixel's mean near the top is lower by some 1e-4
  EXPECT_NEAR(p.peak, lobe->eval(Eigen::Vector3d::UnitZ()) / albedo, 1e-3 * p.peak);
  // the cosine's density at the normal is 1 / pi
  EXPECT_NEAR(p.difference, std::abs(1.0 / std::numbers::pi - p.peak), 0.02);
  ASSERT_TRUE(p.tables[0].has_value());
  EXPECT_FALSE(p.tables[1].has_value());
  EXPECT_EQ(p.lobe.rgb.size(), 3u * kPicturePixels * kPicturePixels);
}

}  // namespace
}  // namespace ltcfit

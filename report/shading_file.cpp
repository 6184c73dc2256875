#include "report/shading_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "export/atomic_file.h"
#include "report/json_checks.h"
#include "report/picture_checks.h"

namespace ltcfit {
namespace {

constexpr double kMostError = 1e39;  // float32 ends before
constexpr double kLeastPsnr = -1000.0;
constexpr double kMostPsnr = 150.0;  // where check-gl stops counting
constexpr double kMostSamples = 1e12;
constexpr std::size_t kMostName = 64;
// Figures have 5 digits; a mean of them against theirs is off by twice their rounding at most, 1e-4.
constexpr double kRounding = 1.1e-4;

double requireWithin(const JsonFields& fields, const char* key, double low, double high) {
  const double value = fields.number(key);
  if (!(value >= low && value <= high))
    throw InputError(fmt::format("{} is {:g}, not within {:g}..{:g}", fields.where(key), value, low, high));
  return value;
}

double requireError(const JsonFields& fields, const char* key) {
  return requireWithin(fields, key, 0.0, kMostError);
}

bool isNear(double a, double b) {
  return std::abs(a - b) <= kRounding * std::max(std::abs(a), std::abs(b));
}

std::optional<JsonFields> unlessNull(const JsonFields& fields, const char* key) {
  if (fields.get(key).is_null()) return std::nullopt;
  return JsonFields(fields.get(key), fields.where(key));
}

void requireTable(const JsonFields& table) {
  requireTexts(table, {"name", "source", "precision"});
  requireTruths(table, {"isotropic"});
}

// The RMSE.
double requireErrors(const JsonFields& error) {
  const double rmse = requireError(error, "rmse");
  requireError(error, "relative_mse");
  requireError(error, "largest");
  const double psnr = requireWithin(error, "psnr", kLeastPsnr, kMostPsnr);
  const double expected = rmse > 0.0 ? std::min(kMostPsnr, -20.0 * std::log10(rmse)) : kMostPsnr;
  // 20 log10(1 + kRounding) dB, and the rounding of the PSNR itself
  if (std::abs(psnr - expected) > 1e-3 + kRounding * std::abs(expected))
    throw InputError(
        fmt::format("{} is {:g}, and of the RMSE it is {:.5g}", error.where("psnr"), psnr, expected));
  return rmse;
}

using Clipping = std::vector<std::pair<std::string, double>>;

Clipping requireClipping(const JsonFields& clipping, const Json& json) {
  constexpr std::size_t kMostWays = 8;
  Clipping out;
  for (const auto& [way, value] : json.items()) out.emplace_back(way, requireError(clipping, way.c_str()));
  if (!clipping.has("exact")) clipping.fail("has no member exact");
  if (out.size() > kMostWays) clipping.fail(fmt::format("has more than {} members", kMostWays));
  return out;
}

// What the random scenes sum up to.
struct RandomScenes {
  std::size_t count = 0;
  std::size_t resolved = 0;
  std::size_t closer = 0;     // with the table, by more than the reference's own error
  std::size_t undecided = 0;  // on the border after rounding
  double rmse = 0.0;
  double against = 0.0;
  double reference = 0.0;
  Clipping clipping;
  std::size_t clipped = 0;  // scenes with figures of clipping
};

void addClipping(RandomScenes& sums, const Clipping& clipping, const JsonFields& scene) {
  if (sums.clipped++ == 0) sums.clipping.assign(clipping.size(), {});
  if (sums.clipping.size() != clipping.size())
    throw InputError(scene.where("clipping") + " has other members than that of scenes before");
  for (std::size_t i = 0; i < clipping.size(); ++i) {
    if (sums.clipped > 1 && sums.clipping[i].first != clipping[i].first)
      throw InputError(scene.where("clipping") + " has other members than that of scenes before");
    sums.clipping[i] = {clipping[i].first, sums.clipping[i].second + clipping[i].second};
  }
}

class SceneChecks {
 public:
  SceneChecks(bool hasOther, RandomScenes& sums) : hasOther_(hasOther), sums_(sums) {}

  // Whether it passes.
  bool require(const JsonFields& scene) {
    requireName(scene);
    requireTexts(scene, {"title", "loss", "explanation"});
    requireTruths(scene, {"random", "passed"});
    requireAlpha(scene);
    const bool passed = requireVerdict(scene);
    const double rmse = requireErrors(JsonFields(scene.get("error"), scene.where("error")));
    std::optional<double> other;
    if (const std::optional<JsonFields> against = unlessNull(scene, "against")) {
      if (!hasOther_) against->fail("is there, and the file's against is null");
      other = requireErrors(*against);
    }
    requireReference(scene, std::min(rmse, other.value_or(rmse)));
    if (!scene.text("explanation").empty() && !(other && *other <= rmse))
      throw InputError(scene.where("explanation") + " is there, and the other table is not nearer");
    requirePictures(scene, other.has_value());
    Clipping clipping;
    if (const std::optional<JsonFields> given = unlessNull(scene, "clipping"))
      clipping = requireClipping(*given, scene.get("clipping"));
    if (scene.get("random").get<bool>()) add(scene, rmse, other, clipping);
    return passed;
  }

 private:
  void requireName(const JsonFields& scene) {
    const std::string name = scene.text("name");
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
    });
    if (name.empty() || name.size() > kMostName || !plain)
      throw InputError(fmt::format("{} is not 1 to {} lower-case letters, digits and '-'",
                                   scene.where("name"), kMostName));
    if (!names_.insert(name).second) throw InputError(scene.where("name") + " is taken: " + name);
  }

  static void requireAlpha(const JsonFields& scene) {
    const std::vector<double> alpha = scene.numbers("alpha");
    if (alpha.size() != 2 ||
        !std::all_of(alpha.begin(), alpha.end(), [](double a) { return a > 0 && a <= 1; }))
      throw InputError(scene.where("alpha") + " is not two numbers above 0, up to 1");
  }

  static bool requireVerdict(const JsonFields& scene) {
    const JsonFields gl(scene.get("gl"), scene.where("gl"));
    const double psnr = requireWithin(gl, "psnr", kLeastPsnr, kMostPsnr);
    const double floor = requireWithin(gl, "floor", 0.0, kMostPsnr);
    requireError(gl, "largest");
    requireCounts(gl, {"non_finite", "kinds_differ", "pixels"});
    const auto isZero = [&](const char* key) { return gl.get(key).get<std::uint64_t>() == 0; };
    const bool finite = isZero("non_finite");
    const bool seen = !isZero("pixels");
    const bool passed = scene.get("passed").get<bool>();
    // rounding hides on which side of it the PSNR was
    const bool atFloor = isNear(psnr, floor);
    const bool high = psnr >= floor || atFloor;
    const bool low = psnr < floor || atFloor;
    // outlines that differ may fail a scene too, by a share of all pixels of the picture
    if (passed ? !(high && finite && seen) : !(low || !finite || !seen || !isZero("kinds_differ")))
      throw InputError(fmt::format("{} is {}, with a PSNR of {:g} dB, a floor of {:g} dB and {}",
                                   scene.where("passed"), passed, psnr, floor,
                                   !finite ? "pixels that are not finite"
                                   : seen  ? "finite pixels only"
                                           : "no pixels"));
    return passed;
  }

  static void requireReference(const JsonFields& scene, double judged) {
    const JsonFields reference(scene.get("reference"), scene.where("reference"));
    const double own = requireError(reference, "rmse");
    requireWithin(reference, "samples", 1.0, kMostSamples);
    requireTruths(reference, {"resolved"});
    const bool resolved = reference.get("resolved").get<bool>();
    const double tenth = 0.1 * judged;
    if (resolved != (own <= tenth) && !isNear(own, tenth))
      throw InputError(fmt::format("{} is {}, and its own error is {:g} where it judges {:g}",
                                   reference.where("resolved"), resolved, own, judged));
  }

  void requirePictures(const JsonFields& scene, bool against) {
    const std::optional<JsonFields> pictures = unlessNull(scene, "pictures");
    if (!pictures) return;
    for (const char* key : {"ltc", "reference", "difference"}) pictures_.require(*pictures, key);
    for (const char* key : {"against", "against_difference"}) {
      if (pictures->has(key) && !against)
        throw InputError(pictures->where(key) + " is there, and the scene's against is null");
      if (against) pictures_.require(*pictures, key);
    }
  }

  void add(const JsonFields& scene, double rmse, const std::optional<double>& other,
           const Clipping& clipping) {
    if (other.has_value() != hasOther_)
      throw InputError(scene.where("against") + " is null, and the file's against is not");
    const JsonFields reference(scene.get("reference"), scene.where("reference"));
    ++sums_.count;
    sums_.rmse += rmse;
    sums_.against += other.value_or(0.0);
    sums_.reference += reference.number("rmse");
    if (reference.get("resolved").get<bool>()) ++sums_.resolved;
    if (other) {
      const double lead = *other - rmse - reference.number("rmse");
      const double rounding = kRounding * (*other + rmse);
      if (lead > rounding) ++sums_.closer;
      if (std::abs(lead) <= rounding) ++sums_.undecided;
    }
    if (!clipping.empty()) addClipping(sums_, clipping, scene);
  }

  bool hasOther_;
  RandomScenes& sums_;
  PictureChecks pictures_;
  std::set<std::string> names_;
};

void requireCount(const JsonFields& random, const char* key, std::size_t least, std::size_t most) {
  requireCounts(random, {key});
  const auto value = random.get(key).get<std::uint64_t>();
  if (value < least || value > most)
    throw InputError(
        fmt::format("{} is {}, and of the scenes listed it is {}", random.where(key), value, least));
}

void requireMean(const JsonFields& fields, const char* key, double mean) {
  const double value = requireError(fields, key);
  if (!isNear(value, mean))
    throw InputError(
        fmt::format("{} is {:g}, and of the scenes listed it is {:.5g}", fields.where(key), value, mean));
}

void requireRandom(const JsonFields& file, bool hasOther, const RandomScenes& sums) {
  const std::optional<JsonFields> random = unlessNull(file, "random");
  if (!random) {
    if (sums.count > 0) throw InputError(fmt::format("random is null, and {} scenes are random", sums.count));
    return;
  }
  if (sums.count == 0) random->fail("is there, and no scene is random");
  const auto count = static_cast<double>(sums.count);
  requireCount(*random, "scenes", sums.count, sums.count);
  requireCount(*random, "resolved", sums.resolved, sums.resolved);
  requireMean(*random, "rmse", sums.rmse / count);
  requireMean(*random, "reference_rmse", sums.reference / count);
  for (const char* key : {"against_rmse", "closer"})
    if (random->get(key).is_null() == hasOther)
      throw InputError(fmt::format("{} is {}null, and the file's against is {}null", random->where(key),
                                   hasOther ? "" : "not ", hasOther ? "not " : ""));
  if (hasOther) {
    requireMean(*random, "against_rmse", sums.against / count);
    requireCount(*random, "closer", sums.closer, sums.closer + sums.undecided);
  }
  const std::optional<JsonFields> clipping = unlessNull(*random, "clipping");
  if (clipping.has_value() != (sums.clipped > 0))
    throw InputError(fmt::format("{} is {}null, and {} random scenes have figures of it",
                                 random->where("clipping"), clipping ? "not " : "", sums.clipped));
  if (!clipping) return;
  requireClipping(*clipping, random->get("clipping"));
  for (const auto& [way, sum] : sums.clipping)
    requireMean(*clipping, way.c_str(), sum / static_cast<double>(sums.clipped));
}

// Figures of random scenes that are not listed one by one.
void requireDielectric(const JsonFields& file, bool hasOther) {
  if (!file.has("dielectric")) return;
  const std::optional<JsonFields> sums = unlessNull(file, "dielectric");
  if (!sums) return;
  requireWithin(*sums, "f0", 0.0, 1.0);
  requireSome(*sums, {"scenes"});
  requireError(*sums, "rmse");
  if (!hasOther) return;
  requireError(*sums, "against_rmse");
  requireCount(*sums, "closer", 0, sums->get("scenes").get<std::uint64_t>());
}

void requireCost(const JsonFields& cost) {
  requireTexts(cost, {"name"});
  requireCounts(cost, {"fetches", "arithmetic", "selects", "branches", "total"});
  requireCountsByName(cost, "special");
  // a sum of counts that are too large for it would be wrong without notice
  constexpr std::uint64_t kMostCount = 1000000000;
  std::uint64_t sum = 0;
  const auto add = [&](const Json& value, const std::string& where) {
    if (value.get<std::uint64_t>() > kMostCount) throw InputError(where + " is above 1e9");
    sum += value.get<std::uint64_t>();
  };
  for (const char* key : {"fetches", "arithmetic", "selects", "branches"})
    add(cost.get(key), cost.where(key));
  for (const auto& [function, value] : cost.get("special").items())
    add(value, cost.where("special") + "." + function);
  if (cost.get("total").get<std::uint64_t>() != sum)
    throw InputError(fmt::format("{} is not the sum of the counts, {}", cost.where("total"), sum));
}

void checkShading(const JsonFields& file) {
  requireFormat(file, "ltcfit-shading");
  requireTexts(file, {"renderer"});
  requireOptions(file, "options");
  requireTruths(file, {"passed"});
  requireTable(JsonFields(file.get("table"), "table"));
  const std::optional<JsonFields> against = unlessNull(file, "against");
  if (against) requireTable(*against);
  requireNonEmpty(file, "scenes");
  RandomScenes sums;
  SceneChecks scenes(against.has_value(), sums);
  std::size_t failed = 0;
  forEach(file, "scenes", [&](const JsonFields& scene) {
    if (!scenes.require(scene)) ++failed;
  });
  if (file.get("passed").get<bool>() != (failed == 0))
    throw InputError(fmt::format("passed is {}, and {} scenes fail", failed != 0, failed));
  requireRandom(file, against.has_value(), sums);
  requireDielectric(file, against.has_value());
  forEach(file, "cost", requireCost);
  forEach(file, "frames", [](const JsonFields& frame) {
    requireTexts(frame, {"scene"});
    requireSeconds(frame, "seconds");
    requireSome(frame, {"width", "height"});
  });
}

}  // namespace

Json shadingFromJson(std::string_view text, const std::string& name) {
  return checkedJson(text, name, checkShading);
}

}  // namespace ltcfit

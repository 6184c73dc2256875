#include "report/stability_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/refusal.h"
#include "report/default_stability_set.h"

namespace ltcfit {
namespace {

constexpr std::size_t kMostValues = 64;
constexpr double kSmallestAlpha = 1e-5;

[[noreturn]] void refuse(const std::string& message) {
  throw Refusal("stability set: " + message);
}

double numberIn(const nlohmann::json& value, const std::string& field, double low, double high) {
  if (!value.is_number()) refuse(fmt::format("{} must be a number", field));
  const double v = value.get<double>();
  if (!(v >= low && v <= high)) refuse(fmt::format("{}: {} is not in {}..{}", field, v, low, high));
  return v;
}

std::vector<double> numbers(const nlohmann::json& root, const char* field, double low, double high) {
  const auto found = root.find(field);
  if (found == root.end() || !found->is_array() || found->empty() || found->size() > kMostValues)
    refuse(fmt::format("{} must be a list of 1 to {} numbers", field, kMostValues));
  std::vector<double> out;
  for (const nlohmann::json& v : *found) out.push_back(numberIn(v, field, low, high));
  return out;
}

double radians(double degrees) {
  return degrees == 90.0 ? 0.5 * std::numbers::pi : degrees / 180.0 * std::numbers::pi;
}

}  // namespace

StabilitySet parseStabilitySet(std::string_view text) {
  const nlohmann::json root = nlohmann::json::parse(text, nullptr, false);
  if (!root.is_object()) refuse("not a JSON object");
  if (root.value("format", nlohmann::json()) != "ltcfit-stability-set")
    refuse("format must be \"ltcfit-stability-set\"");
  if (root.value("version", nlohmann::json()) != 1) refuse("version must be 1");
  StabilitySet set;
  const nlohmann::json name = root.value("name", nlohmann::json(""));
  if (!name.is_string()) refuse("name must be a text");
  set.name = name.get<std::string>();
  set.alpha = numbers(root, "alpha", kSmallestAlpha, 1.0);
  set.lambda = numbers(root, "lambda", 1e-5, 1.0);
  set.thetaDegrees = numbers(root, "theta_degrees", 0.0, 90.0);
  set.phiDegrees = numbers(root, "phi_degrees", 0.0, 90.0);
  if (const auto floor = root.find("alpha_floor"); floor != root.end())
    set.alphaFloor = numberIn(*floor, "alpha_floor", kSmallestAlpha, 1.0);
  return set;
}

StabilitySet defaultStabilitySet() {
  return parseStabilitySet(kDefaultStabilitySet);
}

std::vector<LobeParameters> lobesOf(const StabilitySet& set) {
  std::vector<LobeParameters> out;
  for (const double alpha : set.alpha) {
    for (const double lambda : set.lambda) {
      for (const double theta : set.thetaDegrees) {
        for (const double phi : set.phiDegrees) {
          LobeParameters p;
          p.alphaX = std::max(alpha, set.alphaFloor);
          p.alphaY = std::max(alpha * lambda, set.alphaFloor);
          p.theta = radians(theta);
          p.phi = p.alphaX == p.alphaY || theta == 0.0 ? 0.0 : radians(phi);
          const bool known = std::any_of(out.begin(), out.end(), [&](const LobeParameters& q) {
            return q.alphaX == p.alphaX && q.alphaY == p.alphaY && q.theta == p.theta && q.phi == p.phi;
          });
          if (!known) out.push_back(p);
        }
      }
    }
  }
  return out;
}

}  // namespace ltcfit

#include "report/pareto_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ltcfit {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

class Explanation {
 public:
  Explanation(const ParetoResult& result, std::size_t setting) : result_(result), own_(setting) {}

  std::string text() const {
    if (!std::isfinite(errors(own_, kParetoLight).ratio.median)) {
      return fmt::format("{} is on no front: {} of its {} fits failed.", settingLabel(result_.settings[own_]),
                         summary(own_).nonFinite, summary(own_).runs);
    }
    return fmt::format("{} {} {} {}", lightFront(), neighbours(), otherFitters(), otherFronts());
  }

 private:
  const SettingSummary& summary(std::size_t s) const { return result_.summaries[s]; }
  double seconds(std::size_t s) const { return summary(s).cpuSeconds.median; }
  const SettingErrors& errors(std::size_t s, std::size_t metric) const { return summary(s).errors[metric]; }

  // "0.55 times its time, 1.5 % more error"
  std::string against(std::size_t s, std::size_t metric) const {
    const double time = seconds(s) / seconds(own_);
    const double percent = 100.0 * (errorOver(summary(s), summary(own_), metric) - 1.0);
    const std::string difference =
        !std::isfinite(percent) ? "no finite error"
        : std::abs(percent) < 0.005
            ? "the same error"
            : fmt::format("{:.{}f} % {} error", std::abs(percent), std::abs(percent) < 1.0 ? 2 : 1,
                          percent > 0.0 ? "more" : "less");
    return fmt::format("{:.{}f} times its time, {}", time, time < 9.95 ? 2 : 0, difference);
  }

  // What beats it there, the best first; all of a metric.
  std::vector<std::size_t> beatenBy(std::size_t metric) const {
    std::vector<std::size_t> out;
    for (std::size_t s = 0; s < result_.settings.size(); ++s)
      if (beats(summary(s), summary(own_), metric)) out.push_back(s);
    std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
      return errorOver(summary(a), summary(own_), metric) < errorOver(summary(b), summary(own_), metric);
    });
    return out;
  }

  std::string lightFront() const {
    const Spread& error = errors(own_, kParetoLight).ratio;
    const std::string time = fmt::format("{} takes {:.3g} ms an entry and is",
                                         settingLabel(result_.settings[own_]), 1e3 * seconds(own_));
    const std::string seeds =
        summary(own_).nonFinite > 0
            ? fmt::format("{} of its {} fits failed.", summary(own_).nonFinite, summary(own_).runs)
        : summary(own_).runs == summary(own_).entries
            ? std::string("One repeat does not show what seeds do.")
            : fmt::format("Seeds move its error by {:.2f} %.", 100.0 * (error.high / error.low - 1.0));
    if (errors(own_, kParetoLight).front)
      return fmt::format("{} on the front of light: nothing measured is both as fast and as good. {}", time,
                         seeds);
    std::string beaten;
    for (const std::size_t s : beatenBy(kParetoLight))
      beaten += fmt::format("{}{} ({})", beaten.empty() ? "" : "; ", settingLabel(result_.settings[s]),
                            against(s, kParetoLight));
    return fmt::format("{} not on the front of light. It is beaten by: {}. {}", time, beaten, seeds);
  }

  // The next cheaper and the next dearer setting on the front of light.
  std::string neighbours() const {
    std::size_t cheaper = kNone;
    std::size_t dearer = kNone;
    for (std::size_t s = 0; s < result_.settings.size(); ++s) {
      if (s == own_ || !errors(s, kParetoLight).front) continue;
      const bool less = seconds(s) < seconds(own_);
      std::size_t& nearest = less ? cheaper : dearer;
      if (nearest == kNone || (less ? seconds(s) > seconds(nearest) : seconds(s) < seconds(nearest)))
        nearest = s;
    }
    const Spread& error = errors(own_, kParetoLight).ratio;
    const auto describe = [&](const char* which, std::size_t s) {
      if (s == kNone) return fmt::format("Nothing on that front is {}.", which);
      const double change = errorOver(summary(s), summary(own_), kParetoLight) - 1.0;
      return fmt::format("The next {} on that front is {}: {}{}.", which, settingLabel(result_.settings[s]),
                         against(s, kParetoLight),
                         std::abs(change) < error.high / error.low - 1.0 ? ", less than the seeds move" : "");
    };
    return describe("cheaper", cheaper) + ' ' + describe("dearer", dearer);
  }

  // Of each other fitter the setting whose time is nearest.
  std::string otherFitters() const {
    std::vector<std::size_t> nearest;
    const auto distance = [&](std::size_t s) { return std::abs(std::log(seconds(s) / seconds(own_))); };
    for (std::size_t s = 0; s < result_.settings.size(); ++s) {
      const FitSetting& setting = result_.settings[s];
      if (!setting.fits() || setting.fitter == result_.settings[own_].fitter) continue;
      const auto same = std::find_if(nearest.begin(), nearest.end(), [&](std::size_t other) {
        return result_.settings[other].fitter == setting.fitter;
      });
      if (same == nearest.end()) {
        nearest.push_back(s);
      } else if (distance(s) < distance(*same)) {
        *same = s;
      }
    }
    if (nearest.empty()) return "No other fitter was run.";
    std::string out;
    for (const std::size_t s : nearest)
      out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", settingLabel(result_.settings[s]),
                         against(s, kParetoLight));
    return fmt::format("The other fitters at the time nearest to it, on light: {}.", out);
  }

  // The fronts of the other metrics, and for those that it is not on the best of what beats it.
  std::string otherFronts() const {
    std::string on;
    std::string off;
    std::size_t last = kNone;
    for (std::size_t metric = 0; metric < kParetoMetrics; ++metric) {
      if (metric == kParetoLight) continue;
      const std::string_view name = paretoMetrics()[metric].name;
      if (errors(own_, metric).front) {
        on += fmt::format("{}{}", on.empty() ? "" : ", ", name);
        continue;
      }
      const std::vector<std::size_t> by = beatenBy(metric);
      if (by.empty()) continue;
      if (by.front() != last)
        off +=
            fmt::format("{}by {} on ", off.empty() ? "" : "; ", settingLabel(result_.settings[by.front()]));
      off += fmt::format("{}{} ({})", by.front() == last ? ", " : "", name, against(by.front(), metric));
      last = by.front();
    }
    return fmt::format("Of the other metrics it is on the front of {}.{}", on.empty() ? "none" : on,
                       off.empty() ? "" : fmt::format(" It is beaten {}.", off));
  }

  const ParetoResult& result_;
  std::size_t own_;
};

}  // namespace

std::string settingLabel(const FitSetting& s) {
  return fmt::format("{}, {}{}", s.fitter, s.name, s.preset.empty() ? "" : fmt::format(" ({})", s.preset));
}

std::vector<ParetoDefault> explainDefaults(TableKind kind, const ParetoResult& result) {
  std::vector<ParetoDefault> out;
  for (std::size_t s = 0; s < result.settings.size(); ++s) {
    if (!result.settings[s].isDefault) continue;
    out.push_back(
        {kind == TableKind::kIsotropic ? "fit iso" : "fit aniso", s, Explanation(result, s).text()});
  }
  return out;
}

}  // namespace ltcfit

#include "app/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "export/atomic_file.h"

namespace ltcfit::app {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The number at the start of a file; none for a file that is not there, and for "max".
std::optional<std::uint64_t> numberIn(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (file >> number) return number;
  return std::nullopt;
}

// The number behind a name in a file of lines "name number" or "name: number", times `unit`.
std::optional<std::uint64_t> numberBehind(const std::string& path, const std::string& name,
                                          std::uint64_t unit) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string first;
    std::uint64_t number = 0;
    if (words >> first >> number && first == name) return number * unit;
  }
  return std::nullopt;
}

// What the limit of one cgroup leaves; pages of files count as used there, but give way.
std::uint64_t leftIn(const std::string& folder, const char* limit, const char* usage, const char* pages) {
  const std::optional<std::uint64_t> most = numberIn(folder + limit);
  const std::optional<std::uint64_t> used = numberIn(folder + usage);
  if (!most || !used) return kUnlimited;
  const std::uint64_t givesWay = numberBehind(folder + "/memory.stat", pages, 1).value_or(0);
  const std::uint64_t held = *used - std::min(*used, givesWay);
  return *most - std::min(*most, held);
}

// A limit holds for all cgroups below: from the process' own up to the root.
std::uint64_t leftByCgroups() {
  std::ifstream groups("/proc/self/cgroup");
  std::uint64_t left = kUnlimited;
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool unified = controllers == ",,";
    if (!unified && controllers.find(",memory,") == std::string::npos) continue;
    const std::string root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    for (std::string path = line.substr(second + 1);; path.resize(path.find_last_of('/'))) {
      while (path.ends_with('/')) path.pop_back();
      left = std::min(left, unified ? leftIn(root + path, "/memory.max", "/memory.current", "inactive_file")
                                    : leftIn(root + path, "/memory.limit_in_bytes", "/memory.usage_in_bytes",
                                             "total_inactive_file"));
      if (path.find('/') == std::string::npos) break;
    }
  }
  return left;
}

std::uint64_t leftOfAddressSpace() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const std::uint64_t used = numberBehind("/proc/self/status", "VmSize:", 1024).value_or(0);
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

std::string bytesShown(double bytes) {
  return fmt::format("{:.0f} bytes ({:.3g} GB)", bytes, 1e-9 * bytes);
}

}  // namespace

std::uint64_t availableMemory() {
  const std::uint64_t machine = numberBehind("/proc/meminfo", "MemAvailable:", 1024).value_or(kUnlimited);
  return std::min({machine, leftByCgroups(), leftOfAddressSpace()});
}

void requireMemory(double bytes, const std::string& what, const std::string& advice) {
  const double available = static_cast<double>(availableMemory());
  if (bytes <= available) return;
  throw InputError(fmt::format("{} take about {} of memory, and {} are free: {}", what, bytesShown(bytes),
                               bytesShown(available), advice));
}

}  // namespace ltcfit::app

#include "export/table_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "export/atomic_file.h"
#include "export/published_table.h"

namespace ltcfit {
namespace {

constexpr std::size_t kMaxListed = 8;
// Arrays of one size that may be a table's: pairs of them are tried.
constexpr std::size_t kMaxCandidates = 32;

// Whether all lengths of the array's shape are numbers.
bool isKnown(const std::vector<std::size_t>& shape) {
  return std::find(shape.begin(), shape.end(), std::size_t{0}) == shape.end();
}

// Whether the shape is of other numbers, or (texels, n), (rows, columns, n) of another n.
bool isOtherwiseDeclared(const TextArray& array, std::size_t components) {
  const std::vector<std::size_t>& s = array.shape;
  if (!s.empty() && isKnown(s) && productOf(s) != array.values.size()) return true;
  return (s.size() == 2 || s.size() == 3) && s.back() <= 4 && s.back() > 0 && s.back() != components;
}

std::optional<TextureSize> sizeOf(const TextArray& array, std::size_t components) {
  const std::vector<std::size_t>& s = array.shape;
  const std::size_t count = array.values.size();
  if (isOtherwiseDeclared(array, components)) return std::nullopt;
  TextureSize size;
  if (isKnown(s) && s.size() == 3 && s.back() == components) {
    size = {s[1], s[0]};
  } else {
    const std::size_t texels = count / components;
    const auto side = std::llround(std::sqrt(static_cast<double>(texels)));
    size = {static_cast<std::size_t>(side), static_cast<std::size_t>(side)};
  }
  if (size.width < 2 || size.height < 2 || size.texels() * components != count) return std::nullopt;
  return size;
}

// Whether the array can be norm and Fresnel for matrices of this size.
bool goesWith(const TextArray& array, const TextureSize& size) {
  const std::size_t components = array.values.size() / size.texels();
  if (components < 2 || components > 4 || components * size.texels() != array.values.size()) return false;
  return !isOtherwiseDeclared(array, components);
}

bool is2017(const Image& first, const Image* second) {
  try {
    packedFrom2017(first, second, {});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// The arrays that may be matrices: of all sizes the largest.
std::vector<Candidate> largestOf(const std::vector<TextArray>& arrays, bool onlyPairs,
                                 const std::string& name) {
  std::map<std::size_t, std::vector<Candidate>, std::greater<>> bySize;
  std::map<std::size_t, std::size_t> counts;  // arrays of each count of numbers
  for (const TextArray& array : arrays) ++counts[array.values.size()];
  for (const TextArray& array : arrays) {
    const std::optional<TextureSize> size = sizeOf(array, 4);
    if (!size) continue;
    const std::size_t n = size->texels();
    const bool paired = counts.contains(2 * n) || counts.contains(3 * n) || counts[4 * n] > 1;
    if (!onlyPairs || paired) bySize[n].push_back({&array, nullptr, *size, false, 0, true});
  }
  if (bySize.empty()) return {};
  if (bySize.begin()->second.size() > kMaxCandidates) {
    throw InputError(fmt::format("{}: more than {} arrays of {} numbers: which are a table's, nothing tells",
                                 name, kMaxCandidates, 4 * bySize.begin()->first));
  }
  return bySize.begin()->second;
}

// Leaves the candidates of the largest key.
template <typename Key>
void keepBest(std::vector<Candidate>& candidates, Key key) {
  if (candidates.empty()) return;
  const auto best =
      key(*std::max_element(candidates.begin(), candidates.end(),
                            [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); }));
  std::erase_if(candidates, [&](const Candidate& c) { return key(c) != best; });
}

}  // namespace

Role roleOf(std::string_view name) {
  std::string lower;
  for (const char c : name)
    if (c != '_') lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t n = lower.size();
  const auto endsWith = [&](char digit) {
    return n > 0 && lower[n - 1] == digit &&
           (n == 1 || std::isdigit(static_cast<unsigned char>(lower[n - 2])) == 0);
  };
  const auto has = [&](std::string_view part) { return lower.find(part) != std::string::npos; };
  if (endsWith('2') || has("amp") || has("mag")) return Role::kAmplitudes;
  return endsWith('1') || has("mat") || lower == "tabm" ? Role::kMatrices : Role::kUnknown;
}

std::string listOf(const std::vector<TextArray>& arrays) {
  std::string list;
  for (std::size_t i = 0; i < std::min(arrays.size(), kMaxListed); ++i)
    list += fmt::format("{}{} ({}{})", i == 0 ? "" : ", ", arrays[i].name, arrays[i].values.size(),
                        i == 0 ? " numbers" : "");
  if (arrays.size() > kMaxListed) list += fmt::format(" and {} more", arrays.size() - kMaxListed);
  return list;
}

std::size_t productOf(const std::vector<std::size_t>& shape) {
  std::size_t product = 1;
  for (const std::size_t s : shape) product = s == 0 || product > SIZE_MAX / s ? 0 : product * s;
  return product;
}

std::vector<Candidate> pairsOf(const std::vector<TextArray>& arrays, const std::string& name) {
  std::vector<Candidate> pairs;
  for (const Candidate& one : largestOf(arrays, true, name)) {
    const Image first = imageOf(*one.matrices, one.size);
    const bool isFirst = is2017(first, nullptr);
    for (const TextArray& other : arrays) {
      if (&other == one.matrices || !goesWith(other, one.size)) continue;
      if (pairs.size() == kMaxCandidates * kMaxCandidates) break;
      Candidate pair = one;
      pair.amplitudes = &other;
      pair.inOrder = one.matrices < &other;
      const auto weight = [](const TextArray& array, Role good, Role bad) {
        const Role role = roleOf(array.name);
        return role == good ? 1 : role == bad ? -1 : 0;
      };
      pair.names = weight(*one.matrices, Role::kMatrices, Role::kAmplitudes) +
                   weight(other, Role::kAmplitudes, Role::kMatrices);
      const Image second = imageOf(other, one.size);
      pair.fits = isFirst && is2017(first, &second);
      pairs.push_back(pair);
    }
  }
  return pairs;
}

std::vector<Candidate> matricesOf(const std::vector<TextArray>& arrays, const std::string& name) {
  std::vector<Candidate> found = largestOf(arrays, false, name);
  for (Candidate& one : found) {
    one.fits = is2017(imageOf(*one.matrices, one.size), nullptr);
    one.names = roleOf(one.matrices->name) == Role::kMatrices ? 1 : 0;
  }
  return found;
}

std::vector<Candidate> amplitudesFor(const std::vector<TextArray>& arrays, const TextureSize& size) {
  std::vector<Candidate> found;
  for (const TextArray& array : arrays) {
    if (goesWith(array, size))
      found.push_back({nullptr, &array, size, false, roleOf(array.name) == Role::kAmplitudes ? 1 : 0, true});
  }
  return found;
}

Candidate bestOf(std::vector<Candidate> candidates, const std::string& name, const std::string& list) {
  keepBest(candidates, [](const Candidate& c) { return c.fits ? 1 : 0; });
  keepBest(candidates, [](const Candidate& c) { return c.names; });
  keepBest(candidates, [](const Candidate& c) { return c.inOrder ? 1 : 0; });
  if (candidates.size() == 1) return candidates.front();
  throw InputError(fmt::format("{}: several arrays can be a table's; leave those of one: {}", name, list));
}

Image imageOf(const TextArray& array, const TextureSize& size) {
  Image image;
  image.width = size.width;
  image.height = size.height;
  image.components = array.values.size() / size.texels();
  image.values = array.values;
  return image;
}

}  // namespace ltcfit

#include "export/second_texture.h"

#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

namespace ltcfit {
namespace {

// Longer ones first: "matrix" has "mat" in it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kParts{
    {{"matrix", "amplitude"}, {"matrix", "magnitude"}, {"mat", "amp"}, {"mat", "mag"}, {"1", "2"}}};

// In lower case, with a capital, and in capitals.
std::array<std::string, 3> spellings(std::string_view part) {
  std::array<std::string, 3> out{std::string(part), std::string(part), std::string(part)};
  const auto upper = [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); };
  out[1][0] = upper(out[1][0]);
  for (char& c : out[2]) c = upper(c);
  return out;
}

// O3DE names the pair "ltc_mat_lutrgba32f" and "ltc_amp_lutrg32f".
std::string withTwoChannels(std::string stem) {
  const std::size_t at = stem.rfind("rgba");
  return at == std::string::npos ? stem : stem.replace(at, 4, "rg");
}

}  // namespace

std::optional<std::string> secondTextureBeside(const std::string& path) {
  const std::filesystem::path first(path);
  const std::string stem = first.stem().string();
  for (const auto& [from, to] : kParts) {
    const auto all = spellings(from);
    for (std::size_t s = 0; s < all.size(); ++s) {
      const std::size_t at = stem.rfind(all[s]);
      if (at == std::string::npos) continue;
      std::string other = stem;
      other.replace(at, all[s].size(), spellings(to)[s]);
      for (const std::string& name : {other, withTwoChannels(other)}) {
        std::filesystem::path second(first);
        second.replace_filename(name + first.extension().string());
        std::error_code error;
        if (std::filesystem::is_regular_file(second, error)) return second.string();
      }
    }
  }
  return std::nullopt;
}

}  // namespace ltcfit

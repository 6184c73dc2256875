#include "export/read_table.h"

#include <filesystem>

#include "export/atomic_file.h"
#include "export/json_table.h"
#include "export/published_table.h"

namespace ltcfit {
namespace {

// Where the second texture of the 2017 table lies: "ltc2017-1.npy" has "ltc2017-2.npy" beside it.
std::string secondTexturePath(const std::string& path) {
  std::filesystem::path p(path);
  std::string stem = p.stem().string();
  const std::size_t at = stem.rfind('1');
  if (at == std::string::npos) return {};
  stem[at] = '2';
  p.replace_filename(stem + p.extension().string());
  return std::filesystem::exists(p) ? p.string() : std::string();
}

}  // namespace

Table readTable(const std::string& path) {
  const std::string bytes = readFile(path);
  if (isNpy(bytes) || isDds(bytes)) {
    const FloatArray array = isNpy(bytes) ? parseNpy(bytes, path) : parseDds(bytes, path);
    if (array.shape.size() == 6) return tableFrom2022(array, path);
    const std::string second = secondTexturePath(path);
    if (second.empty()) return tableFrom2017(array, nullptr, path);
    const std::string secondBytes = readFile(second);
    if (!isNpy(secondBytes) && !isDds(secondBytes)) throw InputError(second + ": neither .npy nor DDS");
    const FloatArray secondArray =
        isNpy(secondBytes) ? parseNpy(secondBytes, second) : parseDds(secondBytes, second);
    return tableFrom2017(array, &secondArray, path);
  }
  // a byte order mark, as editors of one vendor leave it, is not part of the text
  const std::size_t start = bytes.find_first_not_of(" \t\r\n", bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
  if (start == std::string::npos) throw InputError(path + ": is empty");
  if (bytes[start] == '{') return tableFromJson(bytes, path);
  throw InputError(path + ": not a table: neither ltcfit's JSON, .npy nor DDS");
}

}  // namespace ltcfit

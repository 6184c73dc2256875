#include "export/light_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/dds.h"
#include "export/exr.h"
#include "export/json_fields.h"
#include "export/little_endian.h"
#include "export/mip_chain.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

constexpr const char* kLightFormat = "ltc-light-texture";
constexpr int kLightVersion = 1;
// 4096^2 texels of 16 bytes and their mip maps are below 2^29 bytes
constexpr std::uint64_t kMaxFile = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxLightSidecar = 1 << 16;

bool isSquareChain(const std::vector<Image>& levels) {
  return isMipChain(levels) && levels[0].width == levels[0].height && levels.back().texels() == 1;
}

// `sum` of the file, where the metadata lie beside it.
std::string metadataOf(const LightTextureFile& texture, const std::string& sum) {
  Json json{{"format", kLightFormat}, {"version", kLightVersion}};
  json["margin"] = texture.margin;
  json["aspect"] = texture.aspect;
  json["lod_scale"] = texture.lodScale;
  json["size"] = texture.levels[0].width;
  json["precision"] = texture.levels[0].precision == Precision::kHalf ? "float16" : "float32";
  json["values"] = "linear RGB, alpha 1; row 0 is the picture's top";
  json["coordinates"] = "(uv + margin) / (1 + 2 margin), uv = (0, 0), (1, 0), (1, 1), (0, 1) at the vertices";
  json["shape"] = "the filter is round on a light of width / height = aspect";
  json["level"] = "log2(lod_scale sigma), sigma = sqrt(r^2 / (2 A)): ltcLightColour of ltc_textured.glsl";
  if (!sum.empty()) json["checksum"] = sum;
  return json.dump(1) + "\n";
}

void readMetadata(std::string_view text, const std::string& name, const std::string& bytes, bool beside,
                  LightTextureFile& texture) {
  readJson(text, name, [&](const Json& json) {
    const JsonFields file(json, "");
    if (file.text("format") != kLightFormat)
      throw InputError(fmt::format("format is not \"{}\"", kLightFormat));
    if (!file.get("version").is_number_integer() || file.get("version") != kLightVersion)
      throw InputError(fmt::format("version is not known; this program reads version {}", kLightVersion));
    texture.margin = file.number("margin");
    texture.aspect = file.number("aspect");
    texture.lodScale = file.number("lod_scale");
    if (!(texture.margin >= 0.0 && texture.margin <= 4.0)) file.fail("margin is not in 0..4");
    if (!(texture.aspect > 0.0)) file.fail("aspect is not positive");
    if (!(texture.lodScale > 0.0)) file.fail("lod_scale is not positive");
    if (beside && file.text("checksum") != checksum(bytes))
      throw InputError("describes another file (its checksum is another one than described)");
  });
}

std::string metadataAmong(const std::vector<std::pair<std::string, std::string>>& texts,
                          const std::string& path) {
  for (const auto& [key, value] : texts)
    if (key == kMetadataKey) return value;
  throw InputError(path + ": not a texture that `ltcfit prefilter` wrote (no metadata)");
}

}  // namespace

std::vector<ExportFile> lightTextureFiles(const LightTextureFile& texture, const std::string& name,
                                          Ktx2Compression compression) {
  if (!isSquareChain(texture.levels))
    throw std::invalid_argument("the levels are no square mip maps down to one texel");
  const std::string extension = std::filesystem::path(name).extension().string();
  if (extension == ".dds") {
    std::string bytes = mipsToDds(texture.levels);
    const std::string sidecar = metadataOf(texture, checksum(bytes));
    return {{name, std::move(bytes)}, {sidecarPath(name), sidecar}};
  }
  std::vector<std::pair<std::string, std::string>> texts{{kMetadataKey, metadataOf(texture, "")}};
  if (extension == ".exr") return {{name, mipsToExr({texture.levels, std::move(texts)})}};
  if (extension != ".ktx2") throw Refusal(name + ": need a name that ends in .exr, .dds or .ktx2");
  texts.emplace_back("KTXwriter", "ltcfit " LTCFIT_VERSION);
  return {{name, mipsToKtx2({texture.levels, std::move(texts)}, compression)}};
}

LightTextureFile readLightTexture(const std::string& path) {
  const std::string bytes = readFile(path, kMaxFile);
  LightTextureFile texture;
  if (isDds(bytes)) {
    texture.levels = parseDdsMips(bytes, path);
    const std::string beside = sidecarPath(path);
    readMetadata(readFile(beside, kMaxLightSidecar), beside, bytes, true, texture);
  } else if (isKtx2(bytes)) {
    Ktx2Mips file = parseKtx2Mips(bytes, path);
    texture.levels = std::move(file.levels);
    readMetadata(metadataAmong(file.keyValues, path), path, bytes, false, texture);
  } else if (isExr(bytes)) {
    ExrMips file = parseExrMips(bytes, path);
    texture.levels = std::move(file.levels);
    readMetadata(metadataAmong(file.attributes, path), path, bytes, false, texture);
  } else {
    throw InputError(path + ": neither EXR, DDS nor KTX2");
  }
  if (!isSquareChain(texture.levels))
    throw InputError(path + ": its levels are no square mip maps down to one texel");
  return texture;
}

}  // namespace ltcfit

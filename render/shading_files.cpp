#include "render/shading_files.h"

#include <fmt/format.h>

#include "export/exr.h"
#include "render/pictures.h"

namespace ltcfit {
namespace {

// The films of a scene, in the order of the headings.
std::vector<std::pair<std::string, Film>> layersOf(const SceneCheck& s) {
  std::vector<std::pair<std::string, Film>> out{
      {"", s.ltc},
      {"reference", s.reference},
      {"difference", difference(s.ltc, s.reference, kDifferenceGain)}};
  if (s.otherLtc) {
    out.emplace_back("against", *s.otherLtc);
    out.emplace_back("against_difference", difference(*s.otherLtc, s.reference, kDifferenceGain));
  }
  return out;
}

std::vector<std::string> headings(const ShadingCheck& check, const std::string& name,
                                  const std::string& otherName) {
  const std::string gain = fmt::format("difference x{:.0f}", kDifferenceGain);
  std::vector<std::string> out{name, "reference", gain};
  if (!check.scenes.empty() && check.scenes[0].otherLtc) {
    out.push_back(otherName);
    out.push_back(gain);
  }
  return out;
}

SheetRow rowOf(const SceneCheck& s, std::size_t zoom) {
  SheetRow row;
  row.caption = fmt::format("{}: RMSE {:.5f}", s.check.scene.name, s.error.rmse);
  if (s.other) row.caption += fmt::format(" against {:.5f}", s.other->rmse);
  if (s.random) {
    const Eigen::Vector2d& alpha = s.check.scene.surfaces[0].material.alpha;
    row.caption += alpha.x() == alpha.y() ? fmt::format(", alpha {:.3f}", alpha.x())
                                          : fmt::format(", alpha {:.3f} / {:.3f}", alpha.x(), alpha.y());
  }
  for (const auto& [layer, film] : layersOf(s)) row.pictures.push_back(toPicture(film, zoom));
  return row;
}

std::string toExr(const SceneCheck& s) {
  ExrFile exr;
  exr.width = s.ltc.width;
  exr.height = s.ltc.height;
  for (const auto& [layer, film] : layersOf(s)) {
    for (int c = 0; c < 3; ++c) {
      std::string channel(1, "RGB"[c]);
      if (!layer.empty()) channel = fmt::format("{}.{}", layer, channel);
      std::vector<float> values;
      values.reserve(film.radiance.size());
      for (const Eigen::Vector3d& v : film.radiance) values.push_back(static_cast<float>(v[c]));
      exr.names.push_back(channel);
      exr.channels.push_back(std::move(values));
    }
  }
  exr.attributes.emplace_back("comments", s.check.scene.title);
  return channelsToExr(exr);
}

}  // namespace

std::vector<ExportFile> shadingPictures(const ShadingCheck& check, const std::string& name,
                                        const std::string& otherName) {
  std::vector<ExportFile> out;
  const std::vector<std::string> columns = headings(check, name, otherName);
  std::vector<SheetRow> all;
  std::vector<SheetRow> lost;
  for (const SceneCheck& s : check.scenes) {
    if (s.random) {
      if (s.lost()) lost.push_back(rowOf(s, 3));
      continue;
    }
    all.push_back(rowOf(s, 1));
    out.push_back({s.check.scene.name + ".png", toPng(contactSheet(columns, {rowOf(s, 2)}))});
    out.push_back({s.check.scene.name + ".exr", toExr(s)});
  }
  if (!all.empty()) out.push_back({"contact.png", toPng(contactSheet(columns, all))});
  if (!lost.empty()) out.push_back({"lost.png", toPng(contactSheet(columns, lost))});
  return out;
}

}  // namespace ltcfit

// ltcfit prefilter: a picture as the texture of a light.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/memory.h"
#include "app/notes.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "render/light_texture_file.h"
#include "render/picture_file.h"
#include "render/prefilter.h"

namespace ltcfit::app {
namespace {

constexpr double kMinAspect = 1.0 / 64.0;
constexpr double kMaxAspect = 64.0;

struct PrefilterArguments {
  std::string input;
  std::string output;
  PrefilterOptions options;
  std::optional<double> aspect;
  bool floats = false;
  bool half = false;
  bool uncompressed = false;
  bool quiet = false;
  bool json = false;
};

void print(const PrefilterArguments& a, const LinearPicture& picture, const PrefilteredTexture& texture,
           const std::vector<ExportFile>& files, const std::vector<std::string>& paths) {
  const std::size_t size = texture.levels[0].size;
  if (a.json) {
    nlohmann::ordered_json json{{"picture", {{"width", picture.width}, {"height", picture.height}}},
                                {"size", size},
                                {"levels", texture.levels.size()},
                                {"precision", a.floats ? "float32" : "float16"},
                                {"margin", texture.margin},
                                {"aspect", texture.aspect},
                                {"lod_scale", texture.lodScale}};
    for (std::size_t i = 0; i < files.size(); ++i)
      json["files"].push_back({{"path", paths[i]}, {"bytes", files[i].bytes.size()}});
    fmt::print("{}\n", json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  if (a.quiet) return;
  std::string notes = fmt::format(
      "{} x {} pixels -> {} x {} texels, {} levels, {}\n"
      "for ltcLightColour: margin = {}, lodScale = {:.9g}; made for a light of aspect = {:.6g}\n",
      picture.width, picture.height, size, size, texture.levels.size(), a.floats ? "float" : "half",
      texture.margin, texture.lodScale, texture.aspect);
  for (std::size_t i = 0; i < files.size(); ++i)
    notes += fmt::format("wrote {} ({} bytes)\n", paths[i], files[i].bytes.size());
  printNotes(isStream(a.output) ? NotesTo::kStderr : NotesTo::kStdout, notes);
}

// Of the light: as told, or the picture's, since most lights show theirs undistorted.
double aspectOf(const PrefilterArguments& a, const LinearPicture& picture) {
  if (a.aspect.has_value()) return *a.aspect;
  const double aspect = static_cast<double>(picture.width) / static_cast<double>(picture.height);
  if (aspect < kMinAspect || aspect > kMaxAspect) {
    throw InputError(
        fmt::format("{}: {} x {} pixels have no aspect of 1/64 to 64; give the light's by --aspect", a.input,
                    picture.width, picture.height));
  }
  return aspect;
}

int runPrefilter(const PrefilterArguments& a) {
  const std::filesystem::path output(a.output);
  const std::string extension = output.extension().string();
  if (extension != ".exr" && extension != ".dds" && extension != ".ktx2")
    throw InputError(a.output + ": --output needs a name that ends in .exr, .dds or .ktx2");
  if (a.uncompressed && extension != ".ktx2") throw InputError("--uncompressed is for .ktx2");
  checkWritable(a.output);
  if (isSameFile(a.input, a.output)) throw InputError(a.input + ": --output would overwrite this picture");
  LinearPicture picture = readPicture(a.input);
  PrefilterOptions options = a.options;
  options.aspect = aspectOf(a, picture);
  const LightTexture light{a.input, picture.width, picture.height, std::move(picture.texels)};
  PrefilteredTexture texture;
  std::vector<ExportFile> files;
  try {
    // measured: level, interpolated levels and file
    constexpr double kTexelBytes = 100.0;
    const auto side = static_cast<double>(prefilteredSize(light, options));
    requireMemory(kTexelBytes * side * side, fmt::format("prefilter: {0:.0f} x {0:.0f} texels", side),
                  "lower --size");
    texture = prefilter(light, options);
    files = lightTextureFiles(toLightTextureFile(texture, a.floats ? Precision::kFloat : Precision::kHalf),
                              output.filename().string(),
                              a.uncompressed ? Ktx2Compression::kNone : Ktx2Compression::kZstd);
  } catch (const Refusal& error) {
    throw InputError(a.input + ": " + error.what());
  }
  std::vector<std::string> paths;
  for (const ExportFile& file : files) {
    paths.push_back((output.parent_path() / file.name).string());
    checkWritable(paths.back());
    if (isSameFile(a.input, paths.back()))
      throw InputError(a.input + ": --output would overwrite this picture");
  }
  for (std::size_t i = 0; i < files.size(); ++i) writeFileAtomically(paths[i], files[i].bytes);
  print(a, picture, texture, files, paths);
  return kExitOk;
}

}  // namespace

void addPrefilterCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "prefilter", "Make a picture into the texture of a rectangular light (ltc_textured.glsl reads it)");
  auto a = std::make_shared<PrefilterArguments>();
  command
      ->add_option("picture", a->input,
                   "PNG (alpha multiplied in) or JPEG, both sRGB; Radiance (.hdr) or EXR (R, G, B or Y; "
                   "negative as 0),\nboth linear; up to 8192 x 8192")
      ->type_name("FILE")
      ->required();
  command
      ->add_option(
          "-o,--output", a->output,
          "Mip maps to write, by the name's end: .ktx2, .dds (metadata beside it, in .dds.json) or .exr")
      ->type_name("FILE")
      ->required();
  CLI::Option* const half = command->add_flag("--half", a->half, "Half precision (the default)");
  command->add_flag("--float", a->floats, "Float precision")->excludes(half);
  command->add_flag("--uncompressed", a->uncompressed, "KTX2 without zstd supercompression");
  command
      ->add_option("--margin", a->options.margin,
                   "Of the texture around the picture, on each side, in sides of the picture; 0..4")
      ->check(CLI::Range(0.0, 4.0))
      ->capture_default_str();
  command
      ->add_option("--aspect", a->aspect,
                   "Width / height of the light that will show it: the filter is round there; 1/64..64 "
                   "[the picture's: shown undistorted]")
      ->check(CLI::Range(kMinAspect, kMaxAspect));
  command
      ->add_option("--size", a->options.size,
                   "Texels along a side, a power of two, 4..4096; 0 = the picture's resolution")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command->add_option("--threads", a->options.threads, "Threads; 0 = all cores. Does not change the result")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("-q,--quiet", a->quiet, "Print nothing but errors, and what --json asks for");
  command->add_flag("--json", a->json, "Print JSON");
  command->callback([a, &status] { status.exitCode = runPrefilter(*a); });
}

}  // namespace ltcfit::app

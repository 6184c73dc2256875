// ltcfit check-gl: an exported table in a real GL pipeline, against its double-precision twin and the truth.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/paths.h"
#include "app/progress.h"
#include "app/shell_quoted.h"
#include "app/table_arguments.h"
#include "base/angles.h"
#include "export/atomic_file.h"
#include "export/read_table.h"
#include "render/shading_check.h"
#include "render/shading_files.h"
#include "render/shading_json.h"
#include "render/textured_scenes.h"
#include "render/window.h"

namespace ltcfit::app {
namespace {

struct CheckGlArguments {
  std::string table;
  ReadOptions input;
  std::string against;
  std::string output;
  std::string light;
  double alphaX = 0.0;
  double alphaY = 0.0;
  std::optional<double> angle;
  std::int64_t width = static_cast<std::int64_t>(ShadingCheckOptions{}.width);
  std::int64_t height = static_cast<std::int64_t>(ShadingCheckOptions{}.height);
  std::int64_t randomScenes = static_cast<std::int64_t>(ShadingCheckOptions{}.randomScenes);
  double f0 = ShadingCheckOptions{}.dielectricF0;
  std::int64_t samples = static_cast<std::int64_t>(ShadingCheckOptions{}.maxSamples);
  std::int64_t seed = 1;
  int threads = 0;
  bool window = false;
  bool cost = false;
  bool quiet = false;
  bool json = false;

  bool isCustom() const { return !light.empty() || alphaX > 0.0 || alphaY > 0.0 || angle; }
};

// CLI11's ranges let NaN through.
void checkArguments(const CheckGlArguments& a) {
  for (const auto& [name, value] : {std::pair{"--alpha-x", a.alphaX},
                                    {"--alpha-y", a.alphaY},
                                    {"--angle", a.angle.value_or(0.0)},
                                    {"--f0", a.f0}}) {
    if (!std::isfinite(value)) throw InputError(fmt::format("{}: {} is not a number", name, value));
  }
}

ShadingCheckOptions toOptions(const CheckGlArguments& a) {
  ShadingCheckOptions o;
  o.width = static_cast<std::size_t>(a.width);
  o.height = static_cast<std::size_t>(a.height);
  o.randomScenes = static_cast<std::size_t>(a.randomScenes);
  o.dielectricF0 = a.f0;
  o.maxSamples = std::bit_ceil(static_cast<std::size_t>(a.samples));
  o.seed = static_cast<std::uint64_t>(a.seed);
  o.threads = a.threads;
  if (!a.isCustom()) return o;
  CustomScene custom;
  if (!a.light.empty()) custom.light = lightShapeFromName(a.light);
  // one alone is that of both directions
  const double x = a.alphaX > 0.0 ? a.alphaX : a.alphaY;
  const double y = a.alphaY > 0.0 ? a.alphaY : a.alphaX;
  if (x > 0.0) custom.alpha = Eigen::Vector2d(x, y);
  custom.angle = a.angle.value_or(0.0) * kRadiansPerDegree;
  o.custom = custom;
  return o;
}

// Every option that a figure follows from.
std::string commandOf(const CheckGlArguments& a) {
  std::string out = fmt::format("ltcfit check-gl {}{}", shellFileName(a.table), tableInputText(a.input));
  if (!a.against.empty()) out += fmt::format(" --against {}", shellFileName(a.against));
  if (!a.light.empty()) out += fmt::format(" --light {}", shellQuoted(a.light));
  if (a.alphaX > 0.0) out += fmt::format(" --alpha-x {}", a.alphaX);
  if (a.alphaY > 0.0) out += fmt::format(" --alpha-y {}", a.alphaY);
  if (a.angle) out += fmt::format(" --angle {}", *a.angle);
  out += fmt::format(" --width {} --height {}", a.width, a.height);
  if (!a.isCustom()) out += fmt::format(" --random {} --f0 {}", a.randomScenes, a.f0);
  return out + fmt::format(" --samples {} --seed {}", a.samples, a.seed);
}

void printScene(const SceneCheck& s, bool compared) {
  fmt::print("{:<18}{:>7.1f}{:>5.0f}  {:>9.5f}{:>10.6f}{:>7.1f}{:>10.6f}{}", s.check.scene.name, s.gl.psnr,
             s.glFloor, s.error.rmse, s.error.relativeMse, s.error.psnr, s.referenceRmse,
             s.resolved() ? ' ' : '~');
  if (compared) fmt::print("{:>10.5f}{:>7.2f}", s.other->rmse, s.error.rmse / s.other->rmse);
  if (!s.passed) {
    fmt::print("  FAILED: {}", s.gl.nonFinite > 0 ? fmt::format("{} pixels are NaN", s.gl.nonFinite)
                               : s.gl.pixels == 0 ? "nothing is seen"
                               : s.gl.psnr < s.glFloor
                                   ? "GL is not the twin"
                                   : fmt::format("{} pixels show something else", s.gl.kindsDiffer));
  }
  fmt::print("\n");
}

void printSummary(const RandomSummary& s, bool compared) {
  fmt::print("  mean RMSE {:.5f}", s.rmse);
  if (compared) {
    fmt::print(", other {:.5f}: ratio {:.3f}, geometric mean of ratios {:.3f}\n", s.otherRmse,
               s.rmse / s.otherRmse, s.geometricRatio);
    fmt::print("  closer in {} ({:.1f} %), other in {}, {} by less than the reference is exact", s.closer,
               100.0 * static_cast<double>(s.closer) / static_cast<double>(s.scenes), s.lost,
               s.scenes - s.closer - s.lost);
  }
  fmt::print("\n  own error of the reference {:.6f}, a tenth or less of what it judges in {}\n",
             s.referenceRmse, s.resolved);
}

void printCheck(const CheckGlArguments& a, const ShadingCheckOptions& options, const ShaderTable& table,
                const ShaderTable* against, const ShadingCheck& check) {
  const bool compared = against != nullptr;
  fmt::print("{}: {}\n", fileName(a.table), table.note);
  if (compared) fmt::print("{}: {}\n", fileName(a.against), against->note);
  fmt::print("{}\n\n", check.renderer);
  fmt::print(
      "GL against its double-precision twin (PSNR, dB, and what it must reach), and against the true light\n"
      "(Monte Carlo; own = its own error, ~ where that is above a tenth of what it judges){}\n\n",
      compared ? fmt::format(";\nother = RMSE of {}", fileName(a.against)) : "");
  fmt::print("{:<18}{:>7}{:>5}  {:>9}{:>10}{:>7}{:>10} ", "", "GL/twin", "min", "RMSE", "relMSE", "PSNR",
             "own");
  if (compared) fmt::print("{:>10}{:>7}", "other", "ratio");
  fmt::print("\n");
  std::size_t failed = 0;
  double worst = 1e300;
  for (const SceneCheck& s : check.dielectrics) {
    if (s.passed) continue;
    printScene(s, compared);
    ++failed;
  }
  for (const SceneCheck& s : check.scenes) {
    if (!s.random || !s.passed) printScene(s, compared);
    if (!s.passed) ++failed;
    if (s.random) worst = std::min(worst, s.gl.psnr);
  }
  const RandomSummary random = check.random();
  if (random.scenes > 0) {
    fmt::print("\n{} random scenes of seed {}, f0 = 1; GL against the twin {:.1f} dB or more\n",
               random.scenes, options.seed, worst);
    printSummary(random, compared);
    fmt::print("  clipping at the horizon, mean RMSE:");
    for (std::size_t c = 0; c < kHorizonClippings; ++c)
      fmt::print(" {} {:.5f}", horizonClippingName(static_cast<HorizonClipping>(c)), random.clipping[c]);
    fmt::print("\n");
  }
  if (!check.dielectrics.empty()) {
    fmt::print(
        "the first {} of them with f0 = {}: the less, the more Fresnel tilts the lobe, which no table of F = "
        "1\nfollows\n",
        check.dielectrics.size(), options.dielectricF0);
    printSummary(summaryOf(check.dielectrics), compared);
  }
  bool first = true;
  for (const SceneCheck& s : check.scenes) {
    if (!s.lost()) continue;
    if (first) fmt::print("\nwhere {} is closer:\n", fileName(a.against));
    first = false;
    fmt::print("  {:<18}{:.5f} against {:.5f}: {}\n", s.check.scene.name, s.error.rmse, s.other->rmse,
               s.explanation);
  }
  if (!check.frames.empty()) fmt::print("\nframe times, {} x {}:", kFrameWidth, kFrameHeight);
  for (const FrameTime& frame : check.frames) fmt::print(" {} {:.1f} ms", frame.scene, 1e3 * frame.seconds);
  fmt::print(
      "\n{}\n",
      failed == 0
          ? fmt::format("GL agrees with its twin in all {} scenes; how good the table is, the RMSE tells",
                        check.scenes.size() + check.dielectrics.size())
          : fmt::format("{} scenes FAILED", failed));
}

void makePictureFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!std::filesystem::is_directory(path))
    throw InputError(fmt::format("--output {}: cannot make this folder{}{}", path, error ? ": " : "",
                                 error ? error.message() : ""));
}

// The one asked for, or all that have names.
std::vector<Scene> scenesToShow(bool anisotropic, bool fresnel, const ShadingCheckOptions& options) {
  if (options.custom) return {makeScene(*options.custom)};
  std::vector<Scene> out;
  for (const std::vector<CheckScene>& scenes : {namedScenes(anisotropic), texturedScenes()})
    for (const CheckScene& check : scenes)
      if (fresnel || !check.scene.needsFresnel()) out.push_back(check.scene);
  return out;
}

// Everything that may be written into the folder.
std::vector<std::string> outputNames(const ShadingCheckOptions& options) {
  std::vector<std::string> out{"shading.json", "contact.png", "lost.png"};
  for (const Scene& scene : scenesToShow(true, true, options))
    for (const char* const ending : {".png", ".exr"}) out.push_back(scene.name + ending);
  return out;
}

// The folder is there and everything in it can be written, without loss of what is read.
void checkOutput(const CheckGlArguments& a, const ShadingCheckOptions& options) {
  std::vector<std::string> inputs = filesOfTable(a.table, a.input);
  if (!a.against.empty()) {
    const std::vector<std::string> more = filesOfTable(a.against);
    inputs.insert(inputs.end(), more.begin(), more.end());
  }
  makePictureFolder(a.output);
  for (const std::string& name : outputNames(options)) {
    const std::string path = (std::filesystem::path(a.output) / name).string();
    for (const std::string& input : inputs)
      if (isSameFile(path, input))
        throw InputError(fmt::format("--output {}: would overwrite {}", a.output, input));
    checkWritable(path);
  }
}

// What the shaders cost, in general and the table's own; nothing in a build that cannot count it.
std::vector<ShaderVariantCost> costsFor([[maybe_unused]] const ShaderTable& table) {
#if LTCFIT_STUDY
  std::vector<ShaderVariant> variants = shaderVariants();
  if (table.lookup)
    for (ShaderVariant& variant : lookupVariants(table.table.info())) variants.push_back(std::move(variant));
  return costsOf(std::move(variants));
#else
  return {};
#endif
}

int checkGlCommand(const CheckGlArguments& a) {
  checkArguments(a);
  const ShadingCheckOptions options = toOptions(a);
  const InputTable input = readInput(a.table, a.input);
  const ShaderTable table = makeShaderTable(input, a.table);
  if (table.isIsotropic() && options.custom && options.custom->alpha.x() != options.custom->alpha.y())
    throw InputError(fmt::format("--alpha-x {} --alpha-y {}: {} is an isotropic table",
                                 options.custom->alpha.x(), options.custom->alpha.y(), a.table));
  std::optional<ShaderTable> against;
  if (!a.against.empty()) {
    against = makeShaderTable(readInput(a.against), a.against, &table.table);
    if (against->isIsotropic() != table.isIsotropic())
      throw InputError(
          fmt::format("--against {}: of {} and {} only one is anisotropic", a.against, a.table, a.against));
  }
  if (a.window) {
    fmt::print("{}", windowHelp());
    std::fflush(stdout);
    showWindow(table, scenesToShow(!table.isIsotropic(), table.hasFresnel(), options));
    return kExitOk;
  }
  if (!a.output.empty()) checkOutput(a, options);
  ShadingCheck check;
  {
    Progress progress("check-gl", a.quiet);
    check = runShadingCheck(table, against ? &*against : nullptr, options,
                            [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  const std::vector<ShaderVariantCost> costs = costsFor(table);
  const nlohmann::ordered_json json =
      shadingToJson({fileName(a.table), &table}, {fileName(a.against), against ? &*against : nullptr},
                    options, check, costs, commandOf(a));
  const std::string text = json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  if (!a.output.empty()) {
    const std::filesystem::path folder(a.output);
    for (const ExportFile& file : shadingPictures(check, fileName(a.table), fileName(a.against)))
      writeFileAtomically((folder / file.name).string(), file.bytes);
    writeFileAtomically((folder / "shading.json").string(), text);
  }
  if (a.json) {
    fmt::print("{}", text);
  } else {
    printCheck(a, options, table, against ? &*against : nullptr, check);
#if LTCFIT_STUDY
    if (a.cost) fmt::print("\n{}", formatShaderCosts(costs));
#endif
    if (!input.isReadRight)
      fmt::print("{} FAILED: its numbers are not what they are read as (warnings above)\n",
                 fileName(a.table));
  }
  return check.passed() && input.isReadRight ? kExitOk : kExitQuality;
}

}  // namespace

void addCheckGlCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand(
      "check-gl", "Shade scenes with an exported table in OpenGL, and compare with the true light");
  auto a = std::make_shared<CheckGlArguments>();
  command
      ->add_option("table", a->table, "The table: any file that ltcfit reads; textures are used as they are")
      ->required()
      ->type_name("FILE");
  addTableInput(*command, a->input);
  command
      ->add_option(
          "--against", a->against,
          "Another table of the same kind, shaded in the same scenes; norm and Fresnel from the first "
          "where it has none")
      ->type_name("FILE");
  command
      ->add_option("-o,--output", a->output,
                   "Folder for pictures (PNG and EXR of each scene, contact sheets) and shading.json, which\n"
                   "`ltcfit report --shading` takes")
      ->type_name("DIR");
  command->add_option("--light", a->light, "One scene alone, a sphere on the ground under this light")
      ->check(CLI::IsMember({"quad", "star", "disk-as-polygon"}));
  command->add_option("--alpha-x", a->alphaX, "One scene alone: GGX's alpha along the tangents, 0.0001..1")
      ->check(CLI::Range(1e-4, 1.0));
  command->add_option("--alpha-y", a->alphaY, "The same across them, 0.0001..1; one alone is both")
      ->check(CLI::Range(1e-4, 1.0));
  command->add_option("--angle", a->angle, "One scene alone: turns the tangents, degrees, -360..360")
      ->check(CLI::Range(-360.0, 360.0));
  command->add_option("--width", a->width, "Width of the pictures in pixels, 16..1024")
      ->check(CLI::Range(std::int64_t{16}, std::int64_t{1024}))
      ->capture_default_str();
  command->add_option("--height", a->height, "Height, 16..1024")
      ->check(CLI::Range(std::int64_t{16}, std::int64_t{1024}))
      ->capture_default_str();
  command
      ->add_option("--random", a->randomScenes,
                   "Number of random scenes, 32 x 32 pixels each, 0..10000; a quarter of them\n"
                   "once more with --f0")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{10000}))
      ->capture_default_str();
  command->add_option("--f0", a->f0, "Reflectance at normal incidence of the repeated random scenes, 0..1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--samples", a->samples,
                   "Most samples of a pixel of the reference, for each light and strategy, 128..2^20;\n"
                   "rounded up to a power of two")
      ->check(CLI::Range(std::int64_t{128}, std::int64_t{1} << 20))
      ->capture_default_str();
  command->add_option("--seed", a->seed, "Seed of the random scenes and of the reference, 0..2^53")
      ->check(CLI::Range(std::int64_t{0}, kLargestSeed))
      ->capture_default_str();
  command->add_option("--threads", a->threads, "Threads; 0 = all cores. Does not change the figures")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command
      ->add_flag("--window", a->window,
                 "Show the scenes in a window instead, to turn and change by mouse and keys (printed then)")
      ->excludes("--against")
      ->excludes("--output");
#if LTCFIT_STUDY
  command->add_flag(
      "--cost", a->cost,
      "Also print what each variant of the look-up costs: texture fetches and scalar operations,\n"
      "counted in its optimised SPIR-V (shading.json has them always)");
#endif
  command->add_flag("-q,--quiet", a->quiet, "No progress line");
  command->add_flag("--json", a->json, "Print the JSON instead of the table");
  command->callback([a, &status] { status.exitCode = checkGlCommand(*a); });
}

}  // namespace ltcfit::app

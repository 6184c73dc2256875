// ltcfit export: a table in the form a program reads.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "app/commands.h"
#include "app/half_summary.h"
#include "export/atomic_file.h"
#include "export/formats.h"
#include "export/profiles.h"
#include "export/read_table.h"

namespace ltcfit::app {
namespace {

constexpr const char* kAllProfiles = "all";
constexpr int kWorstNodes = 10;

struct ExportArguments {
  std::string input;
  std::string output;
  std::string format;
  std::string profile;
  std::string layout;
  std::string precision = "float";
  std::string ddsHeader;
  std::string prefix;
  bool uncompressed = false;
  bool resample = false;
  bool list = false;
  bool report = false;
  bool quiet = false;
};

int printList() {
  fmt::print("Formats (--format), with what else they take:\n");
  for (const FormatInfo& format : formats()) {
    fmt::print("  {:<17}{}{}{}{}\n", format.name, format.contents, format.layouts ? "; --layout" : "",
               format.half ? "; --precision half" : "", format.prefix ? "; --prefix" : "");
  }
  fmt::print(
      "\nProfiles (--profile): the exact files of engines. 2017 axes: sqrt(alpha), sqrt(1 - cos theta);\n"
      "2016 axes: sqrt(alpha), theta.\n");
  for (const Profile& profile : profiles())
    fmt::print("  {:<17}{}\n  {:<17}{} -> {}\n", profile.name, profile.consumer, "", profile.layout,
               fmt::join(profile.files, ", "));
  fmt::print("  {:<17}every profile that the table fits, each in its own folder\n", kAllProfiles);
  return kExitOk;
}

// A folder to write into, made if it is not there.
void makeFolder(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return;
  if (std::filesystem::exists(path, error))
    throw InputError(path + ": is a file; this profile has several files and needs a folder");
  if (!std::filesystem::create_directory(path, error) || error)
    throw InputError(fmt::format("{}: cannot make this folder ({})", path, error.message()));
}

// The files of one export, beside each other.
void writeFiles(const ExportArguments& a, const std::string& folder, const ExportResult& result) {
  std::vector<std::string> paths;
  for (const ExportFile& file : result.files) {
    // a name alone stays a name: no "./"
    paths.push_back(folder.empty() ? file.name : (std::filesystem::path(folder) / file.name).string());
    if (isSameFile(paths.back(), a.input))
      throw InputError(a.input + ": --output would overwrite this table");
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const bool sidecar = i > 0 && result.files[i].name.ends_with(".json");
    if (sidecar && isStream(paths[0])) continue;
    if (i > 0) checkWritable(paths[i]);
    writeFileAtomically(paths[i], result.files[i].bytes);
    if (!a.quiet) fmt::print("wrote {} ({} bytes)\n", paths[i], result.files[i].bytes.size());
  }
  for (const std::string& warning : result.warnings) fmt::print(stderr, "ltcfit: warning: {}\n", warning);
}

int exportProfiles(const ExportArguments& a, const Table& table) {
  if (a.profile == kAllProfiles) {
    makeFolder(a.output);
    for (const Profile& profile : profiles()) {
      const bool fits = fitsProfile(table, profile);
      if (!fits && !(a.resample && table.isIsotropic() == profile.axes.isotropic)) {
        if (!a.quiet)
          fmt::print("left out {}: needs another table, `{}`\n", profile.name, fitCommand(profile));
        continue;
      }
      const std::string folder = (std::filesystem::path(a.output) / profile.name).string();
      const ExportResult result = exportProfile(table, profile, a.resample, std::string(profile.files[0]));
      makeFolder(folder);
      writeFiles(a, folder, result);
      if (!a.quiet) printHalfSummary(table, result.half, a.report ? kWorstNodes : 0);
    }
    return kExitOk;
  }
  const Profile* const profile = findProfile(a.profile);
  if (profile == nullptr)
    throw InputError("--profile " + a.profile + ": not known; `ltcfit export --list` shows all");
  const bool folder = profile->files.size() > 1;
  if (!folder) checkWritable(a.output);
  const std::filesystem::path path(a.output);
  const ExportResult result =
      exportProfile(table, *profile, a.resample, folder ? std::string() : path.filename().string());
  if (folder) makeFolder(a.output);
  writeFiles(a, folder ? a.output : path.parent_path().string(), result);
  if (!a.quiet) printHalfSummary(table, result.half, a.report ? kWorstNodes : 0);
  return kExitOk;
}

const FormatInfo& formatOf(const ExportArguments& a) {
  // by the name where nothing is said
  std::string name = a.format;
  const std::string extension = std::filesystem::path(a.output).extension().string();
  for (const FormatInfo& format : formats()) {
    if (name.empty() && format.extension == extension) name = format.name;
  }
  if (name.empty()) name = "h";
  const FormatInfo* const format = findFormat(name);
  if (format == nullptr)
    throw InputError("--format " + name + ": not known; `ltcfit export --list` shows all");
  return *format;
}

int exportFormat(const ExportArguments& a, const Table& table) {
  const FormatInfo& format = formatOf(a);
  FormatOptions options;
  options.layout = a.layout.empty()       ? format.standard
                   : a.layout == "packed" ? Layout::kPacked
                                          : Layout::kChannels;
  options.precision = a.precision == "half" ? Precision::kHalf : Precision::kFloat;
  options.prefix = a.prefix;
  if (a.ddsHeader == "legacy") options.ddsHeader = DdsHeader::kLegacy;
  if (a.uncompressed) options.ktx2Compression = Ktx2Compression::kNone;
  if (!a.ddsHeader.empty() && format.name != "dds") throw InputError("--dds-header is for --format dds");
  if (a.uncompressed && format.name != "ktx2") throw InputError("--uncompressed is for --format ktx2");
  const std::filesystem::path path(a.output);
  const ExportResult result = exportTable(table, format, options, path.filename().string());
  writeFiles(a, path.parent_path().string(), result);
  if (!a.quiet) printHalfSummary(table, result.half, a.report ? kWorstNodes : 0);
  return kExitOk;
}

int runExport(const ExportArguments& a) {
  if (a.list) return printList();
  if (a.input.empty()) throw InputError("a table to read is required; --list shows formats and profiles");
  if (a.output.empty()) throw InputError("--output is required");
  if (!a.profile.empty()) {
    const std::pair<const char*, bool> others[] = {
        {"--format", !a.format.empty()},         {"--layout", !a.layout.empty()},
        {"--precision", a.precision != "float"}, {"--prefix", !a.prefix.empty()},
        {"--dds-header", !a.ddsHeader.empty()},  {"--uncompressed", a.uncompressed}};
    for (const auto& [option, given] : others) {
      if (given) throw InputError(fmt::format("{}: a profile settles this; give one of the two", option));
    }
  } else {
    if (a.resample) throw InputError("--resample needs --profile");
    checkWritable(a.output);
    if (isSameFile(a.output, a.input)) throw InputError(a.input + ": --output would overwrite this table");
  }
  const Table table = readTable(a.input);
  try {
    return a.profile.empty() ? exportFormat(a, table) : exportProfiles(a, table);
  } catch (const std::invalid_argument& error) {
    throw InputError(a.input + ": " + error.what());
  }
}

}  // namespace

void addExportCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command =
      app.add_subcommand("export", "Write a table in the form a program or engine reads");
  auto a = std::make_shared<ExportArguments>();
  command
      ->add_option("table", a->input,
                   "Table to read: whatever ltcfit writes, or a table that an engine ships")
      ->type_name("FILE");
  command->add_option("-o,--output", a->output, "File to write; a folder for profiles of several files")
      ->type_name("PATH");
  command
      ->add_option("--format", a->format,
                   "h, hlsl, glsl, dds, exr, json, npy, ktx2, js, bin [by the output's name, else h]")
      ->type_name("NAME");
  command
      ->add_option(
          "--profile", a->profile,
          "The exact files of an engine: three, babylon, playcanvas, bevy, eevee, unreal, unity-hdrp,\n"
          "o3de, godot, selfshadow-dds, anisotropic-2022; all")
      ->type_name("NAME");
  command->add_flag("--list", a->list, "Show all formats and profiles with their layout, and end");
  command->add_flag("--resample", a->resample, "Let a profile interpolate a table of other axes or size");
  command
      ->add_option("--layout", a->layout,
                   "packed: as shaders read it; channels: every channel as the table stores it, lossless\n"
                   "[channels for exr and npy, else packed]")
      ->check(CLI::IsMember({"packed", "channels"}));
  command
      ->add_option("--precision", a->precision,
                   "float, or half: rounded so that lobes stay, no diagonal entry zero or subnormal,\n"
                   "determinants within 1 % (dds, exr, npy, ktx2, bin)")
      ->check(CLI::IsMember({"float", "half"}))
      ->capture_default_str();
  command
      ->add_option("--dds-header", a->ddsHeader,
                   "dx10, or legacy (FourCC; an isotropic table becomes two files) [dx10]")
      ->check(CLI::IsMember({"dx10", "legacy"}));
  command->add_flag("--uncompressed", a->uncompressed, "KTX2 without zstd supercompression");
  command
      ->add_option(
          "--prefix", a->prefix,
          "Start of the names in source files [the output's file name; anisomats for an anisotropic header]")
      ->type_name("NAME");
  command->add_flag("--report", a->report,
                    "Print the nodes that half precision changes most, with their errors");
  command->add_flag("-q,--quiet", a->quiet, "Print nothing but errors and warnings");
  command->callback([a, &status] { status.exitCode = runExport(*a); });
}

}  // namespace ltcfit::app

// ltcfit export: a table in the form a program reads.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "app/chebyshev_summary.h"
#include "app/commands.h"
#include "app/half_summary.h"
#include "app/notes.h"
#include "app/table_arguments.h"
#include "base/diagnostics.h"
#include "base/refusal.h"
#include "export/atomic_file.h"
#include "export/chebyshev_file.h"
#include "export/formats.h"
#include "export/profiles.h"
#include "export/read_table.h"

namespace ltcfit::app {
namespace {

constexpr const char* kAllProfiles = "all";
constexpr int kWorstNodes = 10;

struct ExportArguments {
  std::string input;
  ReadOptions read;
  std::string output;
  std::string format;
  std::string profile;
  std::string layout;
  std::string precision = "float";
  std::string ddsHeader;
  std::string prefix;
  std::size_t coefficientBytes = 0;  // 0: the default
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
    throw InputError(path + ": is a file; several files are to be written, which need a folder");
  // another run may make it at the same moment
  if (!std::filesystem::create_directory(path, error) && !std::filesystem::is_directory(path))
    throw InputError(fmt::format("{}: cannot make this folder ({})", path, error.message()));
}

// One export, and where its files go.
struct Written {
  std::string folder;  // empty: beside the current one, names as they are
  ExportResult result;
  std::vector<std::string> paths;
};

// Paths of the files, after a look at whether all of them can be written and none is read from.
void placeFiles(const ExportArguments& a, Written& w) {
  for (const ExportFile& file : w.result.files) {
    const std::string path =
        w.folder.empty() ? file.name : (std::filesystem::path(w.folder) / file.name).string();
    if (!w.paths.empty() && isStream(w.paths[0])) break;  // descriptions cannot lie beside a stream
    checkWritable(path);
    for (const std::string& input : filesOfTable(a.input, a.read)) {
      if (isSameFile(path, input))
        throw InputError(fmt::format("{}: --output would overwrite this {}", input,
                                     input == a.input ? "table" : "part of the table"));
    }
    w.paths.push_back(path);
  }
}

void writeFiles(const Written& w) {
  for (std::size_t i = 0; i < w.paths.size(); ++i) writeFileAtomically(w.paths[i], w.result.files[i].bytes);
}

// After all files are written: a full stdout leaves none of them out.
void printWritten(const ExportArguments& a, const Table& table, const Written& w) {
  for (const std::string& warning : w.result.warnings) complain("warning: " + warning);
  if (a.quiet) return;
  std::string text;
  for (std::size_t i = 0; i < w.paths.size(); ++i)
    text += fmt::format("wrote {} ({} bytes)\n", w.paths[i], w.result.files[i].bytes.size());
  text += w.result.chebyshev
              ? chebyshevSummary(table, *w.result.table, *w.result.chebyshev, a.report)
              : halfSummary(w.result.table.value_or(table), w.result.half, a.report ? kWorstNodes : 0);
  printNotes(isStream(w.paths[0]) ? NotesTo::kStderr : NotesTo::kStdout, text);
}

int exportAllProfiles(const ExportArguments& a, const Table& table) {
  std::vector<Written> all;
  std::string leftOut;
  for (const Profile& profile : profiles()) {
    const bool fits = fitsProfile(table, profile);
    const bool canFit = a.resample && table.isIsotropic() == profile.axes.isotropic;
    std::string why = fmt::format("needs another table, `{}`", fitCommand(profile));
    if (fits || canFit) {
      try {
        Written w{(std::filesystem::path(a.output) / profile.name).string(),
                  exportProfile(table, profile, a.resample, std::string(profile.files[0])),
                  {}};
        all.push_back(std::move(w));
        continue;
      } catch (const Refusal& error) {
        why = error.what();
      }
    }
    leftOut += fmt::format("left out {}: {}\n", profile.name, why);
  }
  if (all.empty()) throw InputError(a.input + ": fits none of the profiles");
  makeFolder(a.output);
  for (Written& w : all) {
    makeFolder(w.folder);
    placeFiles(a, w);
  }
  for (const Written& w : all) writeFiles(w);
  if (!a.quiet) printNotes(NotesTo::kStdout, leftOut);
  for (const Written& w : all) printWritten(a, table, w);
  return kExitOk;
}

int exportProfiles(const ExportArguments& a, const Table& table) {
  if (a.profile == kAllProfiles) return exportAllProfiles(a, table);
  const Profile* const profile = findProfile(a.profile);
  if (profile == nullptr) {
    std::vector<std::string_view> names;
    for (const Profile& p : profiles()) names.push_back(p.name);
    throw InputError(fmt::format("--profile {}: not known; there are {}, {}", a.profile,
                                 fmt::join(names, ", "), kAllProfiles));
  }
  if (a.report && !profile->half)
    throw InputError(fmt::format("--report: profile {} holds floats", a.profile));
  const bool folder = profile->files.size() > 1;
  const std::filesystem::path path(a.output);
  Written w{folder ? a.output : path.parent_path().string(),
            exportProfile(table, *profile, a.resample, folder ? std::string() : path.filename().string()),
            {}};
  if (folder) makeFolder(a.output);
  placeFiles(a, w);
  writeFiles(w);
  printWritten(a, table, w);
  return kExitOk;
}

// By the name where nothing is said; a name without an extension is a header's.
const FormatInfo& formatOf(const ExportArguments& a) {
  std::string extension = std::filesystem::path(a.output).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension.empty()) extension = ".h";
  std::vector<std::string_view> names;
  for (const FormatInfo& format : formats()) {
    names.push_back(format.name);
    if (a.format.empty() ? format.extension == extension : format.name == a.format) return format;
  }
  throw InputError(
      a.format.empty()
          ? fmt::format("{}: what format? --format takes {}", a.output, fmt::join(names, ", "))
          : fmt::format("--format {}: not known; there are {}", a.format, fmt::join(names, ", ")));
}

int exportFormat(const ExportArguments& a, const Table& table) {
  const FormatInfo& format = formatOf(a);
  FormatOptions options;
  options.layout = a.layout.empty() ? format.standard : layoutFromName(a.layout);
  options.precision = a.precision == "half" ? Precision::kHalf : Precision::kFloat;
  options.prefix = a.prefix;
  if (a.ddsHeader == "legacy") options.ddsHeader = DdsHeader::kLegacy;
  if (a.uncompressed) options.ktx2Compression = Ktx2Compression::kNone;
  if (!a.ddsHeader.empty() && format.name != "dds") throw InputError("--dds-header is for --format dds");
  if (a.uncompressed && format.name != "ktx2") throw InputError("--uncompressed is for --format ktx2");
  const bool chebyshev = format.name == "chebyshev";
  if (a.coefficientBytes > 0 && !chebyshev) throw InputError("--coefficients is for --format chebyshev");
  if (a.coefficientBytes > 0) options.coefficientBytes = a.coefficientBytes;
  if (a.report && options.precision != Precision::kHalf && !chebyshev)
    throw InputError("--report needs --precision half or --format chebyshev");
  const std::filesystem::path path(a.output);
  Written w{path.parent_path().string(), exportTable(table, format, options, path.filename().string()), {}};
  if (isStream(a.output) && w.result.files[0].name != path.filename())
    throw InputError(a.output + ": this export has several files, which a stream cannot hold");
  placeFiles(a, w);
  writeFiles(w);
  printWritten(a, table, w);
  return kExitOk;
}

int runExport(const ExportArguments& a) {
  if (a.list) return printList();
  if (a.input.empty()) throw InputError("a table to read is required; --list shows formats and profiles");
  if (a.output.empty()) throw InputError("--output is required");
  if (!a.profile.empty()) {
    const std::pair<const char*, bool> others[] = {
        {"--format", !a.format.empty()},           {"--layout", !a.layout.empty()},
        {"--precision", a.precision != "float"},   {"--prefix", !a.prefix.empty()},
        {"--dds-header", !a.ddsHeader.empty()},    {"--uncompressed", a.uncompressed},
        {"--coefficients", a.coefficientBytes > 0}};
    for (const auto& [option, given] : others) {
      if (given) throw InputError(fmt::format("{}: a profile settles this; give one of the two", option));
    }
  } else {
    if (a.resample) throw InputError("--resample needs --profile");
    checkWritable(a.output);
  }
  const Table table = readInput(a.input, a.read).table;
  try {
    return a.profile.empty() ? exportFormat(a, table) : exportProfiles(a, table);
  } catch (const Refusal& error) {
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
  addTableInput(*command, a->read);
  command->add_option("-o,--output", a->output, "File to write; a folder for profiles of several files")
      ->type_name("PATH");
  command
      ->add_option("--format", a->format,
                   "h, hlsl, glsl, glsl-lookup, hlsl-lookup, dds, exr, json, npy, ktx2, js, bin, chebyshev\n"
                   "[by the output's name; h where it has no extension]")
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
      ->add_option(
          "--layout", a->layout,
          "packed: as shaders read it; lean: the same without what the table lacks, for glsl-lookup\n"
          "and hlsl-lookup; channels: every channel as the table stores it, lossless\n"
          "[channels for exr and npy, else packed]")
      ->check(CLI::IsMember({"packed", "channels", "lean"}));
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
  command
      ->add_option("--coefficients", a->coefficientBytes,
                   fmt::format("Bytes of coefficients of --format chebyshev, 2 each, {}..{} [{}]",
                               kLeastCoefficients * kCoefficientBytes, kMostCoefficients * kCoefficientBytes,
                               FormatOptions().coefficientBytes))
      ->check(CLI::Range(kLeastCoefficients * kCoefficientBytes, kMostCoefficients * kCoefficientBytes))
      ->type_name("BYTES");
  command->add_flag("--report", a->report,
                    "Print the nodes that half precision changes most, with their errors; for chebyshev the\n"
                    "errors of the polynomials off-grid, next to the table's own");
  command->add_flag("-q,--quiet", a->quiet, "Print nothing but errors and warnings");
  command->callback([a, &status] { status.exitCode = runExport(*a); });
}

}  // namespace ltcfit::app

// ltcfit export: a table in the form a program reads.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "app/commands.h"
#include "export/anisotropic_c_header.h"
#include "export/atomic_file.h"
#include "export/c_header.h"
#include "export/json_table.h"
#include "export/read_table.h"

namespace ltcfit::app {
namespace {

struct ExportArguments {
  std::string input;
  std::string output;
  std::string format;
  std::string prefix;
  bool quiet = false;
};

int exportTable(const ExportArguments& a) {
  checkWritable(a.output);
  if (isSameFile(a.output, a.input)) throw InputError(a.input + ": --output would overwrite this table");
  // by the name where nothing is said
  const std::string extension = std::filesystem::path(a.output).extension().string();
  const std::string format = !a.format.empty() ? a.format : extension == ".json" ? "json" : "h";
  if (format == "json" && !a.prefix.empty()) throw InputError("--prefix is for --format h");
  const Table table = readTable(a.input);
  std::string bytes;
  try {
    if (format == "json") {
      bytes = tableToJson(table);
    } else if (!table.isIsotropic()) {
      bytes = tableToAnisotropicCHeader(table, a.prefix.empty() ? "anisomats" : a.prefix);
    } else {
      bytes = tableToCHeader(table,
                             a.prefix.empty() ? std::filesystem::path(a.output).stem().string() : a.prefix);
    }
  } catch (const std::invalid_argument& error) {
    throw InputError(a.input + ": " + error.what());
  }
  writeFileAtomically(a.output, bytes);
  if (!a.quiet) fmt::print("wrote {} ({} bytes)\n", a.output, bytes.size());
  return kExitOk;
}

}  // namespace

void addExportCommand(CLI::App& app, CommandStatus& status) {
  CLI::App* const command = app.add_subcommand("export", "Write a table in another form");
  auto a = std::make_shared<ExportArguments>();
  command->add_option("table", a->input, "Table to read: ltcfit's JSON, or a published table (.npy, DDS)")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", a->output, "File to write")->required()->type_name("FILE");
  command
      ->add_option("--format", a->format,
                   "h: C/C++ header, texture-ready; json: the table file [json for *.json, else h]")
      ->check(CLI::IsMember({"h", "json"}));
  command
      ->add_option(
          "--prefix", a->prefix,
          "Start of the names in the header [the output's file name; anisomats for an anisotropic table]")
      ->type_name("NAME");
  command->add_flag("-q,--quiet", a->quiet, "Print nothing but errors");
  command->callback([a, &status] { status.exitCode = exportTable(*a); });
}

}  // namespace ltcfit::app

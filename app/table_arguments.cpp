#include "app/table_arguments.h"

#include "app/shell_quoted.h"
#include "base/diagnostics.h"

namespace ltcfit::app {

void addTableInput(CLI::App& command, ReadOptions& options) {
  command
      .add_option("--second", options.second,
                  "File of the table's second texture (norm, Fresnel), where the table has two files\n"
                  "and no description [found by the names that engines use]")
      ->type_name("FILE");
}

std::string tableInputText(const ReadOptions& options) {
  if (options.second.empty()) return {};
  return " --second " + shellFileName(options.second);
}

TableFile readInput(const std::string& path, const ReadOptions& options) {
  TableFile file = readTableFile(path, options);
  printNotes(file.notes);
  return file;
}

void printNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) complain("note: " + note);
}

}  // namespace ltcfit::app

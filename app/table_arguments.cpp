#include "app/table_arguments.h"

#include "app/shell_quoted.h"
#include "base/diagnostics.h"
#include "export/reading_verdict.h"

namespace ltcfit::app {

void addTableInput(CLI::App& command, ReadOptions& options) {
  command
      .add_option("--second", options.second,
                  "File of the table's second texture (norm, Fresnel), where the table has two files\n"
                  "and no description [found by the names that engines use]")
      ->type_name("FILE");
  command
      .add_option(
          "--read-as", options.layout,
          "What the numbers of a file without a description mean: 2017, 2016 (also o3de), hdrp, godot;\n"
          "for arrays of six dimensions 2022, alpha_x-alpha_y [the one that they fit]")
      ->type_name("LAYOUT");
}

std::string tableInputText(const ReadOptions& options) {
  std::string text;
  if (!options.second.empty()) text += " --second " + shellFileName(options.second);
  if (!options.layout.empty()) text += " --read-as " + shellFileName(options.layout);
  return text;
}

InputTable readInput(const std::string& path, const ReadOptions& options) {
  InputTable input{readTableFile(path, options)};
  printNotes(input.notes);
  const ReadingVerdict verdict = judgeReading(input.table);
  for (const std::string& complaint : verdict.complaints()) complain("warning: " + path + ": " + complaint);
  input.isReadRight = verdict.passes();
  return input;
}

void printNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) complain("note: " + note);
}

}  // namespace ltcfit::app

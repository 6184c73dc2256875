// The options that say how a table's file is to be read, in every command that takes tables of others.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "export/read_table.h"

namespace ltcfit::app {

/// Adds --second and --read-as.
void addTableInput(CLI::App& command, ReadOptions& options);

/// The options that differ from the default, as a command of provenance has them: each with a space before
/// it, paths without their folders.
std::string tableInputText(const ReadOptions& options);

/// A table as a file holds it, and whether it is read right (judgeReading).
struct InputTable : TableFile {
  bool isReadRight = true;
};

/// readTableFile, with each of the file's notes, and each complaint about how it is read, as a line on
/// stderr.
InputTable readInput(const std::string& path, const ReadOptions& options = {});

/// Prints notes of a reader, each as a line on stderr.
void printNotes(const std::vector<std::string>& notes);

}  // namespace ltcfit::app

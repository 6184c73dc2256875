// The subcommands of ltcfit. Each adds itself to the parser; its work runs from the parser's callback and
// returns through CommandStatus.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

#include "app/exit_codes.h"

namespace ltcfit::app {

/// Seeds go into JSON, whose readers keep 53 bits.
inline constexpr std::int64_t kLargestSeed = std::int64_t{1} << 53;

/// Set by the command that ran.
struct CommandStatus {
  int exitCode = kExitOk;
};

void addFitCommand(CLI::App& app, CommandStatus& status);
void addCheckGlCommand(CLI::App& app, CommandStatus& status);
void addCompareCommand(CLI::App& app, CommandStatus& status);
void addExportCommand(CLI::App& app, CommandStatus& status);
void addParetoCommand(CLI::App& app, CommandStatus& status);
void addPrefilterCommand(CLI::App& app, CommandStatus& status);
void addRefineCommand(CLI::App& app, CommandStatus& status);
void addReportCommand(CLI::App& app, CommandStatus& status);
void addSceneCommand(CLI::App& app, CommandStatus& status);
void addScoreCommand(CLI::App& app, CommandStatus& status);
void addStabilityCommand(CLI::App& app, CommandStatus& status);

}  // namespace ltcfit::app

// ltcfit: fits Linearly Transformed Cosines to GGX and writes the tables that engines shade with.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.h"
#include "app/failure.h"
#include "base/diagnostics.h"

namespace {

using namespace ltcfit;
using namespace ltcfit::app;

// Opens the three standard descriptors that the caller has closed, the wrong way round: reading from the one
// and writing to the others fails as before, but no file that is opened later gets their numbers, and then
// what was meant for a terminal.
void keepStandardDescriptors() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(fd, F_GETFD) < 0) ::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void addCommands(CLI::App& app, CommandStatus& status) {
  addFitCommand(app, status);
#if LTCFIT_SCENE
  addSceneCommand(app, status);
#endif
  addScoreCommand(app, status);
  addCompareCommand(app, status);
  addExportCommand(app, status);
#if LTCFIT_SHADE
  addCheckGlCommand(app, status);
#endif
#if LTCFIT_STUDY
  addParetoCommand(app, status);
#endif
#if LTCFIT_SHADE
  addPrefilterCommand(app, status);
#endif
  addRefineCommand(app, status);
#if LTCFIT_REPORT
  addReportCommand(app, status);
#endif
#if LTCFIT_STUDY
  addStabilityCommand(app, status);
#endif
}

// Part of the build that brings a command; empty for commands that every build has, and for others.
std::string_view partOf(std::string_view command) {
  if (command == "check-gl" || command == "prefilter") return "LTCFIT_SHADE";
  if (command == "scene") return "LTCFIT_SCENE";
  if (command == "report") return "LTCFIT_REPORT";
  if (command == "pareto" || command == "stability") return "LTCFIT_STUDY";
  return {};
}

// What is wrong where the first word is no command of this build.
std::string unknownCommand(const std::string& word) {
  if (const std::string_view part = partOf(word); !part.empty())
    return fmt::format("{}: left out of this build, which was configured with -D{}=OFF", word, part);
  return fmt::format("{} '{}'; --help lists what there is",
                     word.starts_with('-') ? "unknown option" : "unknown command", word);
}

int run(int argc, char** argv) {
  CLI::App app(
      "Fits Linearly Transformed Cosines to the GGX lobe and writes the tables that real-time\n"
      "renderers shade area lights with.");
  app.name("ltcfit");
  app.set_version_flag("--version", "ltcfit " LTCFIT_VERSION, "Print the version");
  app.set_help_flag("-h,--help", "Print this help");
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 I/O or run-time failure; 2 bad option or input file; 3 a quality gate failed.\n"
      "Help on a command: ltcfit COMMAND --help");
  CommandStatus status;
  addCommands(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error);  // prints --help or --version
    } else {
      const std::vector<std::string> extra = app.remaining(true);
      const bool command = error.get_name() == "RequiredError" && !extra.empty();
      complain(command ? unknownCommand(extra[0])
                       : std::string(error.what()) + "; --help lists what there is");
      return kExitBadInput;
    }
  } catch (...) {
    const Failure failure = failureOf(std::current_exception());
    // a print that failed has thrown, too
    const bool output = std::ferror(stdout) != 0;
    complain(output ? "cannot write to standard output: " + failure.message : failure.message);
    return output ? kExitFailure : failure.exitCode;
  }
  // what was printed must have arrived: a full disk behind a redirection is a failure
  std::cout.flush();
  if (std::fflush(stdout) != 0 || !std::cout) {
    complain("cannot write to standard output");
    return kExitFailure;
  }
  return status.exitCode;
}

}  // namespace

int main(int argc, char** argv) {
  keepStandardDescriptors();
  // A reader that has gone away is a write that fails: on stdout an exit code of 1, on stderr nothing.
  std::signal(SIGPIPE, SIG_IGN);
  return run(argc, argv);
}

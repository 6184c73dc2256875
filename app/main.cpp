// ltcfit: fits Linearly Transformed Cosines to GGX and writes the tables that engines shade with.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/commands.h"
#include "export/atomic_file.h"

namespace {

using namespace ltcfit;
using namespace ltcfit::app;

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
  addFitCommand(app, status);
  addScoreCommand(app, status);
  addExportCommand(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::vector<std::string> extra = app.remaining(true);
    if (error.get_name() == "RequiredError" && !extra.empty() && extra[0].front() != '-') {
      fmt::print(stderr, "ltcfit: unknown command '{}'\nRun with --help for the commands.\n", extra[0]);
    } else {
      fmt::print(stderr, "ltcfit: {}\nRun with --help for the options.\n", error.what());
    }
    return kExitBadInput;
  } catch (const InputError& error) {
    fmt::print(stderr, "ltcfit: {}\n", error.what());
    return kExitBadInput;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "ltcfit: {}\n", error.what());
    return kExitBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "ltcfit: {}\n", error.what());
    return kExitFailure;
  }
  // what was printed must have arrived: a full disk behind a redirection is a failure
  if (std::fflush(stdout) != 0) {
    fmt::print(stderr, "ltcfit: cannot write to standard output\n");
    return kExitFailure;
  }
  return status.exitCode;
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv);
}

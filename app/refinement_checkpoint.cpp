#include "app/refinement_checkpoint.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "export/atomic_file.h"
#include "export/little_endian.h"

namespace ltcfit::app {
namespace {

constexpr std::string_view kMagic = "ltcfit-refinement 1 ";
constexpr int kMostIterations = 1000000;

// "NUMBER " from the front of `text`; false where there is none.
template <class Number>
bool take(std::string_view* text, Number* number) {
  const auto parsed = std::from_chars(text->data(), text->data() + text->size(), *number);
  if (parsed.ec != std::errc() || parsed.ptr == text->data() + text->size() || *parsed.ptr != ' ')
    return false;
  text->remove_prefix(static_cast<std::size_t>(parsed.ptr - text->data()) + 1);
  return true;
}

// "ITERATIONS RADIUS COST PARAMETER... "; false where anything is not as written.
bool parseState(std::string_view line, RefinementState* state) {
  if (!take(&line, &state->iterations) || !take(&line, &state->radius) || !take(&line, &state->cost))
    return false;
  while (!line.empty()) {
    double x = 0.0;
    if (!take(&line, &x) || !std::isfinite(x)) return false;
    state->parameters.push_back(x);
  }
  return state->iterations >= 0 && state->iterations <= kMostIterations && std::isfinite(state->radius) &&
         state->radius >= 0.0 && std::isfinite(state->cost);
}

RefinementState parse(std::string_view text, const std::string& path, const std::string& fingerprint) {
  const auto refuse = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", path, what)); };
  if (!text.starts_with(kMagic)) refuse("not a checkpoint of a refinement");
  const std::size_t first = text.find('\n');
  const std::size_t second = first == text.npos ? text.npos : text.find('\n', first + 1);
  if (second == text.npos ||
      text.substr(second + 1) != fmt::format("{}\n", checksum(text.substr(0, second + 1))))
    refuse("is damaged; without that file a run starts anew");
  const std::string_view run = text.substr(kMagic.size(), first - kMagic.size());
  if (run != fingerprint) refuse(fmt::format("holds another run, of: {}", run));
  RefinementState state;
  if (!parseState(text.substr(first + 1, second - first - 1), &state))
    refuse("holds numbers that no run has written");
  return state;
}

}  // namespace

RefinementCheckpoint::RefinementCheckpoint(std::string path, std::string fingerprint, bool resume)
    : path_(std::move(path)), fingerprint_(std::move(fingerprint)) {
  std::error_code ignored;
  if (!std::filesystem::exists(path_, ignored)) return;
  if (!std::filesystem::is_regular_file(path_, ignored)) throw InputError(path_ + ": not a file");
  if (!resume) {
    throw InputError(path_ +
                     ": of a run that was interrupted or is still going; --resume goes on with it, without "
                     "that file a run starts anew");
  }
  found_ = parse(readFile(path_), path_, fingerprint_);
}

void RefinementCheckpoint::save(const RefinementState& state) const {
  std::string text =
      fmt::format("{}{}\n{} {} {} ", kMagic, fingerprint_, state.iterations, state.radius, state.cost);
  for (const double x : state.parameters) fmt::format_to(std::back_inserter(text), "{} ", x);
  text.push_back('\n');
  fmt::format_to(std::back_inserter(text), "{}\n", checksum(text));
  writeFileAtomically(path_, text);
}

void RefinementCheckpoint::remove() const {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace ltcfit::app

#include "fit/checkpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "base/refusal.h"

namespace ltcfit {
namespace {

constexpr std::string_view kMagic = "ltcfit-checkpoint 2 ";
constexpr std::size_t kNumbers = 24;
using Numbers = std::array<double, kNumbers>;

Numbers toNumbers(const JobResult& r) {
  Numbers n{};
  for (std::size_t k = 0; k < 9; ++k) n[k] = r.m(static_cast<int>(k) / 3, static_cast<int>(k) % 3);
  const std::array<double, kNumbers - 9> rest{r.startLoss,
                                              r.loss,
                                              r.alignedLoss,
                                              r.symmetricLoss,
                                              r.storedLoss,
                                              r.distanceBefore,
                                              r.distanceAfter,
                                              r.alignmentStrength,
                                              r.norm,
                                              r.fresnel,
                                              r.momentError,
                                              r.integralError,
                                              static_cast<double>(r.evaluations),
                                              static_cast<double>(r.termination),
                                              (r.fitted ? 1.0 : 0.0) + (r.flipWouldBeCloser ? 2.0 : 0.0)};
  std::copy(rest.begin(), rest.end(), n.begin() + 9);
  return n;
}

JobResult fromNumbers(const Numbers& n) {
  JobResult r;
  for (std::size_t k = 0; k < 9; ++k) r.m(static_cast<int>(k) / 3, static_cast<int>(k) % 3) = n[k];
  r.startLoss = n[9];
  r.loss = n[10];
  r.alignedLoss = n[11];
  r.symmetricLoss = n[12];
  r.storedLoss = n[13];
  r.distanceBefore = n[14];
  r.distanceAfter = n[15];
  r.alignmentStrength = n[16];
  r.norm = n[17];
  r.fresnel = n[18];
  r.momentError = n[19];
  r.integralError = n[20];
  r.evaluations = static_cast<int>(n[21]);
  r.termination = static_cast<Termination>(static_cast<int>(n[22]));
  r.fitted = std::fmod(n[23], 2.0) == 1.0;
  r.flipWouldBeCloser = n[23] >= 2.0;
  return r;
}

// FNV-1a: tells a damaged line from a whole one.
std::uint64_t checksum(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}

// "INDEX NUMBER... CHECKSUM"; false where anything is not as written.
bool parseLine(std::string_view line, std::size_t jobs, std::size_t* job, Numbers* numbers) {
  const std::size_t cut = line.rfind(' ');
  if (cut == std::string_view::npos) return false;
  std::uint64_t sum = 0;
  const char* const end = line.data() + line.size();
  const auto parsed = std::from_chars(line.data() + cut + 1, end, sum, 16);
  if (parsed.ec != std::errc() || parsed.ptr != end || sum != checksum(line.substr(0, cut))) return false;
  const char* p = line.data();
  const char* const last = line.data() + cut;
  auto index = std::from_chars(p, last, *job);
  if (index.ec != std::errc() || *job >= jobs) return false;
  p = index.ptr;
  for (double& x : *numbers) {
    if (p == last || *p != ' ') return false;
    const auto number = std::from_chars(p + 1, last, x);
    if (number.ec != std::errc()) return false;
    p = number.ptr;
  }
  const Numbers& n = *numbers;
  const bool finite = std::all_of(n.begin(), n.end(), [](double x) { return std::isfinite(x); });
  // norm and Fresnel are albedos; evaluations and termination go into integers
  return p == last && finite && n[17] >= 0.0 && n[17] <= 1.001 && n[18] >= 0.0 && n[18] <= 1.001 &&
         n[21] >= 0.0 && n[21] < 2e9 && n[22] >= 0.0 && n[22] <= 2.0;
}

void writeAll(int file, const std::string& path, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(file, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::runtime_error(path + ": " + std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

}  // namespace

Checkpoint::Checkpoint(std::string path, const std::string& fingerprint, std::size_t jobs)
    : path_(std::move(path)) {
  // without O_NONBLOCK a pipe of that name would wait for ever
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW, 0666);
  if (file_ < 0 && errno == ELOOP) throw Refusal(path_ + ": a link, not a file");
  if (file_ < 0) throw std::runtime_error(path_ + ": " + std::strerror(errno));
  try {
    struct stat opened {};
    struct stat named {};
    if (::fstat(file_, &opened) != 0 || !S_ISREG(opened.st_mode)) throw Refusal(path_ + ": not a file");
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) throw std::runtime_error(path_ + ": in use by another run");
    // a run that ended in between has deleted the file that was opened
    if (::stat(path_.c_str(), &named) != 0 || named.st_ino != opened.st_ino || named.st_dev != opened.st_dev)
      throw std::runtime_error(path_ + ": another run has just ended; try again");
    read(std::string(kMagic) + std::to_string(jobs) + " " + fingerprint + "\n", jobs);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

void Checkpoint::read(const std::string& header, std::size_t jobs) {
  std::string text;
  std::array<char, 65536> buffer{};
  for (ssize_t n = 0; (n = ::read(file_, buffer.data(), buffer.size())) != 0;) {
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::runtime_error(path_ + ": " + std::strerror(errno));
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  // a run killed before its first line was whole leaves a part of the header: the same as nothing
  const bool nothing = text.size() < header.size() && header.compare(0, text.size(), text) == 0;
  std::size_t whole = 0;
  if (!nothing) {
    if (text.compare(0, kMagic.size(), kMagic) != 0) throw Refusal(path_ + ": not a checkpoint");
    if (text.compare(0, header.size(), header) != 0) {
      throw Refusal(
          path_ + ": holds another run, of: " + text.substr(kMagic.size(), text.find('\n') - kMagic.size()));
    }
    whole = header.size();
    while (whole < text.size()) {
      const std::size_t end = text.find('\n', whole);
      if (end == std::string::npos) break;
      std::size_t job = 0;
      Numbers numbers{};
      if (parseLine(std::string_view(text).substr(whole, end - whole), jobs, &job, &numbers))
        known_.emplace(job, fromNumbers(numbers));
      whole = end + 1;
    }
  }
  // what was cut off goes; lines are appended after the last whole one
  if (::ftruncate(file_, static_cast<off_t>(whole)) != 0 || ::lseek(file_, 0, SEEK_END) < 0)
    throw std::runtime_error(path_ + ": " + std::strerror(errno));
  if (nothing) writeAll(file_, path_, header);
}

Checkpoint::~Checkpoint() {
  if (file_ >= 0) ::close(file_);
}

const JobResult* Checkpoint::find(std::size_t job) const {
  const auto found = known_.find(job);
  return found == known_.end() ? nullptr : &found->second;
}

void Checkpoint::add(std::size_t job, const JobResult& result) {
  std::string line = std::to_string(job);
  for (const double x : toNumbers(result)) fmt::format_to(std::back_inserter(line), " {}", x);
  fmt::format_to(std::back_inserter(line), " {:x}\n", checksum(line));
  writeAll(file_, path_, line);
}

void Checkpoint::remove() {
  ::unlink(path_.c_str());  // before the lock goes with the descriptor
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

}  // namespace ltcfit

// Finished jobs on disk, so that a killed run loses none of them.
#pragma once

#include <map>
#include <string>

#include "fit/table_fit.h"

namespace ltcfit {

/// A text file: one line that says what is fitted, then one line for each finished job with a checksum,
/// appended as it finishes. Numbers are printed so that they read back to the same double. A last line that
/// was cut off, or any line whose checksum is wrong, is as if it were not there: that job is fitted again.
class Checkpoint final : public JobStore {
 public:
  /// Opens or makes the file. `fingerprint` is one line that names everything the results depend on (command
  /// and version); `jobs` their number. Throws Refusal where the file belongs to another
  /// fingerprint or is no checkpoint, std::runtime_error where it cannot be written or another run has it
  /// open.
  Checkpoint(std::string path, const std::string& fingerprint, std::size_t jobs);
  ~Checkpoint() override;
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  std::size_t size() const { return known_.size(); }
  const JobResult* find(std::size_t job) const override;
  /// Throws std::runtime_error where the line cannot be written.
  void add(std::size_t job, const JobResult& result) override;

  /// Deletes the file: the table is written.
  void remove();

 private:
  void read(const std::string& header, std::size_t jobs);

  std::string path_;
  int file_ = -1;
  std::map<std::size_t, JobResult> known_;
};

}  // namespace ltcfit

// Where an interrupted refinement stands, on disk.
#pragma once

#include <optional>
#include <string>

#include "fit/table_refinement.h"

namespace ltcfit::app {

/// A text file that is replaced as a whole after each iteration: what is refined, where it stands in numbers
/// that read back to the same double, and a checksum over all of it.
class RefinementCheckpoint {
 public:
  /// Reads the file where there is one and `resume` says so. `fingerprint` is one line that names everything
  /// the parameters depend on (command, version, table). Throws InputError where there is a file without
  /// `resume`, or one of another fingerprint, or one that is damaged.
  RefinementCheckpoint(std::string path, std::string fingerprint, bool resume);

  /// As read; null where the refinement begins.
  const RefinementState* found() const { return found_ ? &*found_ : nullptr; }

  /// Throws FileError where it cannot be written.
  void save(const RefinementState& state) const;

  /// Deletes the file: the table is written.
  void remove() const;

 private:
  std::string path_;
  std::string fingerprint_;
  std::optional<RefinementState> found_;
};

}  // namespace ltcfit::app

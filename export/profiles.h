// Exact files of engines: `ltcfit export --profile`. Layouts as their sources read them, 2025-26.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "export/formats.h"

namespace ltcfit {

/// The nodes that an engine's shader addresses.
struct ProfileAxes {
  bool isotropic = true;
  AxisMap theta = AxisMap::kSqrtOneMinusCos;
  std::size_t thetaNodes = 64;  ///< isotropic
  std::size_t alphaNodes = 64;  ///< isotropic; alpha by its square root
};

struct Profile {
  std::string_view name;
  std::string_view consumer;
  std::string_view layout;  ///< for `ltcfit export --list`
  ProfileAxes axes;
  std::vector<std::string_view> files;  ///< of the engine; more than one: the output is a folder
  bool half = false;                    ///< stores halves
};

const std::vector<Profile>& profiles();

/// The profile of that name; nullptr for none.
const Profile* findProfile(std::string_view name);

/// Whether the table has the nodes that the engine addresses.
bool fitsProfile(const Table& table, const Profile& profile);

/// The command that fits a table with these nodes.
std::string fitCommand(const Profile& profile);

/// The files of the engine and a sidecar for those that have no place for a comment. `name` is the file's,
/// without folder, where the profile has one file. With `resample` a table of other nodes is looked up at the
/// engine's (ltc/resample.h, with its interpolation error). Throws Refusal: other axes or size
/// (naming fitCommand), no norm or Fresnel, an entry that the layout has no place for. Warns of numbers
/// outside of the ranges that an engine has built in.
ExportResult exportProfile(const Table& table, const Profile& profile, bool resample,
                           const std::string& name);

}  // namespace ltcfit

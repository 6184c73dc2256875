// Pictures within JSON.
#pragma once

#include <cstddef>
#include <string>

#include "export/json_fields.h"

namespace ltcfit {

/// Largest side of a picture, and all pixels of a file together: a page with more would not open.
inline constexpr std::size_t kMostPictureSide = 4096;
inline constexpr std::size_t kMostPicturePixels = 256000000;

/// Asks of every picture of a file that it is a PNG in base64 (RFC 4648, padded) that decodes whole.
class PictureChecks {
 public:
  /// The member `key` of `pictures`. Throws InputError naming it; sizes are asked before anything is decoded.
  void require(const JsonFields& pictures, const char* key);

 private:
  std::size_t pixels_ = 0;  // of all so far
};

}  // namespace ltcfit

// Pictures of Radiance (.hdr): four bytes a pixel, three mantissas and a common exponent.
#pragma once

#include <string>
#include <string_view>

#include "export/picture.h"

namespace ltcfit {

bool isRadiance(std::string_view bytes);

/// FORMAT=32-bit_rle_rgbe with scanlines run-length encoded, in the old way, or not at all, in any of the
/// eight orientations. A pixel (r, g, b, e) is (r, g, b) 2^(e - 136), and black for e = 0; it is divided by
/// all EXPOSURE values of the header, as the format asks. Primaries are taken for those of BT.709. InputError
/// with `name` for other formats, for what is damaged or cut off, larger than kMaxPictureSide, or claims more
/// pixels than its length can hold, before anything of that size is allocated.
LinearPicture parseRadiance(std::string_view bytes, const std::string& name);

}  // namespace ltcfit

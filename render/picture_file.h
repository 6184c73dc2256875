// Files of pictures that lights show.
#pragma once

#include <string>
#include <string_view>

#include "export/picture.h"

namespace ltcfit {

bool isJpeg(std::string_view bytes);

/// A JPEG of 8 bits, grey or colour; its values are sRGB, whatever profile it names, and its orientation is
/// that of its rows. InputError with `name` as parsePng.
LinearPicture parseJpeg(std::string_view bytes, const std::string& name);

/// A PNG, a JPEG, a picture of Radiance, or an EXR as parseExrPicture reads it, which is linear (alpha is
/// multiplied in there already, and ignored; negative values, which filters and colours out of gamut leave,
/// become 0: no light has them). InputError naming the file for anything else and for values that are not
/// finite.
LinearPicture readPicture(const std::string& path);

}  // namespace ltcfit

// What `ltcfit check-gl` measured, as a report takes it in.
#pragma once

#include <string>
#include <string_view>

#include "export/json_fields.h"

namespace ltcfit {

/// Largest file taken: some fifty scenes with five pictures of 200 KiB.
inline constexpr std::size_t kShadingBytes = std::size_t{256} << 20;

/// The JSON that `ltcfit check-gl` wrote (shading.json), every field that the page reads checked for its type
/// and range, and fields against one another, so that the page cannot fail on it and its sentences are those
/// of its scenes:
/// - errors are within 0..1e39, PSNRs within -1000..150 dB and those of their RMSE, alpha within (0, 1];
/// - a scene passes only where its PSNR against the twin reaches the floor and pixels are there and finite,
///   and fails only where one of that is not so or kinds of pixels differ; the file passes exactly where all
///   scenes do;
/// - a reference is resolved exactly where its own error is at most a tenth of the smaller error it judges;
/// - counts and means over the random scenes are those of the scenes listed;
/// - figures of another table are there only where there is another, and a scene is explained only where that
///   one is nearer;
/// - pictures are PNGs in base64 (RFC 4648, padded) that decode whole, sides of at most 4096 pixels, 64
/// million
///   pixels together.
/// Figures are compared within their rounding to 5 digits. Fields that are not known stay. Throws InputError
/// naming `name` and the field.
Json shadingFromJson(std::string_view text, const std::string& name);

}  // namespace ltcfit

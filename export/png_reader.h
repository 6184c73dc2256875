// libpng's reader, with errors that leave it cleanly.
#pragma once

#include <png.h>

#include <array>
#include <string_view>

namespace ltcfit {

struct PngInput {
  std::string_view rest;
  std::array<char, 256> message;  ///< why reading failed
};

/// Errors of libpng leave it by longjmp, which destructors do not survive: the functions that set the jump
/// have no object with one.
struct PngReader {
  /// `input` must outlive this. std::bad_alloc.
  explicit PngReader(PngInput& input);
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  png_structp png;
  png_infop info;
};

/// False with the input's message where the header is damaged.
bool readPngHeader(png_structp png, png_infop info);

/// After the header: RGBA, whatever the file has, of its 8 or 16 bits or of 8 always. `rows` of `stride`
/// bytes each. False with the input's message for damaged files.
bool readPngRows(png_structp png, png_infop info, png_bytepp rows, std::size_t stride,
                 bool only8Bits = false);

}  // namespace ltcfit

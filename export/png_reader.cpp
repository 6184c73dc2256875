#include "export/png_reader.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>

namespace ltcfit {
namespace {

[[noreturn]] void onError(png_structp png, const char* what) {
  PngInput& input = *static_cast<PngInput*>(png_get_error_ptr(png));
  std::snprintf(input.message.data(), input.message.size(), "%s", what);
  png_longjmp(png, 1);
}

void onRead(png_structp png, png_bytep out, std::size_t size) {
  PngInput& input = *static_cast<PngInput*>(png_get_io_ptr(png));
  if (size > input.rest.size()) png_error(png, "cut off");
  std::memcpy(out, input.rest.data(), size);
  input.rest.remove_prefix(size);
}

}  // namespace

PngReader::PngReader(PngInput& input)
    : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, onError, [](png_structp, const char*) {})),
      info(png != nullptr ? png_create_info_struct(png) : nullptr) {
  if (info == nullptr) {
    png_destroy_read_struct(&png, nullptr, nullptr);
    throw std::bad_alloc();
  }
  png_set_read_fn(png, &input, onRead);
}

bool readPngHeader(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  return true;
}

bool readPngRows(png_structp png, png_infop info, png_bytepp rows, std::size_t stride, bool only8Bits) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_expand(png);
  if (only8Bits) png_set_strip_16(png);
  png_set_gray_to_rgb(png);
  png_set_filler(png, 0xFFFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != stride) png_error(png, "rows of an unexpected length");
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

}  // namespace ltcfit

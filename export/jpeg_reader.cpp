#include "export/jpeg_reader.h"

// jpeglib.h needs both before it
#include <jerror.h>
#include <jpeglib.h>

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>

namespace ltcfit {

// Errors leave libjpeg by longjmp: the functions that set the jump have no object with a destructor.
struct JpegReader::State {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::string_view bytes;
  std::array<char, JMSG_LENGTH_MAX> message{};
  std::jmp_buf jump{};
};

namespace {

// Encoders write some ten. Each is a pass over the image, and takes but a few bytes.
constexpr int kMaxScans = 1000;

template <typename State>
[[noreturn]] void fail(State& state) {
  std::longjmp(state.jump, 1);
}

}  // namespace

JpegReader::JpegReader(std::string_view bytes) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.bytes = bytes;
  s.jpeg.err = jpeg_std_error(&s.errors);
  s.jpeg.client_data = &s;
  s.errors.error_exit = [](j_common_ptr jpeg) {
    State& state = *static_cast<State*>(jpeg->client_data);
    (*jpeg->err->format_message)(jpeg, state.message.data());
    fail(state);
  };
  // warnings: what is missing would be made up
  s.errors.emit_message = [](j_common_ptr jpeg, int level) {
    if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) (*jpeg->err->error_exit)(jpeg);
  };
  s.progress.progress_monitor = [](j_common_ptr jpeg) {
    State& state = *static_cast<State*>(jpeg->client_data);
    if (state.jpeg.input_scan_number <= kMaxScans) return;
    std::snprintf(state.message.data(), state.message.size(), "more than %d scans", kMaxScans);
    fail(state);
  };
}

JpegReader::~JpegReader() {
  jpeg_destroy_decompress(&state_->jpeg);
}

bool JpegReader::readHeader() {
  State& s = *state_;
  if (setjmp(s.jump) != 0) return false;
  jpeg_create_decompress(&s.jpeg);
  s.jpeg.progress = &s.progress;
  jpeg_mem_src(&s.jpeg, reinterpret_cast<const unsigned char*>(s.bytes.data()), s.bytes.size());
  jpeg_read_header(&s.jpeg, TRUE);
  s.jpeg.out_color_space = JCS_EXT_RGBA;
  // to the last bit the same on every processor
  s.jpeg.dct_method = JDCT_ISLOW;
  return true;
}

std::size_t JpegReader::width() const {
  return state_->jpeg.image_width;
}

std::size_t JpegReader::height() const {
  return state_->jpeg.image_height;
}

bool JpegReader::readRows(std::uint8_t* out) {
  State& s = *state_;
  if (setjmp(s.jump) != 0) return false;
  jpeg_start_decompress(&s.jpeg);
  while (s.jpeg.output_scanline < s.jpeg.output_height) {
    JSAMPROW row = out + 4 * std::size_t{s.jpeg.image_width} * s.jpeg.output_scanline;
    jpeg_read_scanlines(&s.jpeg, &row, 1);
  }
  jpeg_finish_decompress(&s.jpeg);
  return true;
}

std::string JpegReader::message() const {
  return state_->message.data();
}

}  // namespace ltcfit

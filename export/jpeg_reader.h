// libjpeg's reader, with errors that leave it cleanly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace ltcfit {

/// The most pixels that a byte of a file can stand for: 8 x 8 by one bit of a progressive scan, at least two
/// scans.
inline constexpr std::size_t kJpegPixelsPerByte = 256;

/// Reads one JPEG of 8 bits, grey or colour, baseline or progressive.
class JpegReader {
 public:
  /// `bytes` must outlive this.
  explicit JpegReader(std::string_view bytes);
  ~JpegReader();
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  /// False with a message for what is damaged, or neither grey nor RGB nor YCbCr.
  bool readHeader();
  std::size_t width() const;
  std::size_t height() const;
  /// After the header, once: RGBA into 4 width height bytes at `out`. False with a message for damaged files,
  /// which includes those that are cut off, and for more than 1000 scans.
  bool readRows(std::uint8_t* out);
  std::string message() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ltcfit

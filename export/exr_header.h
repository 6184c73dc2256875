// What both readers and writers of EXR need: streams in memory, and a look at a header before OpenEXR sees
// it.
#pragma once

#include <ImfHeader.h>
#include <ImfIO.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ltcfit {

inline constexpr std::string_view kExrMagic("\x76\x2F\x31\x01", 4);
inline constexpr int kMaxExrSide = 16384;

class ExrOutput : public OPENEXR_IMF_NAMESPACE::OStream {
 public:
  ExrOutput() : OStream("memory") {}
  void write(const char* bytes, int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (bytes_.size() < at_ + n) bytes_.resize(at_ + n);
    std::memcpy(bytes_.data() + at_, bytes, n);
    at_ += n;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class ExrInput : public OPENEXR_IMF_NAMESPACE::IStream {
 public:
  explicit ExrInput(std::string_view bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char* out, int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (count < 0 || at_ > bytes_.size() || n > bytes_.size() - at_) throw std::runtime_error("cut off");
    std::memcpy(out, bytes_.data() + at_, n);
    at_ += n;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

enum class ExrKind {
  kTable,
  kPicture,
  kMips,  ///< tiles of mip maps, sizes rounded down
};

/// Names and values of a header's attributes of type string.
std::vector<std::pair<std::string, std::string>> exrTexts(const OPENEXR_IMF_NAMESPACE::Header& header);

/// Throws InputError: `name`, "EXR" and what is wrong.
[[noreturn]] void refuseExr(const std::string& name, const std::string& what);

/// Refuses what is not a single-part file of that kind (tables and pictures: scan lines) with lossless
/// compression and channels of halves and floats at every pixel, and whatever would have OpenEXR allocate
/// more than the file's length can hold. A picture may be of a lossy compression; it must have channels R, G
/// and B or grey Y, beside which other channels may be of any type, up to kMaxPictureSide pixels a side, and
/// as data window its display window.
void checkExrHeader(std::string_view bytes, const std::string& name, ExrKind kind);

}  // namespace ltcfit

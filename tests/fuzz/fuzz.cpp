// libFuzzer targets of the readers, one program for each LTCFIT_FUZZ_*: whatever the bytes are, a reader
// gives what its header says or an InputError.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "export/atomic_file.h"
#include "export/chebyshev_file.h"
#include "export/dds.h"
#include "export/exr.h"
#include "export/json_table.h"
#include "export/ktx2.h"
#include "export/mip_chain.h"
#include "export/npy.h"
#include "export/published_table.h"
#include "export/source_table.h"
#include "export/texture_files.h"
#include "export/texture_metadata.h"

namespace ltcfit {
namespace {

// What every reader promises of an image.
[[maybe_unused]] void check(const Image& image) {
  if (image.values.size() != image.texels() * image.components || image.values.empty()) std::abort();
}

// Calls a reader; whatever leaves it that is no InputError ends the program.
template <typename Reader>
void attempt(const Reader& reader) {
  try {
    reader();
  } catch (const InputError&) {
  }
}

void read(std::string_view bytes) {
#if defined(LTCFIT_FUZZ_NPY)
  attempt([&] {
    const FloatArray array = parseNpy(bytes, "T");
    std::size_t count = 1;
    for (std::size_t n : array.shape) count *= n;
    if (count != array.values.size()) std::abort();
    tableFrom2022(array, "T");
  });
#elif defined(LTCFIT_FUZZ_DDS)
  attempt([&] {
    const Image image = parseDds(bytes, "T");
    check(image);
    tableFrom2017(image, nullptr, "T");
  });
  attempt([&] {
    if (!isMipChain(parseDdsMips(bytes, "T"))) std::abort();
  });
#elif defined(LTCFIT_FUZZ_KTX2)
  attempt([&] {
    const Ktx2File file = parseKtx2(bytes, "T");
    check(file.image);
    for (const auto& [key, value] : file.keyValues)
      if (key == kMetadataKey)
        tableFromPacked(packedFromStack(packedFromMetadata(value, "T"), file.image, "T"), "T");
  });
#elif defined(LTCFIT_FUZZ_EXR)
  attempt([&] {
    const ExrFile file = parseExr(bytes, "T");
    if (file.names.empty() || file.names.size() != file.channels.size()) std::abort();
    for (const auto& channel : file.channels)
      if (channel.size() != file.width * file.height) std::abort();
  });
  attempt([&] { tableFromPacked(packedFromExr(bytes, "T"), "T"); });
  // DWA may be 66048 times as long as its file: within run.sh's limit of an allocation
  constexpr std::size_t kMaxPicture = 1024;
  if (bytes.size() > kMaxPicture) return;
  attempt([&] {
    const ExrFile file = parseExrPicture(bytes, "T");
    if (file.channels.size() != 3 && file.channels.size() != 1) std::abort();
    for (const auto& channel : file.channels)
      if (channel.size() != file.width * file.height) std::abort();
  });
#else
  attempt([&] { tableFromJson(bytes, "T"); });
  attempt([&] { tableFromSource(bytes, "T"); });
  attempt([&] { checkChebyshev(chebyshevFromJson(bytes, "T")); });
  // as many numbers as a 4 x 4 table has
  attempt([&] {
    tableFromPacked(packedFromNumbers(packedFromMetadata(bytes, "T"), std::vector<float>(128, 0.5f), "T"),
                    "T");
  });
#endif
}

}  // namespace
}  // namespace ltcfit

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ltcfit::read({reinterpret_cast<const char*>(data), size});
  return 0;
}

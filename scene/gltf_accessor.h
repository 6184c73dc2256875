// The numbers that glTF accessors describe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf_file.h"

namespace ltcfit {

/// Elements of all accessors that one file may have read, those read twice twice: beyond it a small file
/// would keep the program busy for long.
inline constexpr std::size_t kMaxGltfElements = std::size_t{1} << 28;

/// Reads accessors, sparse ones and those without a buffer view (zeros) included, of every component type.
/// All functions throw InputError with `where`, which names the user of the accessor, and its number, for an
/// accessor that does not exist, has another type, or whose elements overlap, lie outside its buffer view or
/// off the multiples of their numbers' size.
class GltfAccessors {
 public:
  /// `file` must outlive this.
  explicit GltfAccessors(const GltfFile& file) : file_(file) {}

  /// False if its data is compressed in a way that is not read.
  bool readable(int accessor, const std::string& where) const;
  /// How many elements it says that it has, before any is looked at.
  std::size_t count(int accessor, const std::string& where) const;
  /// The elements one after another, `components` numbers each; normalized integers as 0..1 or -1..1.
  std::vector<float> vectors(int accessor, std::size_t components, const std::string& where);
  std::vector<std::uint32_t> indices(int accessor, const std::string& where);

 private:
  const tinygltf::Accessor& get(int accessor, const std::string& where) const;
  template <typename T, typename Read>
  std::vector<T> read(const tinygltf::Accessor& accessor, std::size_t components, bool spaced,
                      const std::string& where, const Read& number);

  const GltfFile& file_;
  std::size_t elements_ = 0;
};

}  // namespace ltcfit

#include "scene/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "export/atomic_file.h"

namespace ltcfit {
namespace {

template <typename T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

// The scales of normalized integers; the most negative one counts as -1.
template <typename T>
double integer(const char* at, bool normalized) {
  const double value = static_cast<double>(load<T>(at));
  return normalized ? std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0) : value;
}

double number(const char* at, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return integer<std::int8_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return integer<std::uint8_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return integer<std::int16_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return integer<std::uint16_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_INT:
      return integer<std::int32_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return integer<std::uint32_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return static_cast<double>(load<float>(at));
    default:
      return load<double>(at);
  }
}

std::size_t sizeOf(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_DOUBLE:
      return 8;
    default:
      return 4;
  }
}

bool isIndexType(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// Where elements lie, after the check that all of them lie within the view.
struct Span {
  const char* first = nullptr;
  std::size_t stride = 0;
};

Span span(const GltfFile& file, int view, std::size_t offset, std::size_t size, std::size_t count,
          const std::string& where) {
  if (view < 0 || static_cast<std::size_t>(view) >= file.model.bufferViews.size())
    throw InputError(fmt::format("{}: buffer view {} of {}", where, view, file.model.bufferViews.size()));
  const std::string_view bytes = viewBytes(file, view);
  const std::size_t given = file.model.bufferViews[static_cast<std::size_t>(view)].byteStride;
  const std::size_t stride = given == 0 ? size : given;
  if (count == 0) return {bytes.data(), stride};
  if (offset > bytes.size() || size > bytes.size() - offset ||
      (count - 1) > (bytes.size() - offset - size) / stride)
    throw InputError(
        fmt::format("{}: {} elements, {} bytes apart from byte {} on, do not fit the {} of buffer view {}",
                    where, count, stride, offset, bytes.size(), view));
  return {bytes.data() + offset, stride};
}

}  // namespace

const tinygltf::Accessor& GltfAccessors::get(int accessor, const std::string& where) const {
  const auto& all = file_.model.accessors;
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= all.size())
    throw InputError(fmt::format("{}: accessor {} of {}", where, accessor, all.size()));
  return all[static_cast<std::size_t>(accessor)];
}

bool GltfAccessors::readable(int accessor, const std::string& where) const {
  const int view = get(accessor, where).bufferView;
  const auto& views = file_.model.bufferViews;
  return view < 0 || static_cast<std::size_t>(view) >= views.size() ||
         !isMeshoptCompressed(views[static_cast<std::size_t>(view)]);
}

template <typename T, typename Read>
std::vector<T> GltfAccessors::read(const tinygltf::Accessor& accessor, std::size_t components,
                                   const std::string& where, const Read& element) {
  const std::size_t part = sizeOf(accessor.componentType);
  const std::size_t size = components * part;
  if (accessor.count > kMaxGltfElements - elements_)
    throw InputError(fmt::format("{}: more than {} elements of accessors in all", where, kMaxGltfElements));
  elements_ += accessor.count;
  // a file's own length bounds all but these
  constexpr std::size_t kMostZeros = std::size_t{1} << 22;
  if (accessor.bufferView < 0 && accessor.count > kMostZeros)
    throw InputError(
        fmt::format("{}: {} elements without data; up to {} are read", where, accessor.count, kMostZeros));
  std::vector<T> out;
  const auto copy = [&](const char* from, std::size_t to) {
    for (std::size_t c = 0; c < components; ++c) out[to * components + c] = element(from + c * part);
  };
  if (accessor.bufferView < 0) {
    out.resize(accessor.count * components);
  } else {
    const Span data = span(file_, accessor.bufferView, accessor.byteOffset, size, accessor.count, where);
    out.resize(accessor.count * components);
    for (std::size_t i = 0; i < accessor.count; ++i) copy(data.first + i * data.stride, i);
  }
  if (!accessor.sparse.isSparse) return out;
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count ||
      !isIndexType(sparse.indices.componentType) || sparse.indices.byteOffset < 0 ||
      sparse.values.byteOffset < 0)
    throw InputError(where + ": a sparse accessor with impossible numbers");
  const std::size_t count = static_cast<std::size_t>(sparse.count);
  const Span at = span(file_, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                       sizeOf(sparse.indices.componentType), count, where);
  const Span values = span(file_, sparse.values.bufferView,
                           static_cast<std::size_t>(sparse.values.byteOffset), size, count, where);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index =
        static_cast<std::size_t>(number(at.first + i * at.stride, sparse.indices.componentType, false));
    if (index >= accessor.count)
      throw InputError(fmt::format("{}: sparse element {} of {}", where, index, accessor.count));
    copy(values.first + i * values.stride, index);
  }
  return out;
}

std::vector<float> GltfAccessors::vectors(int index, std::size_t components, const std::string& where) {
  const tinygltf::Accessor& accessor = get(index, where);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) !=
          static_cast<std::int32_t>(components) ||
      accessor.type == TINYGLTF_TYPE_MAT2)
    throw InputError(fmt::format("{}: accessor {} does not have {} components", where, index, components));
  const int type = accessor.componentType;
  const bool normalized = accessor.normalized;
  return read<float>(accessor, components, where,
                     [=](const char* at) { return static_cast<float>(number(at, type, normalized)); });
}

std::vector<std::uint32_t> GltfAccessors::indices(int index, const std::string& where) {
  const tinygltf::Accessor& accessor = get(index, where);
  const int type = accessor.componentType;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !isIndexType(type))
    throw InputError(fmt::format("{}: accessor {} does not hold indices", where, index));
  return read<std::uint32_t>(accessor, 1, where, [type](const char* at) {
    return static_cast<std::uint32_t>(number(at, type, false));
  });
}

}  // namespace ltcfit

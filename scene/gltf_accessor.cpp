#include "scene/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "export/atomic_file.h"
#include "scene/gltf_component.h"

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
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return integer<std::uint32_t>(at, normalized);
    default:  // componentOf knows no other
      return static_cast<double>(load<float>(at));
  }
}

const GltfComponent& componentOf(int type) {
  const auto found = std::find_if(kGltfComponents.begin(), kGltfComponents.end(),
                                  [type](const GltfComponent& component) { return component.type == type; });
  // parseGltf lets no other pass
  if (found == kGltfComponents.end()) throw std::logic_error(fmt::format("component type {}", type));
  return *found;
}

bool isIndexType(int type) {
  return componentOf(type).index;
}

// Elements in a buffer view.
struct Elements {
  int view = -1;
  std::size_t offset = 0;
  std::size_t component = 1;  // bytes of each number
  std::size_t size = 1;       // bytes of all numbers
  std::size_t count = 0;
  bool spaced = false;  // may be apart: attributes of vertices alone
};

// Where elements lie, after the checks that all of them lie within the view, where glTF lets them lie.
struct Span {
  const char* first = nullptr;
  std::size_t stride = 0;
};

Span span(const GltfFile& file, const Elements& e, const std::string& where) {
  if (e.view < 0 || static_cast<std::size_t>(e.view) >= file.model.bufferViews.size())
    throw InputError(fmt::format("{}: buffer view {} of {}", where, e.view, file.model.bufferViews.size()));
  const std::string_view bytes = viewBytes(file, e.view);
  const tinygltf::BufferView& view = file.model.bufferViews[static_cast<std::size_t>(e.view)];
  if (view.byteStride != 0 && view.byteStride < e.size)
    throw InputError(fmt::format("{}: elements of {} bytes overlap in buffer view {}, whose byteStride is {}",
                                 where, e.size, e.view, view.byteStride));
  if (view.byteStride > e.size && !e.spaced)
    throw InputError(
        fmt::format("{}: buffer view {} has a byteStride ({}), which is for attributes of "
                    "vertices alone",
                    where, e.view, view.byteStride));
  const std::size_t stride = view.byteStride == 0 ? e.size : view.byteStride;
  if (e.count == 0) return {bytes.data(), stride};
  if (e.offset > bytes.size() || e.size > bytes.size() - e.offset ||
      (e.count - 1) > (bytes.size() - e.offset - e.size) / stride)
    throw InputError(
        fmt::format("{}: {} elements, {} bytes apart from byte {} on, do not fit the {} of buffer view {}",
                    where, e.count, stride, e.offset, bytes.size(), e.view));
  if (e.offset % e.component != 0 || (e.offset + view.byteOffset) % e.component != 0)
    throw InputError(
        fmt::format("{}: byteOffset {}, in a buffer view from byte {} on, is not a multiple of the {} bytes "
                    "of a number",
                    where, e.offset, view.byteOffset, e.component));
  return {bytes.data() + e.offset, stride};
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
std::vector<T> GltfAccessors::read(const tinygltf::Accessor& accessor, std::size_t components, bool spaced,
                                   const std::string& where, const Read& element) {
  const std::size_t part = componentOf(accessor.componentType).size;
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
    const Span data =
        span(file_, {accessor.bufferView, accessor.byteOffset, part, size, accessor.count, spaced}, where);
    out.resize(accessor.count * components);
    for (std::size_t i = 0; i < accessor.count; ++i) copy(data.first + i * data.stride, i);
  }
  if (!accessor.sparse.isSparse) return out;
  const auto& sparse = accessor.sparse;
  if (static_cast<std::size_t>(sparse.count) > accessor.count)
    throw InputError(fmt::format("{}: sparse: {} of {} elements", where, sparse.count, accessor.count));
  const auto count = static_cast<std::size_t>(sparse.count);
  const std::size_t indexSize = componentOf(sparse.indices.componentType).size;
  const Span at = span(file_,
                       {sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                        indexSize, indexSize, count},
                       where + ": sparse.indices");
  const Span values =
      span(file_,
           {sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), part, size, count},
           where + ": sparse.values");
  for (std::size_t i = 0; i < count; ++i) {
    const auto index =
        static_cast<std::size_t>(number(at.first + i * at.stride, sparse.indices.componentType, false));
    if (index >= accessor.count)
      throw InputError(fmt::format("{}: sparse element {} of {}", where, index, accessor.count));
    copy(values.first + i * values.stride, index);
  }
  return out;
}

std::size_t GltfAccessors::count(int accessor, const std::string& where) const {
  return get(accessor, where).count;
}

std::vector<float> GltfAccessors::vectors(int index, std::size_t components, const std::string& where) {
  const tinygltf::Accessor& accessor = get(index, where);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) !=
          static_cast<std::int32_t>(components) ||
      accessor.type == TINYGLTF_TYPE_MAT2)
    throw InputError(fmt::format("{}: accessor {} does not have {} components", where, index, components));
  const int type = accessor.componentType;
  const bool normalized = accessor.normalized;
  return read<float>(accessor, components, true, fmt::format("{}: accessor {}", where, index),
                     [=](const char* at) { return static_cast<float>(number(at, type, normalized)); });
}

std::vector<std::uint32_t> GltfAccessors::indices(int index, const std::string& where) {
  const tinygltf::Accessor& accessor = get(index, where);
  const int type = accessor.componentType;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !isIndexType(type))
    throw InputError(fmt::format("{}: accessor {} does not hold indices", where, index));
  return read<std::uint32_t>(
      accessor, 1, false, fmt::format("{}: accessor {}", where, index),
      [type](const char* at) { return static_cast<std::uint32_t>(number(at, type, false)); });
}

}  // namespace ltcfit

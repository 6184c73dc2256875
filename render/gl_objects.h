// OpenGL objects that delete themselves, made for a renderer without blending and depth.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "export/image.h"
#include "render/prefilter.h"

namespace ltcfit {

/// Name of an object of the current context, which must be current again when it is destroyed.
class GlObject {
 public:
  GlObject() = default;
  GlObject(unsigned id, void (*destroy)(unsigned)) : id_(id), destroy_(destroy) {}
  GlObject(GlObject&& other) noexcept
      : id_(std::exchange(other.id_, 0)), destroy_(std::exchange(other.destroy_, nullptr)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(destroy_, other.destroy_);
    return *this;
  }
  GlObject(const GlObject&) = delete;
  GlObject& operator=(const GlObject&) = delete;
  ~GlObject() {
    if (destroy_ != nullptr) destroy_(id_);
  }

  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
  void (*destroy_)(unsigned) = nullptr;
};

/// Throws GlError naming the error and `what` if OpenGL reports one since it was last asked.
void checkGl(std::string_view what);

/// A program of a vertex and a fragment shader, each the concatenation of its texts. Throws GlError with the
/// log, in which "n:line" counts the texts from 0, and `name`.
GlObject makeProgram(std::span<const std::string_view> vertex, std::span<const std::string_view> fragment,
                     std::string_view name);

/// A 2D texture, or a 3D one where the image has a depth: 1, 2 or 4 components in the image's precision,
/// linear filtering, clamped to the edge, one level. Throws GlError where the context cannot filter such
/// textures.
GlObject makeTexture(const Image& image);

/// A light's texture as ltc_textured.glsl reads it: RGBA32F, all levels, trilinear, clamped to the edge.
GlObject makeTexture(const PrefilteredTexture& light);

GlObject makeVertexArray();

/// An RGBA32F picture to draw into.
struct GlTarget {
  std::size_t width = 0;
  std::size_t height = 0;
  GlObject colour;
  GlObject framebuffer;
};
/// Throws GlError where the context cannot draw into float pictures or not of that size.
GlTarget makeTarget(std::size_t width, std::size_t height);

}  // namespace ltcfit

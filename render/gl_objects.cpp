#include "render/gl_objects.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include "export/little_endian.h"
#include "render/gl_context.h"

namespace ltcfit {
namespace {

std::string errorName(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    default:
      return fmt::format("OpenGL error 0x{:x}", error);
  }
}

GlObject compile(GLenum stage, std::span<const std::string_view> texts, std::string_view name) {
  GlObject shader(glCreateShader(stage), [](unsigned id) { glDeleteShader(id); });
  std::vector<const GLchar*> begins;
  std::vector<GLint> lengths;
  for (const std::string_view text : texts) {
    begins.push_back(text.data());
    lengths.push_back(static_cast<GLint>(text.size()));
  }
  glShaderSource(shader.id(), static_cast<GLsizei>(texts.size()), begins.data(), lengths.data());
  glCompileShader(shader.id());
  GLint good = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &good);
  if (good == GL_TRUE) return shader;
  std::array<GLchar, 4096> log{};
  glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw GlError(fmt::format("OpenGL: {} does not compile: {}", name, log.data()));
}

void requireFloatFilter() {
  if (epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_OES_texture_float_linear")) return;
  throw GlError(
      "OpenGL: this OpenGL ES does not filter float textures (no GL_OES_texture_float_linear); export the "
      "table with --precision half");
}

// A new texture, bound, clamped to the edge.
GlObject boundTexture(GLenum target, GLint minify) {
  GLuint id = 0;
  glGenTextures(1, &id);
  GlObject texture(id, [](unsigned name) { glDeleteTextures(1, &name); });
  glBindTexture(target, id);
  for (const auto axis :
       std::initializer_list<GLenum>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(target, axis, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, minify);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  return texture;
}

}  // namespace

void checkGl(std::string_view what) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  // drivers may hold one error for each of their parts; a lost context reports errors without end
  for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) continue;
  throw GlError(fmt::format("OpenGL: {}: {}", what, errorName(error)));
}

GlObject makeProgram(std::span<const std::string_view> vertex, std::span<const std::string_view> fragment,
                     std::string_view name) {
  const GlObject first = compile(GL_VERTEX_SHADER, vertex, fmt::format("{} (vertices)", name));
  const GlObject second = compile(GL_FRAGMENT_SHADER, fragment, name);
  GlObject program(glCreateProgram(), [](unsigned id) { glDeleteProgram(id); });
  glAttachShader(program.id(), first.id());
  glAttachShader(program.id(), second.id());
  glLinkProgram(program.id());
  GLint good = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &good);
  if (good == GL_TRUE) {
    checkGl(name);
    return program;
  }
  std::array<GLchar, 4096> log{};
  glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw GlError(fmt::format("OpenGL: {} does not link: {}", name, log.data()));
}

GlObject makeTexture(const Image& image) {
  const bool half = image.precision == Precision::kHalf;
  if (!half) requireFloatFilter();
  const GLenum target = image.depth > 1 ? GL_TEXTURE_3D : GL_TEXTURE_2D;
  GlObject texture = boundTexture(target, GL_LINEAR);
  GLint format = half ? GL_RGBA16F : GL_RGBA32F;
  GLenum order = GL_RGBA;
  if (image.components == 2) {
    format = half ? GL_RG16F : GL_RG32F;
    order = GL_RG;
  } else if (image.components == 1) {
    format = half ? GL_R16F : GL_R32F;
    order = GL_RED;
  }
  // the halves themselves: what a driver makes of floats that are given for halves is its own
  const GLenum type = half ? GL_HALF_FLOAT : GL_FLOAT;
  std::string bytes;
  appendValues(bytes, image.values, image.precision);
  const auto width = static_cast<GLsizei>(image.width);
  const auto height = static_cast<GLsizei>(image.height);
  const auto depth = static_cast<GLsizei>(image.depth);
  if (target == GL_TEXTURE_3D) {
    glTexImage3D(target, 0, format, width, height, depth, 0, order, type, bytes.data());
  } else {
    glTexImage2D(target, 0, format, width, height, 0, order, type, bytes.data());
  }
  checkGl(fmt::format("a texture of {} x {} x {}", width, height, depth));
  return texture;
}

GlObject makeTexture(const PrefilteredTexture& light) {
  requireFloatFilter();
  GlObject texture = boundTexture(GL_TEXTURE_2D, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(light.levels.size()) - 1);
  for (std::size_t l = 0; l < light.levels.size(); ++l) {
    const PrefilteredLevel& level = light.levels[l];
    std::vector<float> values;
    values.reserve(level.texels.size() * 4);
    for (const Eigen::Vector3d& texel : level.texels) {
      const Eigen::Vector3f t = texel.cast<float>();
      values.insert(values.end(), {t.x(), t.y(), t.z(), 1.0f});
    }
    const auto size = static_cast<GLsizei>(level.size);
    glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(l), GL_RGBA32F, size, size, 0, GL_RGBA, GL_FLOAT,
                 values.data());
    checkGl(fmt::format("level {} of a light's texture, {} x {}", l, size, size));
  }
  return texture;
}

GlObject makeVertexArray() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  return {id, [](unsigned name) { glDeleteVertexArrays(1, &name); }};
}

GlTarget makeTarget(std::size_t width, std::size_t height) {
  GlTarget target;
  target.width = width;
  target.height = height;
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  target.colour = GlObject(id, [](unsigned name) { glDeleteRenderbuffers(1, &name); });
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, static_cast<GLsizei>(width),
                        static_cast<GLsizei>(height));
  const std::string what = fmt::format("a float picture of {} x {}", width, height);
  checkGl(what);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  target.framebuffer = GlObject(framebuffer, [](unsigned name) { glDeleteFramebuffers(1, &name); });
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, id);
  if (const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE)
    throw GlError(fmt::format("OpenGL: cannot draw into {} (framebuffer status 0x{:x})", what, status));
  checkGl(what);
  return target;
}

}  // namespace ltcfit

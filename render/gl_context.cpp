#include "render/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace ltcfit {
namespace {

constexpr const char* kInstall = "install an OpenGL driver (Debian: libegl1 libgl1 libgl1-mesa-dri)";

// epoxy, which looks functions up in these, aborts the process where it does not find them. What it opens
// later is this very library: it stays open.
bool isLibraryThere(const char* name) {
  return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

std::string eglErrorName(EGLint error) {
  constexpr std::array<std::pair<EGLint, std::string_view>, 15> kNames{
      {{EGL_SUCCESS, "no error"},
       {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
       {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
       {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
       {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
       {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
       {EGL_BAD_CONTEXT, "EGL_BAD_CONTEXT"},
       {EGL_BAD_CURRENT_SURFACE, "EGL_BAD_CURRENT_SURFACE"},
       {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
       {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
       {EGL_BAD_NATIVE_PIXMAP, "EGL_BAD_NATIVE_PIXMAP"},
       {EGL_BAD_NATIVE_WINDOW, "EGL_BAD_NATIVE_WINDOW"},
       {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"},
       {EGL_BAD_SURFACE, "EGL_BAD_SURFACE"},
       {EGL_CONTEXT_LOST, "EGL_CONTEXT_LOST"}}};
  for (const auto& [code, name] : kNames) {
    if (code == error) return std::string(name);
  }
  return fmt::format("EGL error 0x{:x}", error);
}

std::string failed(const char* call) {
  return fmt::format("{}: {}", call, eglErrorName(eglGetError()));
}

// `list` as EGL returns them: separated by blanks, or null with an error set.
bool lists(const char* list, std::string_view extension) {
  if (list == nullptr) {
    eglGetError();
    return false;
  }
  return fmt::format(" {} ", list).find(fmt::format(" {} ", extension)) != std::string::npos;
}

bool hasExtension(EGLDisplay display, std::string_view name) {
  return lists(eglQueryString(display, EGL_EXTENSIONS), name);
}

struct Device {
  std::string name;
  EGLDeviceEXT device;
  bool hardware;  // known to be
};

std::vector<Device> eglDevices() {
  const bool base = hasExtension(EGL_NO_DISPLAY, "EGL_EXT_device_base");
  if (!hasExtension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
      !(base || hasExtension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")))
    return {};
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_FALSE) {
    eglGetError();
    return {};
  }
  const bool canTell = base || hasExtension(EGL_NO_DISPLAY, "EGL_EXT_device_query");
  std::vector<Device> out;
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
    const char* const list = canTell ? eglQueryDeviceStringEXT(device, EGL_EXTENSIONS) : nullptr;
    const bool hardware = list != nullptr && !lists(list, "EGL_MESA_device_software");
    out.push_back({fmt::format("device {}", i), device, hardware});
  }
  return out;
}

struct DisplayChoice {
  std::string name;
  EGLDisplay display;
};

// In the order in which they are tried; `tried` says why one could not be asked for. Mesa's surfaceless
// platform knows Mesa's drivers alone: where the GPU has another one, that gives a software renderer.
std::vector<DisplayChoice> displayChoices(std::string& tried) {
  std::vector<DisplayChoice> choices;
  const auto add = [&](const std::string& name, EGLDisplay display, const char* call) {
    if (display == EGL_NO_DISPLAY) {
      tried += fmt::format("; {}: {}", name, failed(call));
    } else {
      choices.push_back({name, display});
    }
  };
  if (hasExtension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    const std::vector<Device> devices = eglDevices();
    const auto addDevices = [&](bool hardware) {
      for (const Device& d : devices) {
        if (d.hardware != hardware) continue;
        add(d.name, eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, d.device, nullptr),
            "eglGetPlatformDisplayEXT");
      }
    };
    addDevices(true);
    if (hasExtension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
      add("surfaceless platform",
          eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
          "eglGetPlatformDisplayEXT");
    }
    addDevices(false);
  }
  add("default display", eglGetDisplay(EGL_DEFAULT_DISPLAY), "eglGetDisplay");
  return choices;
}

// One way of asking for a context.
struct Api {
  const char* name;
  EGLenum api;
  EGLint renderable;
  std::vector<EGLint> context;
};

std::vector<Api> apis() {
  std::vector<Api> out;
  if (isLibraryThere("libOpenGL.so.0") || isLibraryThere("libGL.so.1")) {
    out.push_back({"OpenGL 3.3",
                   EGL_OPENGL_API,
                   EGL_OPENGL_BIT,
                   {EGL_CONTEXT_MAJOR_VERSION_KHR, 3, EGL_CONTEXT_MINOR_VERSION_KHR, 3,
                    EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR, EGL_NONE}});
  }
  if (isLibraryThere("libGLESv2.so.2"))
    out.push_back({"OpenGL ES 3.0",
                   EGL_OPENGL_ES_API,
                   EGL_OPENGL_ES3_BIT_KHR,
                   {EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE}});
  return out;
}

}  // namespace

GlContext::GlContext() {
  if (!isLibraryThere("libEGL.so.1"))
    throw GlError(fmt::format("OpenGL: libEGL.so.1 is not on this machine; {}", kInstall));
  if (apis().empty()) {
    throw GlError(fmt::format(
        "OpenGL: none of libOpenGL.so.0, libGL.so.1 and libGLESv2.so.2 is on this machine; {}", kInstall));
  }
  std::string tried;
  for (const DisplayChoice& choice : displayChoices(tried)) {
    const std::string failure = open(choice.display);
    if (failure.empty()) return;
    tried += fmt::format("; {}: {}", choice.name, failure);
  }
  throw GlError(fmt::format("OpenGL: no context without a window (tried {}); {}", tried.substr(2), kInstall));
}

// Empty, or what failed.
std::string GlContext::open(void* display) {
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return failed("eglInitialize");
  const bool surfaceless = hasExtension(display, "EGL_KHR_surfaceless_context");
  std::string tried;
  for (const Api& api : apis()) {
    const auto fail = [&](const char* call) {
      tried += fmt::format("{}{}: {}", tried.empty() ? "" : ", ", api.name, failed(call));
    };
    const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, surfaceless ? 0 : EGL_PBUFFER_BIT,
                                       EGL_RENDERABLE_TYPE, api.renderable, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglBindAPI(api.api) == EGL_FALSE) {
      fail("eglBindAPI");
    } else if (eglChooseConfig(display, wanted.data(), &config, 1, &count) == EGL_FALSE || count == 0) {
      fail("eglChooseConfig");
    } else if (EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, api.context.data());
               context == EGL_NO_CONTEXT) {
      fail("eglCreateContext");
    } else {
      constexpr std::array<EGLint, 5> kSize{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
      EGLSurface surface =
          surfaceless ? EGL_NO_SURFACE : eglCreatePbufferSurface(display, config, kSize.data());
      if (surfaceless || surface != EGL_NO_SURFACE) {
        if (eglMakeCurrent(display, surface, surface, context) == EGL_TRUE) {
          display_ = display;
          context_ = context;
          surface_ = surface;
          return {};
        }
        fail("eglMakeCurrent");
        if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
      } else {
        fail("eglCreatePbufferSurface");
      }
      eglDestroyContext(display, context);
    }
  }
  return tried;
}

// The display stays initialised: eglTerminate would end the other contexts on it.
GlContext::~GlContext() {
  if (eglGetCurrentContext() == context_)
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
  eglDestroyContext(display_, context_);
}

std::string glRendererName() {
  const auto text = [](GLenum name) {
    const GLubyte* const value = glGetString(name);
    return value == nullptr ? std::string("unknown") : std::string(reinterpret_cast<const char*>(value));
  };
  return fmt::format("{}, {}", text(GL_RENDERER), text(GL_VERSION));
}

}  // namespace ltcfit

// Whether tests that draw can run here.
#pragma once

#include <string>

#include "render/gl_context.h"

namespace ltcfit::test {

/// Why there is no context on this machine; empty where there is one.
inline std::string glUnavailable() {
  try {
    const GlContext context;
    return {};
  } catch (const GlError& error) {
    return error.what();
  }
}

}  // namespace ltcfit::test

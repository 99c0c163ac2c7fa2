#include "fsm/render/gl_functions.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "fsm/render/render_context.h"

namespace fsm {
namespace {

/// Tells whether the context's version, such as "4.5 (Core Profile) Mesa 22.3.6", is at least that.
bool IsAtLeast(const GlFunctions& gl, int major, int minor) {
  const auto* version = reinterpret_cast<const char*>(gl.GetString(GL_VERSION));
  int found_major = 0, found_minor = 0;
  return version != nullptr && std::sscanf(version, "%d.%d", &found_major, &found_minor) == 2 &&
         std::pair(found_major, found_minor) >= std::pair(major, minor);
}

template <typename Function>
void Fetch(RenderContext& context, const char* name, Function& function) {
  // POSIX guarantees that such a data pointer can be converted to a function pointer.
  function = reinterpret_cast<Function>(context.GetProcAddress(name));
  if (!function) {
    throw std::runtime_error(std::string("OpenGL 3.3 is needed, but this driver has no ") + name);
  }
}

}  // namespace

GlFunctions GlFunctions::Load(RenderContext& context) {
  GlFunctions gl;
#define FSM_GL_FETCH(type, name) Fetch(context, "gl" #name, gl.name);
  FSM_GL_FUNCTIONS(FSM_GL_FETCH)
  gl.has_compute = IsAtLeast(gl, 4, 3);
  if (gl.has_compute) {
    FSM_GL_COMPUTE_FUNCTIONS(FSM_GL_FETCH)
  }
#undef FSM_GL_FETCH
  return gl;
}

}  // namespace fsm

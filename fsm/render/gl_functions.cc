#include "fsm/render/gl_functions.h"

#include <stdexcept>
#include <string>

#include "fsm/render/renderer.h"

namespace fsm {
namespace {

template <typename Function>
void Fetch(RenderContext& context, const char* name, Function& function) {
  // POSIX promises that a data pointer from such a lookup may be turned into a function pointer.
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
#undef FSM_GL_FETCH
  return gl;
}

}  // namespace fsm

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/off_screen.h"

namespace fsm {
namespace {

using Make = std::function<std::unique_ptr<RenderContext>(int, int)>;

/// Returns the makers to make an off-screen context in the order in which they are tried, from left
/// to right; those that this program was built without are skipped.
///
/// | asked for | first                   | then                | last   |
/// | kOsMesa   | OSMesa                  | Mesa's EGL software |        |
/// | kEgl      | GPUs of EGL             | EGL without surface |        |
/// | kAny      | GPUs of EGL             | EGL without surface | OSMesa |
///
/// OSMesa is gone from Mesa 25.1 on; its software device draws the same pictures.
std::vector<Make> MakersFor(OffScreenDriver how) {
  [[maybe_unused]] const bool software = how == OffScreenDriver::kOsMesa;
  std::vector<Make> makers;
#ifdef FSM_WITH_OSMESA
  if (software) makers.emplace_back(MakeOsMesaContext);
#endif
#ifdef FSM_WITH_EGL
  makers.emplace_back(
      [software](int width, int height) { return MakeEglDeviceContext(width, height, software); });
  if (!software) makers.emplace_back(MakeEglSurfacelessContext);
#endif
#ifdef FSM_WITH_OSMESA
  if (how == OffScreenDriver::kAny) makers.emplace_back(MakeOsMesaContext);
#endif
  return makers;
}

}  // namespace

std::unique_ptr<RenderContext> RenderContext::MakeHeadless(int width, int height,
                                                           OffScreenDriver how) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    throw std::runtime_error("a picture must have 1 to " + std::to_string(kMaxImageSide) +
                             " pixels on each side");
  }
  std::string reasons;
  for (const Make& make : MakersFor(how)) {
    try {
      return make(width, height);
    } catch (const std::runtime_error& error) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  throw std::runtime_error(
      "cannot make an off-screen OpenGL 3.3 context: " +
      (reasons.empty() ? "this program was built without it (Debian's libegl-dev, libosmesa6-dev)"
                       : reasons));
}

std::string DescribeOffScreen(OffScreenDriver how) {
  try {
    const auto context = RenderContext::MakeHeadless(16, 16, how);
    const auto get_string =
        reinterpret_cast<PFNGLGETSTRINGPROC>(context->GetProcAddress("glGetString"));
    const auto text = [get_string](GLenum what) -> std::string {
      const auto* found = get_string ? get_string(what) : nullptr;
      return found ? reinterpret_cast<const char*>(found) : "unknown";
    };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION) + ", by " + context->description();
  } catch (const std::runtime_error& error) {
    return std::string("none: ") + error.what();
  }
}

}  // namespace fsm

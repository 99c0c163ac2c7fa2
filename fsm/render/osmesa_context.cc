#include <GL/osmesa.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "fsm/render/off_screen.h"

namespace fsm {
namespace {

/// Software OpenGL into memory. The renderer draws into framebuffer objects of its own; OSMesa
/// insists on memory to bind, and one pixel is enough.
class OsMesaContext : public OffScreenContext {
 public:
  OsMesaContext(int width, int height) : OffScreenContext(width, height) {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_STENCIL_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (!context_) {
      throw std::runtime_error("cannot make an off-screen OpenGL 3.3 context with OSMesa");
    }
  }
  ~OsMesaContext() override {
    auto* other = Leave();
    OSMesaDestroyContext(context_);
    Resume(other);
  }

  std::string reached_by() const override { return "OSMesa"; }
  void* GetProcAddress(const char* name) override {
    return reinterpret_cast<void*>(OSMesaGetProcAddress(name));
  }

 private:
  void Bind() override {
    if (!OSMesaMakeCurrent(context_, pixel_, GL_UNSIGNED_BYTE, 1, 1)) {
      throw std::runtime_error("OSMesa refused to draw into memory");
    }
  }
  void Release() override { OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0); }

  OSMesaContext context_ = nullptr;
  std::uint8_t pixel_[4] = {};
};

}  // namespace

std::unique_ptr<RenderContext> MakeOsMesaContext(int width, int height) {
  auto context = std::make_unique<OsMesaContext>(width, height);
  context->MakeCurrent();
  return context;
}

}  // namespace fsm

// OSMesa keeps a few kilobytes of its own until the process ends; the leak checker of a sanitized
// build is told so in every program that can hold such a context.
#if defined(__has_feature)
#define FSM_HAS_FEATURE(feature) __has_feature(feature)
#else
#define FSM_HAS_FEATURE(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || FSM_HAS_FEATURE(address_sanitizer)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\n"; }
#endif

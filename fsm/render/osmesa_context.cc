#include <GL/osmesa.h>
#include <dlfcn.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "fsm/render/off_screen.h"

namespace fsm {
namespace {

/// The functions of OSMesa. The library is loaded when a context is first made, and stays loaded:
/// it brings LLVM, which takes as long to load as a head takes to bake. The two run in parallel,
/// and programs that draw nothing do not load it.
class OsMesa {
 public:
  /// Throws std::runtime_error with the text of dlerror().
  OsMesa() {
    void* const library = dlopen("libOSMesa.so.8", RTLD_LAZY);
    const auto fetch = [library]<typename Function>(const char* name, Function& function) {
      if (library) function = reinterpret_cast<Function>(dlsym(library, name));
      if (!function) throw std::runtime_error(dlerror());
    };
    fetch("OSMesaCreateContextAttribs", create);
    fetch("OSMesaMakeCurrent", make_current);
    fetch("OSMesaDestroyContext", destroy);
    fetch("OSMesaGetProcAddress", get_proc_address);
  }

  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaGetProcAddress) get_proc_address = nullptr;
};

/// Software OpenGL to memory. The renderer draws into its own framebuffer objects, but OSMesa
/// requires memory to bind; one pixel is enough.
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
    context_ = mesa_.create(attributes, nullptr);
    if (!context_) {
      throw std::runtime_error("cannot make an off-screen OpenGL 3.3 context with OSMesa");
    }
  }
  ~OsMesaContext() override {
    auto* other = Leave();
    mesa_.destroy(context_);
    Resume(other);
  }

  std::string description() const override { return "OSMesa"; }
  void* GetProcAddress(const char* name) override {
    return reinterpret_cast<void*>(mesa_.get_proc_address(name));
  }

 private:
  void Bind() override {
    if (!mesa_.make_current(context_, pixel_, GL_UNSIGNED_BYTE, 1, 1)) {
      throw std::runtime_error("OSMesa refused to draw into memory");
    }
  }
  void Release() override { mesa_.make_current(nullptr, nullptr, 0, 0, 0); }

  const OsMesa mesa_;
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

// OSMesa keeps a few kilobytes until the process ends. This tells the leak checker of a sanitized
// build, in every program that may hold such a context.
#if defined(__has_feature)
#define FSM_HAS_FEATURE(feature) __has_feature(feature)
#else
#define FSM_HAS_FEATURE(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || FSM_HAS_FEATURE(address_sanitizer)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\n"; }
#endif

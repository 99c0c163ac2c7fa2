#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <stdexcept>
#include <string>

#include "fsm/render/context_switch.h"

namespace fsm {
namespace {

[[noreturn]] void Refuse(const std::string& what) {
  throw std::runtime_error("cannot make an off-screen OpenGL 3.3 context with EGL: " + what);
}

/// The surfaceless display of Mesa, shared by all contexts; the last one out closes it.
class Display {
 public:
  Display() {
    if (users_++ > 0) return;
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) {
      users_ = 0;
      Refuse("there is no display of the kind EGL_MESA_platform_surfaceless");
    }
  }
  ~Display() {
    if (--users_ == 0) eglTerminate(display_);
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  EGLDisplay get() const { return display_; }

 private:
  // Contexts belong to one thread, as their header says.
  static inline int users_ = 0;
  static inline EGLDisplay display_ = EGL_NO_DISPLAY;
};

/// OpenGL without any surface: the renderer brings its own framebuffer. Software or hardware, as
/// the machine has it.
class EglContext : public OffScreenContext {
 public:
  EglContext(int width, int height) : OffScreenContext(width, height) {
    if (!eglBindAPI(EGL_OPENGL_API)) Refuse("it has no desktop OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_.get(), wanted, &config, 1, &count) || count == 0) {
      Refuse("it has no configuration for desktop OpenGL");
    }
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                              3,
                              EGL_CONTEXT_MINOR_VERSION,
                              3,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                              EGL_NONE};
    context_ = eglCreateContext(display_.get(), config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) Refuse("the driver has no OpenGL 3.3 core");
  }
  ~EglContext() override {
    auto* other = Leave();
    eglDestroyContext(display_.get(), context_);
    Resume(other);
  }

  void* GetProcAddress(const char* name) override {
    return reinterpret_cast<void*>(eglGetProcAddress(name));
  }

 private:
  void Bind() override {
    if (!eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      Refuse("the driver does not draw without a surface (EGL_KHR_surfaceless_context)");
    }
  }
  void Release() override {
    eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

  Display display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<RenderContext> MakeEglContext(int width, int height) {
  auto context = std::make_unique<EglContext>(width, height);
  context->MakeCurrent();
  return context;
}

}  // namespace fsm

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fsm/render/off_screen.h"

namespace fsm {
namespace {

[[noreturn]] void Refuse(const std::string& what) { throw std::runtime_error("EGL: " + what); }

bool Lists(const char* extensions, std::string_view name) {
  std::string_view rest = extensions ? extensions : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

bool ClientHas(std::string_view name) {
  return Lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), name);
}

/// A display that stays open while it has users; the last one closes it.
class Display {
 public:
  Display(EGLDisplay display, std::string name) : display_(display), name_(std::move(name)) {
    if (display_ == EGL_NO_DISPLAY) Refuse("there is no display of " + name_);
    if (users_[display_]++ > 0) return;
    if (eglInitialize(display_, nullptr, nullptr)) return;
    users_.erase(display_);
    Refuse(name_ + " cannot be opened");
  }
  ~Display() {
    if (--users_[display_] > 0) return;
    users_.erase(display_);
    eglTerminate(display_);
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  EGLDisplay get() const { return display_; }
  const std::string& name() const { return name_; }

 private:
  // Unguarded, since all contexts belong to one thread (RenderContext).
  static inline std::map<EGLDisplay, int> users_;
  EGLDisplay display_;
  std::string name_;
};

/// OpenGL without a surface; the renderer brings its own framebuffer.
class EglContext : public OffScreenContext {
 public:
  EglContext(int width, int height, EGLDisplay display, const std::string& name)
      : OffScreenContext(width, height), display_(display, name) {
    if (!eglBindAPI(EGL_OPENGL_API)) Refuse(name + " has no desktop OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_.get(), wanted, &config, 1, &count) || count == 0) {
      Refuse(name + " has no configuration for desktop OpenGL");
    }
    context_ = Create(config, 4, 3);
    if (context_ == EGL_NO_CONTEXT) context_ = Create(config, 3, 3);
    if (context_ == EGL_NO_CONTEXT) Refuse("the driver of " + name + " has no OpenGL 3.3 core");
  }
  ~EglContext() override {
    auto* other = Leave();
    eglDestroyContext(display_.get(), context_);
    Resume(other);
  }

  std::string description() const override { return "EGL, " + display_.name(); }
  void* GetProcAddress(const char* name) override {
    return reinterpret_cast<void*>(eglGetProcAddress(name));
  }

 private:
  /// Some drivers (NVIDIA's) return exactly the version asked for; compute shaders need 4.3.
  EGLContext Create(EGLConfig config, EGLint major, EGLint minor) {
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                              major,
                              EGL_CONTEXT_MINOR_VERSION,
                              minor,
                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                              EGL_NONE};
    return eglCreateContext(display_.get(), config, EGL_NO_CONTEXT, version);
  }
  void Bind() override {
    if (!eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      Refuse("the driver of " + display_.name() +
             " does not draw without a surface (EGL_KHR_surfaceless_context)");
    }
  }
  void Release() override {
    eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

  Display display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

std::unique_ptr<RenderContext> MakeOn(int width, int height, EGLDisplay display,
                                      const std::string& name) {
  auto context = std::make_unique<EglContext>(width, height, display, name);
  context->MakeCurrent();
  return context;
}

struct Device {
  EGLDeviceEXT handle;
  std::string name;
  bool software;
};

std::vector<Device> Devices() {
  if (!ClientHas("EGL_EXT_platform_device") ||
      !(ClientHas("EGL_EXT_device_enumeration") || ClientHas("EGL_EXT_device_base"))) {
    Refuse("devices cannot be enumerated (EGL_EXT_device_enumeration, EGL_EXT_platform_device)");
  }
  const auto list =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      eglGetProcAddress("eglQueryDeviceStringEXT"));
  EGLint count = 0;
  if (!list || !text || !list(0, nullptr, &count) || count < 0) Refuse("devices are not listed");
  std::vector<EGLDeviceEXT> handles(static_cast<std::size_t>(count));
  if (!list(count, handles.data(), &count)) Refuse("devices are not listed");
  handles.resize(static_cast<std::size_t>(count));
  std::vector<Device> devices;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const char* extensions = text(handles[i], EGL_EXTENSIONS);
    const char* file = Lists(extensions, "EGL_EXT_device_drm")
                           ? text(handles[i], EGL_DRM_DEVICE_FILE_EXT)
                           : nullptr;
    devices.push_back({handles[i],
                       "device " + std::to_string(i) + (file ? " (" + std::string(file) + ")" : ""),
                       Lists(extensions, "EGL_MESA_device_software")});
  }
  return devices;
}

}  // namespace

std::unique_ptr<RenderContext> MakeEglDeviceContext(int width, int height, bool software) {
  std::string reasons;
  for (const Device& device : Devices()) {
    if (device.software != software) continue;
    try {
      return MakeOn(width, height,
                    eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device.handle, nullptr),
                    device.name + (software ? ", software" : ", hardware"));
    } catch (const std::runtime_error& error) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  if (!reasons.empty()) throw std::runtime_error(reasons);
  Refuse(software ? "there is no software device" : "there is no graphics card among its devices");
}

std::unique_ptr<RenderContext> MakeEglSurfacelessContext(int width, int height) {
  if (!ClientHas("EGL_MESA_platform_surfaceless")) {
    Refuse("there is no display without surfaces (EGL_MESA_platform_surfaceless)");
  }
  return MakeOn(width, height,
                eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                "Mesa without a surface");
}

}  // namespace fsm

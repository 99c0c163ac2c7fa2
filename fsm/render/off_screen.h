#pragma once

#include <memory>

#include "fsm/render/context_switch.h"

namespace fsm {

/// Ways to an off-screen context, each in a file of its own that is only built where its library
/// is. All throw std::runtime_error with a sentence if the way leads nowhere; the context is
/// current when made. Which are tried in which order is said in headless_context.cc.

/// Software into memory.
std::unique_ptr<RenderContext> MakeOsMesaContext(int width, int height);
/// The first of EGL's devices (EGL_EXT_device_enumeration, EGL_EXT_platform_device) of a kind that
/// makes one: graphics cards, or Mesa's software device.
std::unique_ptr<RenderContext> MakeEglDeviceContext(int width, int height, bool software);
/// Mesa's display without surfaces (EGL_MESA_platform_surfaceless), with the driver that Mesa
/// chooses.
std::unique_ptr<RenderContext> MakeEglSurfacelessContext(int width, int height);

}  // namespace fsm

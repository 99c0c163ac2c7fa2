#pragma once

#include <memory>

#include "fsm/render/context_switch.h"

namespace fsm {

/// Ways to make an off-screen context, each in a file that is only built if its library is there.
/// All throw std::runtime_error with a sentence on failure; on success the context is current.
/// headless_context.cc says in which order they are tried.

/// Renders in software to memory.
std::unique_ptr<RenderContext> MakeOsMesaContext(int width, int height);
/// Uses the first of EGL's devices (EGL_EXT_device_enumeration, EGL_EXT_platform_device) of a kind
/// that works: GPUs, or Mesa's software device.
std::unique_ptr<RenderContext> MakeEglDeviceContext(int width, int height, bool software);
/// Uses Mesa's display without surfaces (EGL_MESA_platform_surfaceless), with the driver that Mesa
/// chooses.
std::unique_ptr<RenderContext> MakeEglSurfacelessContext(int width, int height);

}  // namespace fsm

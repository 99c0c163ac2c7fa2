#pragma once

#include "fsm/render/render_context.h"

namespace fsm {

/// Prevents contexts of different kinds from being current at once. All of Mesa's front ends in a
/// process (OSMesa, GLX, EGL) share one per-thread record of the current context, but each also
/// keeps its own; switching between kinds without releasing the first makes one draw with the
/// other's state, and crashes. Therefore at most one context is current, and its own kind releases
/// it before the next is bound.
class SwitchedContext : public RenderContext {
 public:
  void MakeCurrent() final {
    if (current_ == this) return;
    if (current_) current_->Release();
    current_ = nullptr;
    Bind();
    current_ = this;
  }

 protected:
  /// For destructors, around the end of the GL side: leaves the thread without a current context,
  /// because the driver itself makes a dying context current for a moment. Returns the other
  /// context that was current, if any, for Resume.
  SwitchedContext* Leave() {
    SwitchedContext* other = current_ == this ? nullptr : current_;
    if (current_) current_->Release();
    current_ = nullptr;
    return other;
  }
  static void Resume(SwitchedContext* other) {
    if (other) other->MakeCurrent();
  }

 private:
  virtual void Bind() = 0;
  virtual void Release() = 0;

  static inline thread_local SwitchedContext* current_ = nullptr;
};

/// A context without a window. Its size is only stored: the renderer draws into its own
/// framebuffers.
class OffScreenContext : public SwitchedContext {
 public:
  OffScreenContext(int width, int height) : width_(width), height_(height) {}
  OffScreenContext(const OffScreenContext&) = delete;
  OffScreenContext& operator=(const OffScreenContext&) = delete;

  int width() const override { return width_; }
  int height() const override { return height_; }
  bool is_window() const override { return false; }
  void Resize(int width, int height) override {
    width_ = width;
    height_ = height;
  }
  void Present() override {}
  bool close_requested() const override { return false; }

 private:
  int width_;
  int height_;
};

}  // namespace fsm

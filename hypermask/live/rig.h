#pragma once

#include <functional>
#include <optional>

#include "fsm/image/image.h"
#include "hypermask/base/grey.h"
#include "hypermask/geometry/plane_map.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace hypermask {

/// A camera and a projector that look at the same place, real ones or simulated.
/// Thread: the scheduler's; events come on it, and none after the destructor.
class Rig {
 public:
  struct Events {
    /// A picture of the camera; when it was there, on the scheduler's clock.
    std::function<void(const Grey& picture, vm::Time arrived)> picture{};
    /// No more pictures come; why, if not because that was all.
    std::function<void(const std::optional<vm::Error>& error)> over{};
  };
  virtual ~Rig() = default;
  /// Projects this from now on. It is of the projector's size. Error: kUnavailable, the projector
  /// is gone.
  virtual vm::Result<void> Show(const fsm::Image& frame) = 0;
  virtual int projector_width() const = 0;
  virtual int projector_height() const = 0;
  /// Whether what is projected is to be seen by the camera, too. Of a real one somebody takes its
  /// infrared filter off; of a simulated one this does.
  virtual void TakeFilterOff(bool) {}
  /// Where the truth is known: how far from where it should the face will land, pixels of the
  /// projector, root of mean square, if the mask's plane (mm) is shown by `map` now, for `shown_s`.
  virtual std::optional<double> Miss(const PlaneMap& /*map*/, double /*shown_s*/) const {
    return std::nullopt;
  }
};

}  // namespace hypermask

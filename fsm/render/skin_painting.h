#pragma once

#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "fsm/render/skin_texture.h"

namespace fsm {

/// Paints the detail of a head's skin on a thread of its own, which the destructor joins.
class SkinPainting {
 public:
  SkinPainting() = default;  ///< of a head without such a skin
  /// `appearance` outlives this; the other arguments are those of PaintSkin.
  SkinPainting(std::shared_ptr<const HeadSurface> surface, HeadVertices rest,
               FaceLandmarks landmarks, const Appearance& appearance)
      : painting_(std::async(std::launch::async, [surface = std::move(surface),
                                                  rest = std::move(rest), landmarks, &appearance] {
          return PaintSkin(*surface, rest, landmarks, appearance);
        })) {}

  /// True while the skin is being painted: from construction until Texture() is first called.
  bool painting() const { return painting_.valid(); }
  /// Returns the skin's detail, null if there is none. Blocks until it is painted.
  const SkinTexture* Texture() {
    if (painting_.valid()) texture_ = painting_.get();
    return texture_ ? &*texture_ : nullptr;
  }

 private:
  std::optional<SkinTexture> texture_;
  std::future<SkinTexture> painting_;
};

}  // namespace fsm

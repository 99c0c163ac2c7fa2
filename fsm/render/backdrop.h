#pragma once

#include <memory>

#include "fsm/render/appearance.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/scene.h"

namespace fsm {

/// The background behind the figure: nothing, a colour, a studio wall or a picture. Destroy while
/// its context is current.
class Backdrop {
 public:
  Backdrop(const GlFunctions& gl, const Appearance& appearance);
  ~Backdrop();
  Backdrop(const Backdrop&) = delete;
  Backdrop& operator=(const Backdrop&) = delete;

  /// Draws the background over the bound framebuffer, which is a picture of `width` x `height`
  /// pixels. The background's picture is uploaded only if it has changed.
  void Draw(const Background& background, int width, int height);
  /// Blends the background over what was drawn before, which thereby fades; `opacity` 1 hides it
  /// fully. Without a background the premultiplied colours fade with the opacity. REQUIRES: the
  /// last Draw was of this background into the framebuffer that is bound now; depth test off.
  void BlendOver(const Background& background, float opacity);

 private:
  void DrawFullScreen(const Background& background, float opacity);
  void Upload(const std::shared_ptr<const Image>& image);

  const GlFunctions& gl_;
  GlProgram program_;
  GLuint array_ = 0;
  GLuint texture_ = 0;
  float wide_ = 1;  // aspect ratio of the view, width / height
  std::shared_ptr<const Image> uploaded_;
};

}  // namespace fsm

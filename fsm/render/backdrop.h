#pragma once

#include <memory>

#include "fsm/render/appearance.h"
#include "fsm/render/gl_objects.h"
#include "fsm/render/scene.h"

namespace fsm {

/// What stands behind the figure: nothing, a colour, the wall of a studio or
/// a picture. Destroy while its context is
/// current.
class Backdrop {
 public:
  Backdrop(const GlFunctions& gl, const Appearance& appearance);
  ~Backdrop();
  Backdrop(const Backdrop&) = delete;
  Backdrop& operator=(const Backdrop&) = delete;

  /// Covers the target bound at present, which becomes a picture of `width` x `height`. The
  /// background's picture is uploaded when it is another than before.
  void Draw(const Scene& scene, int width, int height);
  /// Lays the background over what was drawn before it, which so fades: `opacity` 1 leaves nothing
  /// of it. Over no background its colours, which are multiplied by its opacity, fade alike.
  /// REQUIRES: the last Draw was of this scene into the target bound now; no depth test.
  void Veil(const Scene& scene, float opacity);

 private:
  void Cover(const Scene& scene, float opacity);
  void Upload(const std::shared_ptr<const Image>& image);

  const GlFunctions& gl_;
  GlProgram program_;
  GLuint array_ = 0;
  GLuint texture_ = 0;
  float wide_ = 1;  // width of the view, 1 = its height
  std::shared_ptr<const Image> uploaded_;
};

}  // namespace fsm

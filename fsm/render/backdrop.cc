#include "fsm/render/backdrop.h"

#include <cassert>

#include "embedded/backdrop_fragment.h"
#include "embedded/backdrop_vertex.h"

namespace fsm {
namespace {

/// Tells whether a scene shows a picture behind the figure.
bool IsPictured(const Scene& scene) {
  return scene.show_background && scene.background_image && !scene.background_image->rgba.empty();
}

}  // namespace

Backdrop::Backdrop(const GlFunctions& gl, const Appearance& appearance)
    : gl_(gl),
      program_(gl, "backdrop", embedded::backdrop_vertex(),
               "#version 330 core\n" + appearance.constants() +
                   std::string(embedded::backdrop_fragment())) {
  gl_.GenVertexArrays(1, &array_);
  gl_.GenTextures(1, &texture_);
}

Backdrop::~Backdrop() {
  gl_.DeleteTextures(1, &texture_);
  gl_.DeleteVertexArrays(1, &array_);
}

void Backdrop::Draw(const Scene& scene, int width, int height) {
  if (!scene.show_background) {
    gl_.ClearColor(0, 0, 0, 0);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    return;
  }
  wide_ = static_cast<float>(width) / static_cast<float>(height);
  if (IsPictured(scene)) {
    gl_.ActiveTexture(GlUnit(TextureUnit::kPass));
    gl_.BindTexture(GL_TEXTURE_2D, texture_);
    Upload(scene.background_image);
    // A picture of the view's own size is shown without filtering, pixel by pixel.
    const bool same = uploaded_->width == width && uploaded_->height == height;
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                      same ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, same ? GL_NEAREST : GL_LINEAR);
  } else if (!scene.studio) {
    gl_.ClearColor(scene.background.r, scene.background.g, scene.background.b, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    return;
  }
  Cover(scene, 1);
}

void Backdrop::Veil(const Scene& scene, float opacity) {
  if (IsPictured(scene)) {
    gl_.ActiveTexture(GlUnit(TextureUnit::kPass));
    gl_.BindTexture(GL_TEXTURE_2D, texture_);
  }
  gl_.Enable(GL_BLEND);
  // Without a background nothing is added; colours and opacity only decrease.
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA,
                        scene.show_background ? GL_ONE : GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
  Cover(scene, opacity);
  gl_.Disable(GL_BLEND);
}

void Backdrop::Cover(const Scene& scene, float opacity) {
  program_.Use();
  program_.Set("picture", TextureUnit::kPass);
  program_.Set("pictured", IsPictured(scene));
  program_.Set("studio", scene.show_background && scene.studio);
  program_.Set("wide", wide_);
  program_.Set("plain", scene.show_background ? scene.background : glm::vec3(0));
  program_.Set("opacity", opacity);
  gl_.BindVertexArray(array_);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void Backdrop::Upload(const std::shared_ptr<const Image>& image) {
  if (image == uploaded_) return;
  assert(image->IsWhole());
  uploaded_ = image;
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image->width, image->height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, image->rgba.data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
}

}  // namespace fsm

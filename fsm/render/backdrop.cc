#include "fsm/render/backdrop.h"

#include <cassert>
#include <glm/vec4.hpp>

#include "embedded/backdrop_fragment.h"
#include "embedded/backdrop_vertex.h"

namespace fsm {
namespace {

using Picture = std::shared_ptr<const Image>;

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

void Backdrop::Draw(const Background& background, int width, int height) {
  wide_ = static_cast<float>(width) / static_cast<float>(height);
  const auto* const colour = std::get_if<glm::vec3>(&background);
  if (colour || std::holds_alternative<Transparent>(background)) {
    const glm::vec4 clear = colour ? glm::vec4(*colour, 1) : glm::vec4(0);
    gl_.ClearColor(clear.r, clear.g, clear.b, clear.a);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    return;
  }
  if (const auto* const picture = std::get_if<Picture>(&background)) {
    gl_.ActiveTexture(GlUnit(TextureUnit::kPass));
    gl_.BindTexture(GL_TEXTURE_2D, texture_);
    Upload(*picture);
    // A picture of the view's own size is shown without filtering, pixel by pixel.
    const bool same = uploaded_->width == width && uploaded_->height == height;
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                      same ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, same ? GL_NEAREST : GL_LINEAR);
  }
  DrawFullScreen(background, 1);
}

void Backdrop::BlendOver(const Background& background, float opacity) {
  if (std::holds_alternative<Picture>(background)) {
    gl_.ActiveTexture(GlUnit(TextureUnit::kPass));
    gl_.BindTexture(GL_TEXTURE_2D, texture_);
  }
  gl_.Enable(GL_BLEND);
  // Without a background nothing is added; colours and opacity only decrease.
  const bool transparent = std::holds_alternative<Transparent>(background);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, transparent ? GL_ZERO : GL_ONE,
                        GL_ONE_MINUS_SRC_ALPHA);
  DrawFullScreen(background, opacity);
  gl_.Disable(GL_BLEND);
}

void Backdrop::DrawFullScreen(const Background& background, float opacity) {
  const auto* const colour = std::get_if<glm::vec3>(&background);
  program_.Use();
  program_.Set("picture", TextureUnit::kPass);
  program_.Set("pictured", std::holds_alternative<Picture>(background));
  program_.Set("studio", std::holds_alternative<StudioWall>(background));
  program_.Set("wide", wide_);
  program_.Set("plain", colour ? *colour : glm::vec3(0));
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

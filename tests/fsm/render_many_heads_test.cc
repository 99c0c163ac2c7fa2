// Several heads drawn by one renderer.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "fsm/render/renderer.h"
#include "tests/fsm/ball_head.h"
#include "tests/fsm/wearing_photo.h"

namespace fsm {
namespace {

TEST(ManyHeadsTest, DrawnInTurnsTheyLookAsAlone) {
  const auto context = RenderContext::MakeHeadless(160, 160);
  // More of them than are kept; one wears a photo. Another size wants skin in other detail.
  std::vector<std::unique_ptr<Head>> heads;
  heads.push_back(MakeGenericHead());
  heads.push_back(std::make_unique<BallHead>());
  heads.push_back(WearingPhoto());
  heads.push_back(MakeHead(Identities().back().name));
  const auto picture = [](Renderer& renderer, const Head& head, int size) {
    FaceState state;
    state.au_left[12] = state.au_right[26] = 0.8F;
    HeadVertices vertices;
    head.Evaluate(state, vertices);
    renderer.Place({0, 0, size, size});
    renderer.Draw(head, vertices, state, {});
    Image image;
    renderer.Read(image);
    return image.rgba;
  };
  for (const std::size_t kept : {2U, 8U}) {
    const auto shared = Renderer::Make(*context, kept);
    for (const int size : {160, 40, 160}) {
      for (const auto& head : heads) {
        SCOPED_TRACE(size);
        const auto alone = Renderer::Make(*context);
        EXPECT_EQ(picture(*shared, *head, size), picture(*alone, *head, size));
      }
    }
  }
}

}  // namespace
}  // namespace fsm

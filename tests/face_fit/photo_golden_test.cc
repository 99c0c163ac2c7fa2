// A kept image of the whole way from a photo to a head that wears it and moves.

#include <gtest/gtest.h>

#include "face_fit/make_face.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/render/renderer.h"
#include "tests/face_fit/network_fixture.h"
#include "tests/fsm/golden_picture.h"

namespace facefit {
namespace {

/// The head that the program makes of a photo of one person.
std::unique_ptr<fsm::Head> WornBy(FaceNetworks& networks, const ObservedHead& base,
                                  const fsm::Image& photo) {
  const auto front =
      vm::OrThrow(PrepareFront(networks, base, photo, FaceNumber{}, PhotoExtent::kCloseUp));
  return fsm::MakeHead(vm::OrThrow(MakeFace(base, front.photo, front.face.value())).baked.head);
}

fsm::Image Drawn(const fsm::Head& head, const fsm::FaceState& state, const fsm::Scene& scene,
                 int width, int height) {
  const auto context = fsm::RenderContext::MakeHeadless(width, height);
  const auto renderer = fsm::Renderer::Make(*context);
  fsm::HeadVertices vertices;
  head.Evaluate(state, vertices);
  renderer->DrawVertices(head, vertices, state.figure, scene);
  fsm::Image image;
  renderer->Read(image);
  return image;
}

/// An image of a built-in head, taken for a photo.
fsm::Image DrawnPhoto(const char* name) {
  fsm::Scene scene;
  scene.camera.distance = 0.9F;
  scene.camera.height_mm = -20;
  return Drawn(*fsm::MakeHead(name), {}, scene, 640, 800);
}

using PhotoGoldenTest = NetworkTest;

TEST_F(PhotoGoldenTest, APhotoIsFittedAndWornAsKept) {
  const auto head = WornBy(*networks_, Galatea(), DrawnPhoto("baucis"));
  fsm::FaceState state;
  state.au.left[26] = state.au.right[26] = 0.6F;
  state.au.left[1] = state.au.right[1] = 0.6F;
  state.blink.left = 0.5F;
  state.head_rotation[1] = -10;
  fsm::Scene scene;
  scene.camera.distance = 0.65F;
  constexpr int kSide = 176;
  fsm::ExpectGolden(Drawn(*head, state, scene, kSide, kSide),
                    GALATEA_SOURCE_DIR "/tests/face_fit/data/golden/photo.png",
                    fsm::kPlainBackground);
}

}  // namespace
}  // namespace facefit

// Photos of several people: drawn heads, side by side in one picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "face_fit/find/face/upright.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/picture/filters.h"
#include "fsm/head/make_head.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/head.h"
#include "tests/face_fit/network_fixture.h"

namespace facefit {
namespace {

/// One of the people: the built-in face, how far turned and tilted (degrees), and the square of the
/// group's picture it is drawn in.
struct Person {
  const char* face;
  float turn, tilt;
  int x, y, side;
};

fsm::Image Drawn(const Person& person) {
  const auto head = fsm::MakeHead(person.face, false);
  fsm::FaceState state;
  state.figure.rotation = {0, person.turn, person.tilt};
  fsm::HeadVertices vertices;
  head->Evaluate(state, vertices);
  const auto context = fsm::RenderContext::MakeHeadless(person.side, person.side);
  const auto renderer = fsm::Renderer::Make(*context);
  renderer->Draw(*head, vertices, state, fsm::Scene{});
  fsm::Image picture;
  renderer->Read(picture);
  return picture;
}

fsm::Image Group(int width, int height, const std::vector<Person>& people) {
  fsm::Image group{.width = width, .height = height, .rgba = {}};
  group.rgba.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 90);
  for (const Person& person : people) {
    const fsm::Image one = Drawn(person);
    for (int y = 0; y < one.height; ++y) {
      const auto from = one.rgba.begin() + static_cast<std::ptrdiff_t>(y) * one.width * 4;
      const auto to = (static_cast<std::ptrdiff_t>(person.y + y) * width + person.x) * 4;
      std::copy_n(from, one.width * 4, group.rgba.begin() + to);
    }
  }
  return group;
}

using GroupTest = NetworkTest;

TEST_F(GroupTest, PeopleBesideTheLargestAreFoundThoughSmallerAndTurned) {
  const std::vector<Person> people = {{"galatea", 0, 0, 560, 300, 520},
                                      {"pygmalion", 25, 0, 80, 380, 300},
                                      {"baucis", -25, 10, 1180, 320, 280},
                                      {"galatea", -15, -10, 340, 60, 240},
                                      {"pygmalion", 10, 20, 1000, 60, 240}};
  const auto faces = FindFaces(*networks_, Group(1600, 1000, people));
  EXPECT_EQ(faces.size(), people.size());
  for (const Person& person : people) {
    const auto side = static_cast<float>(person.side);
    EXPECT_EQ(std::ranges::count_if(
                  faces,
                  [&](const FoundFace& face) {
                    const glm::vec2 at = face.crop.centre - glm::vec2(person.x, person.y);
                    return std::min(at.x, at.y) > 0.2F * side && std::max(at.x, at.y) < 0.8F * side;
                  }),
              1)
        << person.face << " at " << person.x << ", " << person.y;
  }
}

TEST_F(GroupTest, AGroupWhoseLargestFaceLeansToOneSideStaysAsItIs) {
  const fsm::Image photo = Group(1600, 1000,
                                 {{"galatea", 0, 58, 600, 300, 500},
                                  {"pygmalion", 10, 0, 100, 200, 380},
                                  {"baucis", -10, -5, 1150, 200, 380}});
  fsm::Image upright = photo, lying = Turned(photo, 6);
  EXPECT_EQ(FindUprightFaces(*networks_, upright).orientation, 1);
  EXPECT_EQ(FindUprightFaces(*networks_, lying).orientation, 8);
}

}  // namespace
}  // namespace facefit

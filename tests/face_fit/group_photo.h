#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "fsm/head/make_head.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/head.h"

namespace facefit {

/// One of the people: the built-in face, how far turned and tilted (degrees), and the square of the
/// group's image it is drawn in.
struct Person {
  const char* face;
  float turn, tilt;
  int x, y, side;
};

inline fsm::Image DrawnPerson(const Person& person) {
  const auto head = fsm::MakeSymmetricHead(person.face);
  fsm::FaceState state;
  state.figure.rotation = {0, person.turn, person.tilt};
  fsm::HeadVertices vertices;
  head->Evaluate(state, vertices);
  const auto context = fsm::RenderContext::MakeHeadless(person.side, person.side);
  const auto renderer = fsm::Renderer::Make(*context);
  renderer->DrawVertices(*head, vertices, state.figure, fsm::Scene{});
  fsm::Image image;
  renderer->Read(image);
  return image;
}

inline fsm::Image GroupPhoto(int width, int height, const std::vector<Person>& people) {
  fsm::Image group{.width = width, .height = height, .rgba = {}};
  group.rgba.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 90);
  for (const Person& person : people) {
    const fsm::Image one = DrawnPerson(person);
    for (int y = 0; y < one.height; ++y) {
      const auto from = one.rgba.begin() + static_cast<std::ptrdiff_t>(y) * one.width * 4;
      const auto to = (static_cast<std::ptrdiff_t>(person.y + y) * width + person.x) * 4;
      std::copy_n(from, one.width * 4, group.rgba.begin() + to);
    }
  }
  return group;
}

}  // namespace facefit

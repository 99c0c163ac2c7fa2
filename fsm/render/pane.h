#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "fsm/render/scene.h"
#include "fsm/rig/head.h"

namespace fsm {

/// A rectangle of the context's drawable in pixels from its upper left corner; width 0: all of it.
struct Viewport {
  int x = 0, y = 0;
  int width = 0, height = 0;
};

/// One face of many that are drawn; its pointers are borrowed for the call.
struct Pane {
  const Head* head;
  const FaceState* state;
  const Scene* scene;
  Viewport viewport = {};
  std::span<const glm::vec3> spring_offsets = {};
};

}  // namespace fsm

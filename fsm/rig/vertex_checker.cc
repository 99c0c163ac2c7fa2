#include "fsm/rig/vertex_checker.h"

#include <fmt/format.h>

#include "vm_protocol/core/or_throw.h"

namespace fsm {

void VertexChecker::Refuse(const std::string& what) {
  throw vm::Failure({vm::Errc::kBadValue, what});
}

std::string VertexChecker::Element(const std::string& member, std::size_t index) {
  return fmt::format("{}[{}]", member, index);
}

void VertexChecker::Positive(float value, const char* member) {
  if (value > 0) return;  // false for not-a-number
  Refuse(fmt::format("{}: {} found where more than 0 was expected", member, value));
}

void VertexChecker::Vertex(std::size_t vertex, const std::string& place) const {
  if (vertex < vertices_) return;
  Refuse(fmt::format("{}: vertex {} of {}", place, vertex, vertices_));
}

void VertexChecker::PerVertex(std::size_t size, const char* member) const {
  if (size == vertices_) return;
  Refuse(fmt::format("{}: {} elements for {} vertices", member, size, vertices_));
}

}  // namespace fsm

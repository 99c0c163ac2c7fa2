#pragma once

#include <cstddef>
#include <string>

namespace fsm {

/// Refuses data of a head whose sizes and indices do not fit its number of vertices: throws
/// vm::Failure (kBadValue) naming the member, as "rig.mouth.seam[3]: vertex 900 of 800".
class VertexChecker {
 public:
  explicit VertexChecker(std::size_t vertices) : vertices_(vertices) {}

  [[noreturn]] static void Refuse(const std::string& what);
  /// Returns "member[index]".
  static std::string Element(const std::string& member, std::size_t index);
  static void Positive(float value, const char* member);

  std::size_t vertices() const { return vertices_; }
  void Vertex(std::size_t vertex, const std::string& place) const;
  void PerVertex(std::size_t size, const char* member) const;
  void EmptyOrPerVertex(std::size_t size, const char* member) const {
    if (size != 0) PerVertex(size, member);
  }
  /// Checks that every element of a list is a vertex.
  void Vertices(const auto& list, const char* member) const {
    for (std::size_t i = 0; i < list.size(); ++i) Vertex(list[i], Element(member, i));
  }
  /// Checks that every element names a vertex in its member `vertex`.
  void VerticesOf(const auto& list, const std::string& member) const {
    for (std::size_t i = 0; i < list.size(); ++i) Vertex(list[i].vertex, Element(member, i));
  }
  void Pairs(const auto& list, const char* member) const {
    for (std::size_t i = 0; i < list.size(); ++i) {
      Vertex(list[i].first, Element(member, i));
      Vertex(list[i].second, Element(member, i));
    }
  }
  void Triangles(const auto& list, const char* member) const {
    if (list.size() % 3 != 0) Refuse(std::string(member) + ": not three for each triangle");
    Vertices(list, member);
  }

 private:
  const std::size_t vertices_;
};

}  // namespace fsm

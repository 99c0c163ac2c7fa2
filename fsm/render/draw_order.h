#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/render/coarse_mesh.h"
#include "fsm/rig/head.h"

namespace fsm {

/// How much of skin is more than its colour, or of what wears a photo more than the photo: each
/// costs a good part of a pixel.
enum class Worn : std::uint8_t {
  kPlain,    ///< nothing
  kCreased,  ///< skin that creases with an expression
  kDetailed  ///< that, or grain from elsewhere, or it is left out or mixed with what is behind it
};

/// A part as it is drawn.
struct DrawnPart {
  HeadTopology::Part part;  ///< indices as uploaded
  bool soft = false;        ///< mixed with what is behind it
  Worn worn = Worn::kDetailed;
};

/// The triangles of a head in the order to draw them. Pixels found to be hidden cost nearly
/// nothing, so the hair before the ears comes first, then the face, then the hair behind it, each
/// from the front to the back of a head that looks at the viewer. That is the best order most of
/// the time; where it is not, only time is lost. What is mixed with what lies behind it comes after
/// that.
class DrawOrder {
 public:
  /// `triangles`: all of the topology or fewer; `worn`: of every vertex, what DrawnPart says of
  /// parts.
  DrawOrder(const HeadTopology& topology, const HeadTriangles& triangles,
            std::span<const glm::vec3> rest, const std::vector<Worn>& worn);

  std::vector<DrawnPart> parts;
  std::vector<std::uint32_t> indices;

  /// Whether a head wears a photo in layers, from back to front with soft edges.
  static bool Blends(const HeadTopology& topology) {
    return topology.worn.image && !topology.opacity.empty();
  }

 private:
  using Corners = std::span<const std::uint32_t>;
  Corners CornersOf(const HeadTopology::Part& part) const;
  void Add(HeadTopology::Part part, Corners corners, bool soft = false,
           Worn worn = Worn::kDetailed);
  void AddWorn(const HeadTopology::Part& part, Corners corners);
  struct Layer {
    HeadTopology::Part part{};
    std::vector<std::uint32_t> corners;
  };
  void AddFace(Layer& sheet, Layer& skin);
  std::vector<std::uint32_t> SortedHair(std::span<const glm::vec3> rest,
                                        std::size_t& before_ears) const;

  const HeadTopology& topology_;
  const HeadTriangles& triangles_;
  const std::vector<Worn>& worn_;
};

}  // namespace fsm

#include "fsm/asset/check_asset.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "fsm/mesh/mesh_reach.h"
#include "fsm/rig/rig.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

std::string Place(const char* member, std::size_t at) { return fmt::format("{}[{}]", member, at); }

class Checker {
 public:
  explicit Checker(const HeadAsset& asset) : asset_(asset), vertices_(asset.rig.rest.size()) {}

  void Check() const {
    if (vertices_ == 0) Refuse("rig.rest: no vertices");
    CheckTopology(asset_.topology);
    CheckRig(asset_.rig);
    if (asset_.view) Positive(asset_.view->half_mm, "view.half_mm");
    CheckLips(asset_.rig.lips);
  }

 private:
  [[noreturn]] static void Refuse(const std::string& what) {
    throw vm::Failure({vm::Errc::kBadValue, what});
  }
  void Vertex(std::size_t vertex, const std::string& place) const {
    if (vertex < vertices_) return;
    Refuse(fmt::format("{}: vertex {} of {}", place, vertex, vertices_));
  }
  template <typename List>
  void PerVertex(const List& list, const char* member, bool may_be_empty) const {
    if (list.size() == vertices_ || (may_be_empty && list.empty())) return;
    Refuse(fmt::format("{}: {} elements for {} vertices", member, list.size(), vertices_));
  }
  template <typename List>
  void Vertices(const List& list, const char* member) const {
    for (std::size_t i = 0; i < list.size(); ++i) Vertex(list[i], Place(member, i));
  }
  /// Checks that every element names an existing vertex.
  template <typename List>
  void VerticesOf(const List& list, const char* member) const {
    for (std::size_t i = 0; i < list.size(); ++i) Vertex(list[i].vertex, Place(member, i));
  }
  static void Positive(float value, const char* member) {
    if (value > 0) return;  // false for not-a-number
    Refuse(fmt::format("{}: {} found where more than 0 was expected", member, value));
  }
  template <typename List>
  void Triangles(const List& list, const char* member) const {
    if (list.size() % 3 != 0) Refuse(std::string(member) + ": not three for each triangle");
    Vertices(list, member);
  }

  void CheckTopology(const HeadTopology& topology) const {
    Triangles(topology.indices, "topology.indices");
    for (std::size_t i = 0; i < topology.parts.size(); ++i) {
      const HeadTopology::Part& part = topology.parts[i];
      const std::string place = Place("topology.parts", i);
      if (part.index_count % 3 != 0 || part.first_index > topology.indices.size() ||
          part.index_count > topology.indices.size() - part.first_index) {
        Refuse(place + ": its triangles are not among the indices");
      }
      if (part.pbr < -1 || part.pbr >= static_cast<int>(topology.pbr_materials.size())) {
        Refuse(fmt::format("{}: PBR material {} of {}", place, part.pbr,
                           topology.pbr_materials.size()));
      }
    }
    PerVertex(topology.albedo, "topology.albedo", false);
    PerVertex(topology.openness, "topology.openness", false);
    PerVertex(topology.opacity, "topology.opacity", true);
    PerVertex(topology.uv, "topology.uv", true);
    PerVertex(topology.strands, "topology.strands", true);
    PerVertex(topology.textures.texcoord, "topology.texcoord", !topology.textures.image);
    PerVertex(topology.textures.weight, "topology.texture_weight", !topology.textures.image);
    VerticesOf(topology.portrait.shut_lids, "topology.shut_lids");
    PerVertex(topology.portrait.relit, "topology.relit", true);
    const MouthSlit& mouth = topology.mouth;
    for (std::size_t i = 0; i < mouth.seam.size(); ++i) {
      Vertex(mouth.seam[i].first, Place("topology.mouth.seam", i));
      Vertex(mouth.seam[i].second, Place("topology.mouth.seam", i));
    }
    for (const auto vertex : {mouth.corner_right, mouth.corner_left, mouth.upper_incisor,
                              mouth.lower_incisor, mouth.upper_root}) {
      Vertex(vertex, "topology.mouth");
    }
  }

  void CheckRig(const RigData& rig) const {
    for (std::size_t i = 0; i < vertices_; ++i) {
      if (!WithinReach(rig.rest[i])) Refuse(Place("rig.rest", i) + ": too far away");
    }
    PerVertex(rig.rest_normal, "rig.rest_normal", false);
    PerVertex(rig.proxy.rest, "rig.proxy_rest", true);
    if (rig.proxy.to_own.size() != rig.proxy.rest.size()) {
      Refuse("rig.proxy_to_own: not one for each of rig.proxy_rest");
    }
    CheckSteps(rig.steps);
    Vertex(rig.jaw.chin, "rig.chin");
    PerVertex(rig.bone, "rig.bone", false);
    PerVertex(rig.weights, "rig.weights", false);
    PerVertex(rig.normals.twin, "rig.normal_twin", true);
    Vertices(rig.normals.twin, "rig.normal_twin");
    Triangles(rig.normals.soft_triangles, "rig.soft_triangles");
    for (std::size_t i = 0; i < rig.channels.size(); ++i) CheckChannel(rig.channels[i], i);
    VerticesOf(rig.lids.vertices, "rig.lids.vertices");
    VerticesOf(rig.ball_lids.vertices, "rig.ball_lids");
    VerticesOf(rig.teeth.contacts, "rig.teeth_contacts");
    CheckSprings(rig);
    // Checks divisors.
    if (const auto& ranges = rig.eyes.gaze_ranges) {
      for (const GazeRange& range : {ranges->inner, ranges->outer, ranges->up, ranges->down})
        Positive(range.gaze_deg, "rig.gaze_ranges.gaze_deg");
    }
    if (!rig.teeth.contacts.empty()) {
      Positive(rig.teeth.upper.half_width, "rig.upper_teeth.half_width");
      Positive(rig.teeth.lower.half_width, "rig.lower_teeth.half_width");
    }
  }

  static void CheckSteps(const std::vector<RigStep>& steps) {
    if (steps.size() > RigData::kMostSteps) {
      Refuse(fmt::format("rig.steps: {}, at most {} expected", steps.size(), RigData::kMostSteps));
    }
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const bool in_order =
          ShapesSkin(steps[i]) ? ShapesSkin(steps[i - 1]) : steps[i - 1] < steps[i];
      if (in_order) continue;
      Refuse(fmt::format("{}: {} cannot come after {}", Place("rig.steps", i), NameOf(steps[i]),
                         NameOf(steps[i - 1])));
    }
  }

  void CheckSprings(const RigData& rig) const {
    for (std::size_t i = 0; i < rig.swing.springs.size(); ++i) {
      const Spring& spring = rig.swing.springs[i];
      const std::string place = Place("rig.springs", i);
      const auto check = [&](const char* member, float value, float least, float most) {
        if (value >= least && value <= most) return;  // false for not-a-number
        Refuse(fmt::format("{}: {} outside {}..{}", place, member, least, most));
      };
      if (!WithinReach(spring.rest) || !WithinReach(spring.root)) Refuse(place + ": too far away");
      check("frequency_hz", spring.frequency_hz, Spring::kLeastHz, Spring::kMostHz);
      check("damping", spring.damping, Spring::kLeastDamping, Spring::kMostDamping);
      check("hang", spring.hang, 0, 1);
      check("most_mm", spring.most_mm, Spring::kLeastMost, Spring::kMostMost);
      if (!(glm::dot(spring.outward, spring.outward) <= 1.01f))
        Refuse(place + ": outward is longer than 1");
    }
    VerticesOf(rig.swing.weights, "rig.spring_weights");
    for (std::size_t i = 0; i < rig.swing.weights.size(); ++i) {
      const std::uint32_t spring = rig.swing.weights[i].spring;
      if (spring >= rig.swing.springs.size()) {
        Refuse(fmt::format("rig.spring_weights[{}]: spring {} of {}", i, spring,
                           rig.swing.springs.size()));
      }
    }
  }

  void CheckChannel(const Channel& channel, std::size_t at) const {
    const std::string place = Place("rig.channels", at);
    for (const Channel::Driver& driver : channel.drivers) {
      using enum Drive::Kind;
      const Drive::Kind kind = driver.drive.kind;
      const std::size_t most = kind == kUnit || kind == kAskedUnit ? UnitValues::kMost
                               : kind == kBlink || kind == kGazeUp || kind == kGazeRight ? 0
                               : kind == kResidual ? Residuals{}.size() - 1
                                                   : FaceState{}.mouth.size() - 1;
      if (driver.drive.number > most) {
        Refuse(fmt::format("{}: number {} above {}", place, driver.drive.number, most));
      }
    }
    if (!(channel.least <= channel.most)) {  // true for not-a-number, too
      Refuse(fmt::format("{}: least {} is above most {}", place, channel.least, channel.most));
    }
    VerticesOf(channel.moves, (place + ".moves").c_str());
  }

  void CheckLips(const LipRig& lips) const {
    for (std::size_t i = 0; i < lips.seam.size(); ++i) {
      Vertex(lips.seam[i].first, Place("rig.lips.seam", i));
      Vertex(lips.seam[i].second, Place("rig.lips.seam", i));
    }
    if (!lips.apart_at_rest.empty() && lips.apart_at_rest.size() != lips.seam.size()) {
      Refuse("rig.lips.apart_at_rest: not one for each pair of the seam");
    }
    VerticesOf(lips.followers, "rig.lips.followers");
    for (std::size_t i = 0; i < lips.followers.size(); ++i) {
      if (lips.followers[i].pair >= lips.seam.size()) {
        Refuse(fmt::format("rig.lips.followers[{}]: pair {} of {}", i, lips.followers[i].pair,
                           lips.seam.size()));
      }
    }
    if (lips.measured) Vertices(*lips.measured, "rig.lips.measured");
  }

  const HeadAsset& asset_;
  const std::size_t vertices_;
};

}  // namespace

vm::Result<void> CheckAsset(const HeadAsset& asset) {
  try {
    Checker(asset).Check();
  } catch (const vm::Failure& failure) {
    return std::unexpected(failure.error);
  }
  return {};
}

}  // namespace fsm

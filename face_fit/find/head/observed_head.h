#pragma once

#include <cassert>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "face_fit/find/head/lip_seam.h"
#include "face_fit/find/network/found_face.h"
#include "face_fit/find/network/network_points.h"
#include "face_fit/surface/mesh_point.h"
#include "fsm/rig/head.h"
#include "fsm/rig/unit_table.h"
#include "vm_protocol/core/result.h"

namespace facefit {

class FaceNetworks;

/// A head as it was drawn for the landmark network, and where the network saw each point.
struct NetworkPortrait {
  fsm::Image image;
  PerPoint<glm::vec2> pixels;
};

/// A head as the landmark network sees it: it is drawn, the network finds points in the image,
/// and these are projected back onto the mesh. So the network's systematic errors are the same on
/// this head and on a photo.
class ObservedHead {
 public:
  struct Skin {
    std::vector<std::uint32_t> triangles;  ///< skin, lips and mouth
    bool has_uv_seams = false;             ///< as for fsm::TransferSurface
  };

  /// Observes a built-in head and moves the points of its inner lips onto the lip seam. Error:
  /// kBadValue, no face is seen on it. Throws std::runtime_error if rendering is impossible.
  static vm::Result<ObservedHead> BuiltIn(FaceNetworks& networks, const std::string& name);
  /// The same of a head with the built-in heads' mesh.
  static vm::Result<ObservedHead> FromBaseMesh(FaceNetworks& networks,
                                               std::unique_ptr<fsm::Head> head,
                                               const std::string& name);
  /// Observes a head of any maker; its points stay where the network saw them. Errors: as BuiltIn.
  static vm::Result<ObservedHead> Observe(FaceNetworks& networks, std::unique_ptr<fsm::Head> head,
                                          const std::string& name, const Skin& skin);
  /// Returns a head whose points are known exactly, for tests: no network has seen it.
  static ObservedHead Exact(std::unique_ptr<fsm::Head> head, const std::string& name,
                            const PerPoint<MeshPoint>& points);

  const std::string& name() const { return name_; }
  const fsm::Head& head() const { return *head_; }
  const fsm::HeadSurface& surface() const { return head_->surface(); }
  const fsm::HeadVertices& rest() const { return rest_; }
  /// Returns where the network's points lie on the head.
  const PerPoint<MeshPoint>& mesh_points() const { return mesh_points_; }
  /// Returns the depth that the network reports of a point, millimetres; of an Exact head the true
  /// one.
  float DetectedDepthMm(PointIndex i) const { return detected_depth_mm_[i]; }
  /// Returns what the network was shown. REQUIRES: not Exact.
  const NetworkPortrait& portrait() const {
    assert(portrait_);
    return *portrait_;
  }
  /// Returns the lip seam, if it was found.
  const std::optional<LipSeam>& lip_seam() const { return lip_seam_; }
  /// Returns the face's own action units, if it has any.
  const std::optional<fsm::UnitTable>& units() const { return units_; }

  /// Returns the vertices in a state, as in an expression; head's frame.
  std::vector<glm::vec3> InState(const fsm::FaceState& state) const;
  /// Returns the position of a point on the head at rest, millimetres.
  glm::vec3 AtRest(PointIndex i) const { return mesh_points_[i].On(rest_.position); }
  /// Replaces the action units. Points stay, since they were observed at rest.
  void UseUnits(const fsm::UnitTable& own);

 private:
  ObservedHead(std::unique_ptr<fsm::Head> head, const std::string& name);

  std::string name_;
  std::unique_ptr<fsm::Head> head_;
  fsm::HeadVertices rest_;
  PerPoint<MeshPoint> mesh_points_;
  PerPoint<float> detected_depth_mm_{};
  std::optional<NetworkPortrait> portrait_;
  std::optional<LipSeam> lip_seam_;
  std::optional<fsm::UnitTable> units_;
};

}  // namespace facefit
